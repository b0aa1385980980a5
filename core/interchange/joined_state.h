#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/interchange/day_description.h"
#include "core/interchange/joint_log.h"

// What is joined: readings of points, states of the robot, and what is known of both files.

namespace stiffscope::interchange {

/// A reading with what its file and name say of it. The file's own point is not needed beside it.
struct DayReading {
  std::uint32_t source = 0;  ///< of the day's files of points
  std::uint32_t line = 0;    ///< of that file, which has fewer bytes than 2^32
  int target = 0, step = 0, axis = -1;
  std::string pose;  ///< empty: to be found by the clock
  std::string repeat;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m, in the file's frame
  double time_s = campaign::kNoTime, resolution_s = 0.0;

  bool hasTime() const { return !std::isnan(time_s); }
};

/// The joints of a pose, or of a load step of it, and the readings taken there.
struct JoinedState {
  std::string pose;
  int step = 0;
  int axis = -1;
  std::size_t first = 0, last = 0;  ///< samples of the log that its figures are the mean of
  JointVector figures;              ///< rad, as the controller states them; empty of a day that has no log
  std::vector<std::size_t> readings;
};

/// What the joining needs to know beside readings and log.
struct JoinTask {
  const DayDescription& day;
  const robot::Robot& robot;
  const LogSource& source;
  const RobotLog& log;
  std::string file;                   ///< the log's, for messages
  Role role = Role::loading;          ///< of the readings; sweeps take the joints alone
  std::vector<DayReading> lost = {};  ///< rows of lost beams, by file and line: they count where order says the posture
};

}  // namespace stiffscope::interchange
