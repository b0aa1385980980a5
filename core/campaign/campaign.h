#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/tables.h"
#include "core/robot/robot.h"
#include "core/statics/own_weight.h"

namespace stiffscope {

enum class DoubleEncoder { active, inactive, unspecified };

/// One-sigma noise of one tracker reading: along the line of sight range_fixed + range_per_m * distance,
/// across it (each of the two directions) angle_fixed + angle_per_m * distance. m, and m per m.
struct Tracker {
  std::string model;
  double range_fixed = 0.0;
  double range_per_m = 0.0;
  double angle_fixed = 0.0;
  double angle_per_m = 0.0;
  Eigen::Vector3d station = Eigen::Vector3d::Zero();  ///< in the frame of the file's points
};

/// A reflector on the tool, rigid with the flange.
struct Target {
  std::string id;
  std::optional<Eigen::Vector3d> position_in_flange;  ///< m; only needed with `displacements`
};

/// Where the wrench in `states` acts and in which axes it is written.
struct LoadCell {
  std::string parent;                                                  ///< link name
  Eigen::Isometry3d parent_from_cell = Eigen::Isometry3d::Identity();  ///< xyz_mm, rpy_deg
  std::optional<std::string> axes_link;  ///< wrench components parallel to this link's axes, rpy ignored
  double force_sigma = 0.0;              ///< N; 0: not stated
  double moment_sigma = 0.0;             ///< Nm; 0: not stated
};

/// A file that was read, as the report lists it.
struct InputFile {
  std::string name;    ///< as campaign.xml names it, relative to the folder
  std::string sha256;  ///< of its bytes, hex
};

/// Texts for the report; empty where the campaign does not have them.
struct CampaignTexts {
  std::string laboratory, customer, operator_name, item, conditions;
};

/// One machine in one condition, measured once: what `campaign.xml` and its tables say, in SI and radians.
/// A section that the day did not produce is absent (nullopt).
struct Campaign {
  std::filesystem::path folder;
  std::string name;
  std::string date;
  CampaignTexts texts;

  Robot robot;
  std::string base_link, flange_link;
  DoubleEncoder double_encoder = DoubleEncoder::unspecified;
  Eigen::Vector3d gravity_in_base{0.0, 0.0, -9.80665};  ///< m/s^2

  std::optional<Tracker> tracker;
  std::vector<Target> targets;
  std::optional<LoadCell> load_cell;
  std::optional<Tool> tool;

  std::optional<CircleSweeps> circle_sweeps;
  std::optional<WristSweep> wrist_sweep;
  std::optional<Loading> loading;
  std::optional<States> states;
  std::optional<Displacements> displacements;
  std::optional<Nests> nests;

  std::vector<std::string> pose_ids;  ///< poses in order of first appearance; tables refer to them by index
  std::vector<std::string> nest_ids;
  std::vector<InputFile> inputs;
};

/// A later step with a force below this share of its posture's largest is a return to zero (campaign format).
inline constexpr double kReturnShare = 0.05;

}  // namespace stiffscope
