#include "core/frames/placed_arm.h"

#include <cmath>

#include "metrology/rigid_motion.h"

namespace stiffscope::frames {

AxesAtStart axesAtStart(const robot::ArmAxes& axes) {
  AxesAtStart start(axes.size());
  start.couplings = axes.couplings;
  for (std::size_t j = 0; j < start.size(); ++j) {
    start[j].line = axes[j];
    metrology::basisAcross(start[j].line.direction, start[j].across_u, start[j].across_v);
  }
  return start;
}

namespace {

SmallMotion carriedBy(const Eigen::Isometry3d& motion, const SmallMotion& small) {
  const Eigen::Vector3d turned = motion.linear() * small.rotation;
  return {turned, motion.linear() * small.shift - turned.cross(motion.translation())};
}

/// exp([r + dr]) = exp([J dr]) exp([r]) to first order (left Jacobian of SO(3)).
Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& r) {
  const double square = r.squaredNorm(), angle = std::sqrt(square);
  const bool small = angle < 1e-2;  // the next terms of the series are below 1e-11
  const double first = small ? 0.5 - square / 24.0 : (1.0 - std::cos(angle)) / square;
  const double second = small ? 1.0 / 6.0 - square / 120.0 : (angle - std::sin(angle)) / (square * angle);
  const Eigen::Matrix3d cross = metrology::crossMatrix(r);
  return Eigen::Matrix3d::Identity() + first * cross + second * cross * cross;
}

}  // namespace

PlacedArm::PlacedArm(const AxesAtStart& start, const Eigen::Vector3d& about)
    : PlacedArm(start, about, AxesSteps::Zero(ArmParameters(static_cast<int>(start.size())).axes()), Vector6d::Zero()) {
}

PlacedArm::PlacedArm(const AxesAtStart& start, const Eigen::Vector3d& about, const AxesSteps& axes_by,
                     const Vector6d& base_by)
    : steps(ArmParameters::kOfAxis * start.size()), centre(about) {
  axes.couplings = start.couplings;
  for (std::size_t j = 0; j < start.size(); ++j) {
    const Eigen::Vector4d own = axes_by.segment<4>(4 * static_cast<Eigen::Index>(j));
    const metrology::Line& axis = axes.emplace_back(own.isZero(0.0) ? start[j].line : start[j].moved(own));
    const double length = std::sqrt(1.0 + own.tail<2>().squaredNorm());
    const auto tilt = [&](const Eigen::Vector3d& across) {
      const Eigen::Vector3d rotation = axis.direction.cross(across) / length;
      return SmallMotion{rotation, -rotation.cross(axis.point)};
    };
    steps[4 * j].shift = start[j].across_u;
    steps[4 * j + 1].shift = start[j].across_v;
    steps[4 * j + 2] = tilt(start[j].across_u);
    steps[4 * j + 3] = tilt(start[j].across_v);
  }
  if (base_by.isZero(0.0)) return;
  base = metrology::motionAbout(centre, base_by).inverse();
  turn_by_rotation = leftJacobian(-base_by.head<3>());
}

SmallMotion PlacedArm::byBase(std::size_t k) const {
  if (k >= 3) return {Eigen::Vector3d::Zero(), -base.linear().col(static_cast<Eigen::Index>(k) - 3)};
  const Eigen::Vector3d rotation = turn_by_rotation.col(static_cast<Eigen::Index>(k));
  return {-rotation, rotation.cross(centre)};
}

PlacedPosture::PlacedPosture(const PlacedArm& arm, const robot::ArmPosture& posture)
    : arm_(arm), posture_(posture), of_axis_(arm.steps.size()), beyond_(arm.steps.size()) {
  for (std::size_t k = 0; k < of_axis_.size(); ++k) {
    const Eigen::Isometry3d &before = posture.motion[k / 4], &after = posture.motion[k / 4 + 1];
    if (k % 4 < 2) {  // an axis that shifts turns nothing
      of_axis_[k].shift = before.linear() * arm.steps[k].shift;
      beyond_[k].shift = of_axis_[k].shift - after.linear() * arm.steps[k].shift;
      continue;
    }
    of_axis_[k] = carriedBy(before, arm.steps[k]);
    const SmallMotion back = carriedBy(after, arm.steps[k]);
    beyond_[k] = {of_axis_[k].rotation - back.rotation, of_axis_[k].shift - back.shift};
  }
}

PointByAxes PlacedPosture::byAxes(const Eigen::Vector3d& position) const {
  PointByAxes columns(3, static_cast<Eigen::Index>(beyond_.size()));
  for (std::size_t k = 0; k < beyond_.size(); ++k) columns.col(static_cast<Eigen::Index>(k)) = beyond_[k].at(position);
  return columns;
}

Eigen::Matrix<double, 3, ArmParameters::kBase> PlacedPosture::byBase(const Eigen::Vector3d& position) const {
  Eigen::Matrix<double, 3, ArmParameters::kBase> columns;
  for (std::size_t k = 0; k < ArmParameters::kBase; ++k)
    columns.col(static_cast<Eigen::Index>(k)) = arm_.byBase(k).at(position);
  return columns;
}

SmallMotion PlacedPosture::byJoint(std::size_t j) const {
  const auto byAxis = [&](std::size_t axis) -> SmallMotion {
    const Eigen::Vector3d direction = posture_.motion[axis].linear() * arm_.axes[axis].direction;
    return {direction, (posture_.motion[axis] * arm_.axes[axis].point).cross(direction)};
  };
  if (!arm_.axes.couplings) return byAxis(j);
  SmallMotion all;
  for (std::size_t axis = 0; axis < arm_.axes.size(); ++axis) {
    const double turn = arm_.axes.couplings->turns(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(j));
    const SmallMotion own = byAxis(axis);
    all.rotation += turn * own.rotation;
    all.shift += turn * own.shift;
  }
  return all;
}

PointJacobian PlacedPosture::byAngles(const Eigen::Vector3d& position) const {
  robot::ArmAxes axes;
  axes.couplings = arm_.axes.couplings;
  for (std::size_t j = 0; j < arm_.axes.size(); ++j) {
    axes.push_back({posture_.motion[j] * arm_.axes[j].point, posture_.motion[j].linear() * arm_.axes[j].direction});
  }
  return robot::pointJacobianAt(axes, position);
}

}  // namespace stiffscope::frames
