#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/robot/gravity_load.h"
#include "core/robot/robot.h"

namespace stiffscope::mistakes {

/// The tables of which reflectors are read; their joint angles stand in the same file, but those of the loading in the
/// file of the states.
enum class SourceTable { circle_sweeps, wrist_sweep, loading };
inline constexpr std::array kSourceTables{SourceTable::circle_sweeps, SourceTable::wrist_sweep, SourceTable::loading};

/// One reflector of the unloaded arm, as the files have it. rad, m.
struct UnloadedReading {
  SourceTable table = SourceTable::loading;
  int group = 0;  ///< what was read in one go: the sweep of an axis, a part of the wrist sweep, a posture
  int axis = -1;  ///< of a circle sweep
  int pose = -1;  ///< of the loading
  int target = 0;
  JointVector q;
  JointVector q_before, q_after;  ///< of the rows before and after in its table
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  std::size_t line = 0;
};

/// One reflector from the unloaded state to a loaded one, in the frame of the points.
struct ReflectorMove {
  int target = 0;
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
};

/// One loaded state of one posture.
struct LoadedReading {
  int pose = 0, step = 0;
  JointVector q;                       ///< unloaded
  Vector6d wrench = Vector6d::Zero();  ///< as the load cell's row says, force then moment
  std::vector<ReflectorMove> moves;
  std::size_t line = 0;  ///< in the states
};

/// What a mistake can be in: some of a day's readings, enough to tell a mistake by and few enough to try hundreds of
/// them. At most six readings of a reflector in the sweep of an axis, sixty of the wrist sweep, forty postures, and the
/// twenty reflectors that are read most often.
struct ReadingsOfDay {
  robot::Robot robot;
  robot::GravityLoad weight;  ///< in base_link axes
  std::vector<UnloadedReading> unloaded;
  std::vector<LoadedReading> loaded;
  int targets = 0, groups = 0;
  std::vector<int> campaign_target;  ///< by target: which of the campaign's it is
};

/// Sweeps and loading that are in one frame: that of the loading, of the circle sweeps where there is none. Means over
/// repeats. Displacements in base_link where there are no points.
ReadingsOfDay readingsOf(const campaign::Campaign& campaign);

/// The day with the readings, or the wrenches, of two load steps exchanged (a < b): of all postures, or of one.
ReadingsOfDay withStepsExchanged(const ReadingsOfDay& as_read, int a, int b, bool of_points, std::optional<int> pose);

/// The file in which the joint angles of a table stand, and the one in which its points do; empty where it is absent.
std::string fileOfAngles(const campaign::Campaign& campaign, SourceTable table);
std::string fileOfPoints(const campaign::Campaign& campaign, SourceTable table);

}  // namespace stiffscope::mistakes
