#include "core/robot/balancer.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::robot {

namespace {

constexpr double kAtmospherePa = 101325.0;

Tension tensionOf(const SpringLaw& law, double length) {
  return {law.tension_n + law.rate_n_per_m * (length - law.length_m), law.rate_n_per_m};
}

double gasVolume(const GasLaw& law, double length) {
  return law.volume_m3 + (law.pushes ? 1.0 : -1.0) * law.area_m2 * (length - law.length_m);
}

Tension tensionOf(const GasLaw& law, double length) {
  // No arm stands where less is left; whoever asks for such a posture gets a number all the same.
  constexpr double kLeastShare = 1e-3;
  const double volume = std::max(gasVolume(law, length), kLeastShare * law.volume_m3);
  const double absolute = (law.pressure_pa + kAtmospherePa) * std::pow(law.volume_m3 / volume, law.exponent);
  const double force = (absolute - kAtmospherePa) * law.area_m2;
  return {law.pushes ? -force : force, law.exponent * absolute * law.area_m2 * law.area_m2 / volume};
}

constexpr double kApart = 1e-3;  // m: ends that are closer have no direction

Eigen::Vector3d placeOf(const BalancerEnd& end, const ArmPosture& posture) {
  return posture.motion[static_cast<std::size_t>(end.body)] * end.in_base_at_zero;
}

/// Of the outer end, by an axis.
Eigen::Vector3d velocityBy(const metrology::Line& axis, const PlacedBalancer& at) {
  return axis.direction.cross(at.outer_end - axis.point);
}

}  // namespace

Tension tensionAt(const Balancer& balancer, double length_m) {
  return std::visit([&](const auto& law) { return tensionOf(law, length_m); }, balancer.law);
}

double statedLength(const Balancer& balancer) {
  return std::visit([](const auto& law) { return law.length_m; }, balancer.law);
}

PlacedBalancer placedAt(const Balancer& balancer, const ArmPosture& posture) {
  const auto [inner, outer] = std::minmax(balancer.from, balancer.to,
                                          [](const BalancerEnd& a, const BalancerEnd& b) { return a.body < b.body; });
  PlacedBalancer at;
  at.inner = inner.body, at.outer = outer.body;
  at.inner_end = placeOf(inner, posture), at.outer_end = placeOf(outer, posture);
  const Eigen::Vector3d apart = at.outer_end - at.inner_end;
  at.length = std::max(apart.norm(), kApart);
  at.direction = apart / at.length;
  at.tension = tensionAt(balancer, at.length);
  return at;
}

void moveEnds(const Eigen::Isometry3d& motion, Balancer& balancer) {
  for (BalancerEnd* end : {&balancer.from, &balancer.to}) end->in_base_at_zero = motion * end->in_base_at_zero;
}

double lengthAt(const Balancer& balancer, const ArmPosture& posture) {
  return (placeOf(balancer.to, posture) - placeOf(balancer.from, posture)).norm();
}

bool withinStroke(const Balancer& balancer, double length_m) {
  if (balancer.shortest_m && length_m < *balancer.shortest_m) return false;
  if (balancer.longest_m && length_m > *balancer.longest_m) return false;
  const auto* gas = std::get_if<GasLaw>(&balancer.law);
  return length_m >= kApart && (gas == nullptr || gasVolume(*gas, length_m) > 0.0);
}

JointVector balancerTorque(const ArmAxes& axes, const ArmPosture& posture, const Balancer& balancer) {
  const PlacedBalancer at = placedAt(balancer, posture);
  JointVector torque = JointVector::Zero(static_cast<Eigen::Index>(axes.size()));
  for (int i = at.inner; i < at.outer; ++i)
    torque[i] = at.onOuter().dot(velocityBy(axes[static_cast<std::size_t>(i)], at));
  return torque;
}

void addBalancerForces(const Balancer& balancer, const ArmPosture& posture, PerBody<Wrench>& from_body) {
  const PlacedBalancer at = placedAt(balancer, posture);
  const Eigen::Vector3d force = at.onOuter(), moment = at.outer_end.cross(force);
  for (int body = at.inner + 1; body <= at.outer; ++body) {
    from_body[static_cast<std::size_t>(body)].force += force;
    from_body[static_cast<std::size_t>(body)].moment += moment;
  }
}

JointMatrix balancerStiffness(const ArmAxes& axes, const ArmPosture& posture, const Balancer& balancer) {
  const PlacedBalancer at = placedAt(balancer, posture);
  const auto count = static_cast<Eigen::Index>(axes.size());
  JointMatrix stiffness = JointMatrix::Zero(count, count);
  for (int far = at.inner; far < at.outer; ++far) {
    const Eigen::Vector3d by_far = velocityBy(axes[static_cast<std::size_t>(far)], at);
    for (int near = at.inner; near <= far; ++near) {
      const metrology::Line& axis = axes[static_cast<std::size_t>(near)];
      const Eigen::Vector3d by_near = velocityBy(axis, at);
      const double along = at.direction.dot(by_near) * at.direction.dot(by_far);
      const double curved = (by_near.dot(by_far) - along) / at.length + at.direction.dot(axis.direction.cross(by_far));
      stiffness(near, far) = stiffness(far, near) = -(at.tension.slope_n_per_m * along + at.tension.force_n * curved);
    }
  }
  return stiffness;
}

bool withinAxisLimits(const Robot& robot, const JointVector& q) {
  const JointVector angles = robot.axes_in_base_at_zero.angles(q);
  for (std::size_t axis = 0; axis < robot.axis_limits.size(); ++axis) {  // a robot that states none has none
    const JointLimits& limits = robot.axis_limits[axis];
    const double angle = angles[static_cast<Eigen::Index>(axis)];
    if (angle < limits.lower || angle > limits.upper) return false;
  }
  if (robot.balancers.empty()) return true;
  const ArmPosture posture = postureAt(robot, q);
  return std::all_of(robot.balancers.begin(), robot.balancers.end(),
                     [&](const Balancer& balancer) { return withinStroke(balancer, lengthAt(balancer, posture)); });
}

}  // namespace stiffscope::robot
