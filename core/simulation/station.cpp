#include "core/simulation/station.h"

#include <algorithm>
#include <cmath>

#include "core/simulation/random.h"
#include "core/simulation/rotation.h"

namespace stiffscope::simulation {

namespace {

constexpr double kLongestDay = 200000.0;  ///< s; beyond it the walk stays where it is

Eigen::Isometry3d motionOf(const Vector6d& shift_and_turn) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = rotationExp(shift_and_turn.tail<3>());
  motion.translation() = shift_and_turn.head<3>();
  return motion;
}

}  // namespace

Station::Station(const SimulationSpec& spec)
    : spec_(spec.station), tracker_from_base_(spec.tracker.base_from_tracker.inverse()) {
  still_ = spec_.ramp.isZero(0.0) && spec_.walk.isZero(0.0) && !spec_.tracker_moved && !spec_.robot_moved &&
           spec_.scale == 0.0 && spec_.scale_per_second == 0.0;
  if (spec_.walk.isZero(0.0)) return;
  RandomStream random(noiseSeed(spec), "station walk");
  const int count = static_cast<int>(kLongestDay / spec_.knot_s) + 2;
  knots_.assign(1, Vector6d::Zero());
  for (int k = 1; k < count; ++k) {
    Vector6d draw;
    for (int i = 0; i < 6; ++i) draw[i] = random.normal();
    knots_.push_back(knots_.back() + std::sqrt(spec_.knot_s) * spec_.walk.cwiseProduct(draw));
  }
}

Vector6d Station::wandered(double time_s) const {
  Vector6d way = time_s * spec_.ramp;
  if (knots_.empty()) return way;
  const double at = std::clamp(time_s / spec_.knot_s, 0.0, static_cast<double>(knots_.size()) - 1.0);
  const std::size_t before = std::min(static_cast<std::size_t>(at), knots_.size() - 2);
  const double share = at - static_cast<double>(before);
  return way + (1.0 - share) * knots_[before] + share * knots_[before + 1];
}

Eigen::Vector3d Station::readFloor(const Eigen::Vector3d& point_in_base, double time_s) const {
  const Eigen::Vector3d point = tracker_from_base_ * point_in_base;
  if (still_) return point;
  Eigen::Isometry3d first_from_now = motionOf(wandered(time_s));
  if (loading_ && spec_.tracker_moved) first_from_now = *spec_.tracker_moved * first_from_now;
  const double scale = 1.0 + spec_.scale + spec_.scale_per_second * time_s;
  return scale * (first_from_now.inverse() * point);
}

Eigen::Vector3d Station::readRobot(const Eigen::Vector3d& point_in_base, double time_s) const {
  if (loading_ && spec_.robot_moved) return readFloor(*spec_.robot_moved * point_in_base, time_s);
  return readFloor(point_in_base, time_s);
}

}  // namespace stiffscope::simulation
