#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/model.h"
#include "app/output.h"
#include "core/calibration/held_out.h"
#include "core/compensation/compensate.h"
#include "core/planning/plan.h"
#include "core/preparation/prepare.h"
#include "metrology/measured_points.h"

// What commands compute, apart from where a campaign comes from and where the result goes: the command line reads files
// and prints, the Python module has both as objects. Requests have a command's options under their names, checked where
// they are used. Each function hands its result to the outlet and returns the command's exit status; it throws
// io::InputError, which names an option as the command line spells it, and what reading and computing throw.

namespace stiffscope::app {

/// A campaign that is prepared when a computation gets to it: options are understood before megabytes are read.
struct CampaignSource {
  std::string name;  ///< as its user calls it, for messages
  std::function<std::shared_ptr<const preparation::PreparedCampaign>()> open;
};

/// A folder or campaign.xml; warnings of its reading go to standard error.
CampaignSource sourceOf(const std::string& folder_or_xml, bool raw, campaign::Hashes hashes = campaign::Hashes::taken);

/// `audit`; the campaign must not be raw.
int auditCampaign(const CampaignSource& source, const Outlet& outlet);

/// `fit` of points in any one unit of length; `name` is that of their file.
struct FitRequest {
  std::string shape, strategy;
  bool robust = false;
};
int fitPoints(const FitRequest& request, const std::string& name,
              const std::function<std::vector<Eigen::Vector3d>()>& points, const Outlet& outlet);

/// `frames`
int framesOf(const CampaignSource& source, const ModelChoice& model, const Outlet& outlet);

/// `identify`. Where its steps are not `shown` they are not computed unless all are asked for: with a dozen they are
/// several times the work of the rest.
struct IdentifyRequest {
  std::string method = "all", step;
  std::optional<int> subset_size;
  int bootstrap = 0;
  bool neglect_kc = false, robust = false, postures = false;
  ModelChoice model;
};
int identifyCampaign(const IdentifyRequest& request, const CampaignSource& source, bool steps_shown,
                     const Outlet& outlet);

/// `calibrate`; the files are written where they are named.
struct CalibrateRequest {
  calibration::CalibrationOptions options;
  std::string angles = "reported", urdf, csv;
};
int calibrateCampaign(CalibrateRequest request, const CampaignSource& source, const Outlet& outlet);

/// What a prediction is made by.
struct PredictionRequest {
  std::string method, step;
  ModelChoice model;
  std::optional<double> load_sd_percent;  ///< of the loads' size; empty: that of the load cell's scale
};

/// `compensate`; the campaign's own postures where none are given.
struct CompensateRequest {
  PredictionRequest prediction;
  std::string postures_file, out;
  /// In place of the file, with joint angles as it has them (compensation::withAnglesOfFigures).
  std::optional<std::vector<compensation::PostureToCompensate>> postures;
};
int compensateCampaign(const CompensateRequest& request, const CampaignSource& source, const Outlet& outlet);

/// `compensate` of a robot's program, and of a path of the tool.
struct MotionRequest {
  PredictionRequest prediction;
  std::string program, path, out, picture, wrenches, wrench_axes;
  std::vector<double> wrench, tool, workpiece, start;
  std::vector<std::string> cutting;
  bool turn_free = false;
};
int compensateProgram(const MotionRequest& request, const CampaignSource& source, const Outlet& outlet);
int compensatePath(const MotionRequest& request, const CampaignSource& source, const Outlet& outlet);

/// `compare`
struct CompareRequest {
  std::string step;
  bool neglect_kc = false;
  ModelChoice model;
  std::uint64_t seed = 1;
};
int compareTwo(const CompareRequest& request, const CampaignSource& before, const CampaignSource& after,
               const Outlet& outlet);

/// `diagnose` without --spike; the campaign must not be raw.
int diagnoseCampaign(const std::string& angles, const CampaignSource& source, const Outlet& outlet);

/// `plan`; the campaign must not be raw. Numbers that are empty were not asked for.
struct PlanRequest {
  std::string out, criterion = "balanced";
  bool unloaded = false;
  std::optional<double> load, pull;
  std::optional<int> add, postures, candidates;
  std::vector<double> hook_mm, tracker_mm, min_deg, max_deg;
  int repeats = planning::PlanningInputs().repeats;
  std::uint64_t seed = 1;
  ModelChoice model;
};
int planDay(const PlanRequest& request, const CampaignSource& source, const Outlet& outlet);

/// `simulate`: the result is what the machine truly is, the text that the folder is written.
struct SimulateRequest {
  std::string spec, out;
  bool replace = false;
};
int simulateDay(const SimulateRequest& request, const Outlet& outlet);

}  // namespace stiffscope::app
