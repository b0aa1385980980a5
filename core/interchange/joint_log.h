#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/interchange/point_reading.h"

namespace stiffscope::interchange {

/// Dialects of what robots write of their joints. `columns` is any table whose columns the user names.
enum class LogFormat { fanuc_karel, fanuc_tp, kuka_krl, rapid, ur, columns };

inline constexpr std::array<const char*, 6> kLogFormatNames{"fanuc_karel", "fanuc_tp", "kuka_krl",
                                                            "rapid",       "ur",       "columns"};

inline const char* nameOf(LogFormat format) { return kLogFormatNames[static_cast<std::size_t>(format)]; }

/// The joints at one moment, or one taught target.
struct JointSample {
  explicit JointSample(int joints) : figures(JointVector::Zero(joints)) {}

  std::string name;              ///< of a taught target, or the row's pose; empty of a log by time
  int step = -1;                 ///< where the table names load steps; else -1
  int axis = -1;                 ///< where the table names the axis that turns, from 1; else -1
  std::optional<double> time_s;  ///< by the robot's clock
  JointVector figures;           ///< as the controller states them, rad
  Vector6d wrench = Vector6d::Constant(campaign::kNotGiven);  ///< force (N), moment (Nm), where the table has them
  double temperature_c = campaign::kNotGiven;
  campaign::StatedPose tool_pose = {};  ///< as the controller states it
  std::size_t line = 0;
};

/// Where a number stands in a text, bytes.
struct TextSpan {
  std::size_t from = 0, size = 0;
};

struct RobotLog {
  LogFormat format = LogFormat::columns;
  bool radians = false;  ///< the file states angles of joints in radians, not in degrees
  Encoding encoding = Encoding::utf8;
  std::vector<JointSample> samples;
  /// Of a program: where the figures of each sample stand in the text, joint by joint.
  std::vector<PerJoint<TextSpan>> places;
  /// Of each sample, as the controller states them, rad: angles of the motors' side over the gear ratio, and commanded
  /// ones, not a number where a row has none. Empty where the table has no such column.
  std::vector<JointVector> motor_side, commanded;
  std::vector<std::string> index;  ///< of each sample, of a table that has it beside pose; else empty
  std::vector<SkippedRow> skipped;
  std::vector<std::string> warnings;
};

/// What the user says of a log beside its bytes.
struct LogOptions {
  int joints = 6;  ///< of the machine; a log states as many
  std::optional<LogFormat> format;
  FileOptions table;              ///< of `columns`, and the encoding of all
  std::optional<double> rate_hz;  ///< of a log without times: samples a second
  /// Of a program: targets that stand in its instructions (PTP {A1 ...}, MoveAbsJ [[...]]), too, and not only those
  /// that are declared. They are called by their line.
  bool in_instructions = false;
  bool joints_needed = true;  ///< false: a file without joint angles is no error
};

}  // namespace stiffscope::interchange
