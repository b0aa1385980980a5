#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "core/robot/robot.h"

// The tables of a campaign, one struct a row, in SI and radians. `target`, `pose` and `nest` are indices into
// the lists of the Campaign; `line` is the row's line in its file, so that a finding can name it.
// A time that the table does not have is NaN.

namespace stiffscope {

enum class PointFrame { tracker, base_link };

inline constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();

struct CircleReading {
  int axis = 0;  ///< 0..5 for axes 1..6
  std::string index;
  int target = 0;
  Vector6d q = Vector6d::Zero();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double time_s = kNoTime;
  std::size_t line = 0;
};

struct WristReading {
  std::string index;
  int target = 0;
  Vector6d q = Vector6d::Zero();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double time_s = kNoTime;
  std::size_t line = 0;
};

struct LoadingReading {
  int pose = 0;
  int step = 0;
  std::string repeat;
  int target = 0;
  double time_s = kNoTime;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  std::size_t line = 0;
};

struct State {
  int pose = 0;
  int step = 0;
  double time_s = kNoTime;
  Vector6d q = Vector6d::Zero();
  Vector6d wrench_in_cell = Vector6d::Zero();  ///< force (N) then moment (Nm), as the load cell's row says
  std::size_t line = 0;
};

struct Displacement {
  int pose = 0;
  int step = 0;
  int target = 0;
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< from step 0, m
  std::size_t line = 0;
};

struct NestReading {
  double time_s = kNoTime;
  int nest = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  std::size_t line = 0;
};

/// A table with its frame and its file name (as in campaign.xml).
template <class Row>
struct Table {
  std::string file;
  PointFrame frame = PointFrame::tracker;
  std::vector<Row> rows;
};

using CircleSweeps = Table<CircleReading>;
using WristSweep = Table<WristReading>;
using Loading = Table<LoadingReading>;
using States = Table<State>;
using Displacements = Table<Displacement>;
using Nests = Table<NestReading>;

}  // namespace stiffscope
