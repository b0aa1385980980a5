#include "render/view_camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace stiffscope::render {

namespace {

constexpr double kSteepest = 1.52;  // rad; 87 degrees

struct Turntable {
  double heading = 0;  ///< of the view, about z, rad
  double dip = 0;      ///< downwards, rad
};

Turntable turntableOf(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d d = direction.normalized();
  const double level = d.head<2>().norm();
  // Straight down has y upwards: the heading is y's.
  return {level > 1e-9 ? std::atan2(d.y(), d.x()) : M_PI / 2, std::atan2(-d.z(), level)};
}

Eigen::Vector3d directionOf(const Turntable& at) {
  return {std::cos(at.dip) * std::cos(at.heading), std::cos(at.dip) * std::sin(at.heading), -std::sin(at.dip)};
}

/// Right and up on the picture for a view that is not vertical, or straight down with y upwards.
std::pair<Eigen::Vector3d, Eigen::Vector3d> rightAndUp(const Eigen::Vector3d& direction) {
  const double heading = turntableOf(direction).heading;
  const Eigen::Vector3d right(std::sin(heading), -std::cos(heading), 0);
  return {right, right.cross(direction)};
}

}  // namespace

void ViewCamera::look(View view) {
  view_ = view;
  direction_.reset();
  held_.reset();
}

void ViewCamera::hold() {
  if (!held_) held_ = last_;
}

void ViewCamera::turn(double about_vertical, double towards) {
  hold();
  Turntable at = turntableOf(direction_.value_or(render::directionOf(view_)));
  at.heading -= about_vertical;
  at.dip = std::clamp(at.dip + towards, -kSteepest, kSteepest);
  direction_ = directionOf(at);
}

void ViewCamera::shift(double right, double up) {
  hold();
  if (!held_) return;
  const auto axes = rightAndUp(direction_.value_or(render::directionOf(view_)));
  held_->centre -= held_->metres_high * (right * axes.first + up * axes.second);
}

void ViewCamera::zoom(double factor) {
  hold();
  if (held_) held_->metres_high = std::clamp(held_->metres_high / factor, 1e-3, 1e3);
}

void ViewCamera::apply(ArmScene& scene) const {
  scene.view = view_;
  scene.view_direction = direction_;
  scene.framing = held_;
}

}  // namespace stiffscope::render
