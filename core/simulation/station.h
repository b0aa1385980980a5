#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// Where the tracker stands through the day, and what it makes of a true point.
class Station {
 public:
  /// The walk's knots (stream "station walk") depend on the measurement: they are of the day, not the
  /// machine.
  explicit Station(const SimulationSpec& spec);

  void startLoading() { loading_ = true; }  ///< whatever was pushed before the loading has been pushed

  /// The reading of a point of the robot, or of one of the floor, given in the ground's base_link.
  Eigen::Vector3d readRobot(const Eigen::Vector3d& point_in_base, double time_s) const;
  Eigen::Vector3d readFloor(const Eigen::Vector3d& point_in_base, double time_s) const;

  /// Shift and turn of the station since the first reading, its own axes; ramp and walk, no push.
  Vector6d wandered(double time_s) const;

 private:
  StationSpec spec_;
  Eigen::Isometry3d tracker_from_base_;
  std::vector<Vector6d> knots_;  ///< the walk at knot_s * index
  bool still_ = true, loading_ = false;
};

}  // namespace stiffscope::simulation
