#include "core/robot/geometric_stiffness.h"

#include "core/robot/balancer.h"

namespace stiffscope::robot {

namespace {

JointMatrix noStiffness(const ArmAxes& axes) {
  const auto count = static_cast<Eigen::Index>(axes.size());
  return JointMatrix::Zero(count, count);
}

/// Of joints, by that of the axes: joints turn axes in proportion, so that nothing of second order comes in.
JointMatrix ofJoints(const ArmAxes& axes, const JointMatrix& by_axes) {
  if (!axes.couplings) return by_axes;
  const JointMatrix& turns = axes.couplings->turns;
  return turns.transpose() * by_axes * turns;
}

/// A force at `point` of body `body`: axes 0..body-1 carry it.
void addForce(const ArmAxes& axes, int body, const Eigen::Vector3d& point, const Eigen::Vector3d& force,
              JointMatrix& stiffness) {
  for (int outer = 0; outer < body; ++outer) {
    const metrology::Line& far = axes[static_cast<std::size_t>(outer)];
    const Eigen::Vector3d change = far.direction.cross(point - far.point).cross(force);
    for (int inner = 0; inner <= outer; ++inner) {
      const double entry = axes[static_cast<std::size_t>(inner)].direction.dot(change);
      stiffness(inner, outer) += entry;
      if (inner != outer) stiffness(outer, inner) += entry;
    }
  }
}

}  // namespace

JointMatrix geometricStiffness(const ArmAxes& axes, const Wrench& wrench_in_base) {
  JointMatrix stiffness = noStiffness(axes);
  addForce(axes, static_cast<int>(axes.size()), wrench_in_base.point, wrench_in_base.force, stiffness);
  for (std::size_t turned = 1; turned < axes.size(); ++turned) {  // axis `turning` carries axis `turned` round
    for (std::size_t turning = 0; turning < turned; ++turning) {
      stiffness(static_cast<int>(turned), static_cast<int>(turning)) +=
          axes[turning].direction.cross(axes[turned].direction).dot(wrench_in_base.moment);
    }
  }
  return ofJoints(axes, stiffness);
}

JointMatrix geometricStiffness(const ArmAxes& axes, const ArmPosture& posture, const GravityLoad& weight) {
  JointMatrix stiffness = noStiffness(axes);
  if (!weight.any()) return ofJoints(axes, stiffness);
  for (int body = 1; body <= static_cast<int>(axes.size()); ++body) {
    const BodyMass& mass = weight.bodies[static_cast<std::size_t>(body)];
    if (mass.mass_kg == 0.0) continue;
    addForce(axes, body, posture.motion[static_cast<std::size_t>(body)] * mass.com_in_base_at_zero,
             mass.mass_kg * weight.gravity_in_base, stiffness);
  }
  for (const Balancer& balancer : weight.balancers) stiffness += balancerStiffness(axes, posture, balancer);
  return ofJoints(axes, stiffness);
}

}  // namespace stiffscope::robot
