#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/comparison/stated_change.h"
#include "core/identification/identification.h"

// What result files state of a campaign, and two of them against each other. No readings are there: what takes them is
// `compare` of the campaigns (comparison::compareCampaigns).

namespace stiffscope::reports {

inline constexpr double kNotStated = std::numeric_limits<double>::quiet_NaN();

/// What a file states of one posture; not a number where it does not.
struct StatedPosture {
  std::string pose;
  std::vector<double> q_deg;  ///< empty: the file does not have them
  struct At {
    double deflection_mm = kNotStated;
    std::array<double, 3> residual_mm{kNotStated, kNotStated, kNotStated};  ///< by Method
  };
  At wrist, targets;
  double gap_um = kNotStated, gap_after_um = kNotStated;  ///< rms per coordinate: before and with the verdict's effects
};

/// Two consecutive axes.
struct StatedLink {
  int axis = 0;  ///< the first of them, from 1
  double nominal_mm = kNotStated, nominal_deg = kNotStated;
  std::optional<comparison::Uncertain> length_mm, angle_deg;  ///< where it was measured
};

/// Held-out errors of a day without a load by one model.
struct StatedAccuracy {
  std::string model;
  double rms_mm = kNotStated, largest_mm = kNotStated;
};

struct StatedAudit {
  std::string verdict, purpose;
  std::vector<std::string> failed, warned;  ///< ids of checks
};

struct StatedDiagnosis {
  bool usable = false, unloaded = false;
  std::string verdict;  ///< "bearing tilt (joint 2) and frame error"; "none"
  double gap_um = kNotStated, after_um = kNotStated, noise_um = kNotStated;
};

/// One campaign of a results.json, or that of another command's JSON.
struct StatedCampaign {
  std::string file;  ///< as it was named, "#2" behind it where that told which
  std::string name, date, robot, serial, double_encoder;
  std::string urdf_sha256;  ///< of its robot description; empty where it is not known
  bool states_stiffness = false;
  /// By Method and joint.
  std::array<std::vector<std::optional<comparison::StatedCompliance>>, 3> compliances;
  std::optional<identification::Method> shown_first;
  std::vector<StatedPosture> postures;
  std::vector<StatedLink> links;
  std::optional<StatedAudit> audit;
  std::optional<StatedDiagnosis> diagnosis;
  std::vector<StatedAccuracy> accuracy;
};

/// Reads results.json of `report` or what audit, frames, identify, calibrate or diagnose wrote by --json. `named` may
/// end in "#2", the second campaign of the file; a file with several needs it. Throws io::InputError.
StatedCampaign readStatedCampaign(const std::string& named);

/// Whether it names such a file rather than a campaign: a file whose name ends in .json, "#N" behind it or not.
bool namesResults(const std::string& named);

/// Two of them. Before and after are only the order in which they were named.
struct StatedComparison {
  StatedCampaign before, after;
  std::string refused;  ///< why the machines are not one; the rest is then empty
  std::vector<std::string> cautions;
  /// By Method and joint; no entries where either states no stiffness.
  std::array<std::vector<std::optional<comparison::StatedChange>>, 3> changes;
  std::optional<identification::Method> shown_first;                     ///< of the methods that both have
  std::vector<std::optional<comparison::StatedChange>> lengths, angles;  ///< by link
  struct Pair {
    std::size_t before = 0, after = 0;
  };
  std::vector<Pair> postures;          ///< of one name, and at the same joint angles where both state them
  std::vector<std::string> unmatched;  ///< postures of one alone, or elsewhere
  bool at_wrist = false;               ///< where deflections and residuals are compared

  bool comparesStiffness() const { return shown_first.has_value(); }
};

StatedComparison compareStated(StatedCampaign before, StatedCampaign after);

}  // namespace stiffscope::reports
