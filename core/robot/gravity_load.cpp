#include "core/robot/gravity_load.h"

#include <algorithm>

#include "core/robot/balancer.h"
#include "core/robot/spring_equilibrium.h"

namespace stiffscope::robot {

bool GravityLoad::any() const {
  if (!balancers.empty()) return true;
  return gravity_in_base.squaredNorm() > 0.0 && !bodies.empty() &&
         std::any_of(bodies.begin() + 1, bodies.end(), [](const BodyMass& body) { return body.mass_kg > 0.0; });
}

GravityLoad gravityLoad(const Robot& nominal, const std::optional<Tool>& tool,
                        const Eigen::Vector3d& gravity_in_base_link, const Robot& arm,
                        const Eigen::Isometry3d& base_from_base_link) {
  GravityLoad weight;
  weight.gravity_in_base = base_from_base_link.linear() * gravity_in_base_link;
  weight.links_known = true;
  weight.bodies.resize(nominal.bodies.size());
  for (std::size_t body = 1; body < weight.bodies.size(); ++body) {
    weight.bodies[body].mass_kg = nominal.bodies[body].mass_kg;
    weight.bodies[body].com_in_base_at_zero = base_from_base_link * nominal.bodies[body].com_in_base_at_zero;
    // An axis that only follows stands for rods beside a link, and has no body of its own where none is stated.
    const bool own = nominal.axes_in_base_at_zero.jointOf(static_cast<int>(body) - 1) >= 0;
    const bool carries = own && body >= 2 && static_cast<int>(body) <= nominal.armAxes() + 1;
    if (carries && weight.bodies[body].mass_kg <= 0.0) weight.links_known = false;
  }
  weight.balancers = nominal.balancers;
  for (Balancer& balancer : weight.balancers) moveEnds(base_from_base_link, balancer);
  if (tool && tool->mass_kg > 0.0) {
    BodyMass& last = weight.bodies.back();
    const Eigen::Vector3d tool_com = arm.base_from_flange_at_zero * tool->com_in_flange;
    const double together = last.mass_kg + tool->mass_kg;
    last.com_in_base_at_zero = (last.mass_kg * last.com_in_base_at_zero + tool->mass_kg * tool_com) / together;
    last.mass_kg = together;
  }
  return weight;
}

void scaleMasses(double factor, Robot& robot) {
  for (BodyMass& body : robot.bodies) body.mass_kg *= factor;
}

JointVector weightTorque(const Robot& robot, const ArmPosture& posture, const GravityLoad& weight) {
  // Sum from the tip inwards: force and moment about the base origin of all that hangs beyond each axis.
  if (weight.bodies.empty()) return JointVector::Zero(robot.joints());  // nothing weighs
  JointVector torque(robot.axes());
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  for (int i = robot.axes() - 1; i >= 0; --i) {
    const auto body = static_cast<std::size_t>(i) + 1;
    const Eigen::Vector3d pull = weight.bodies[body].mass_kg * weight.gravity_in_base;
    force += pull;
    moment += (posture.motion[body] * weight.bodies[body].com_in_base_at_zero).cross(pull);
    const metrology::Line axis = axisAt(robot, posture, i);
    torque[i] = axis.direction.dot(moment - axis.point.cross(force));
  }
  if (!weight.balancers.empty()) {
    const ArmAxes axes = axesAt(robot, posture);
    for (const Balancer& balancer : weight.balancers) torque += balancerTorque(axes, posture, balancer);
  }
  return robot.axes_in_base_at_zero.torques(torque);
}

JointVector saggedAngles(const Robot& robot, const JointVector& q, const GravityLoad& weight,
                         const JointVector& compliance) {
  if (!weight.any() || compliance.isZero()) return q;
  constexpr int kSteps = 3;
  return springEquilibrium(
             q, compliance, kSteps, 0.0,
             [&](const JointVector& angles) { return weightTorque(robot, postureAt(robot, angles), weight); })
      .angles;
}

}  // namespace stiffscope::robot
