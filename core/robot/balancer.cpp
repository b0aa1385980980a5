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
  const double volume = gasVolume(law, length);
  const double absolute = (law.pressure_pa + kAtmospherePa) * std::pow(law.volume_m3 / volume, law.exponent);
  const double force = (absolute - kAtmospherePa) * law.area_m2;
  return {law.pushes ? -force : force, law.exponent * absolute * law.area_m2 * law.area_m2 / volume};
}

/// Axes from `first` to before `end` turn one end against the other; `velocity` of the outer end by each.
struct Stretch {
  int first = 0, end = 0;
  double length = 0.0;
  Eigen::Vector3d direction;  ///< from the inner end to the outer, unit
  PerJoint<Eigen::Vector3d> velocity;
};

Eigen::Vector3d placeOf(const BalancerEnd& end, const ArmPosture& posture) {
  return posture.motion[static_cast<std::size_t>(end.body)] * end.in_base_at_zero;
}

Stretch stretchAt(const ArmAxes& axes, const ArmPosture& posture, const Balancer& balancer) {
  const auto [inner, outer] = std::minmax(balancer.from, balancer.to,
                                          [](const BalancerEnd& a, const BalancerEnd& b) { return a.body < b.body; });
  const Eigen::Vector3d place = placeOf(outer, posture), apart = place - placeOf(inner, posture);
  Stretch stretch{inner.body, outer.body, apart.norm(), apart.normalized(), {}};
  for (const metrology::Line& axis : axes) stretch.velocity.push_back(axis.direction.cross(place - axis.point));
  return stretch;
}

}  // namespace

Tension tensionAt(const Balancer& balancer, double length_m) {
  return std::visit([&](const auto& law) { return tensionOf(law, length_m); }, balancer.law);
}

double lengthAt(const Balancer& balancer, const ArmPosture& posture) {
  return (placeOf(balancer.to, posture) - placeOf(balancer.from, posture)).norm();
}

bool withinStroke(const Balancer& balancer, double length_m) {
  if (balancer.shortest_m && length_m < *balancer.shortest_m) return false;
  if (balancer.longest_m && length_m > *balancer.longest_m) return false;
  const auto* gas = std::get_if<GasLaw>(&balancer.law);
  return length_m > 0.0 && (gas == nullptr || gasVolume(*gas, length_m) > 0.0);
}

JointVector balancerTorque(const ArmAxes& axes, const ArmPosture& posture, const Balancer& balancer) {
  const Stretch stretch = stretchAt(axes, posture, balancer);
  const double tension = tensionAt(balancer, stretch.length).force_n;
  JointVector torque = JointVector::Zero(static_cast<Eigen::Index>(axes.size()));
  for (int i = stretch.first; i < stretch.end; ++i)
    torque[i] = -tension * stretch.direction.dot(stretch.velocity[static_cast<std::size_t>(i)]);
  return torque;
}

JointMatrix balancerStiffness(const ArmAxes& axes, const ArmPosture& posture, const Balancer& balancer) {
  const Stretch stretch = stretchAt(axes, posture, balancer);
  const Tension tension = tensionAt(balancer, stretch.length);
  const auto count = static_cast<Eigen::Index>(axes.size());
  JointMatrix stiffness = JointMatrix::Zero(count, count);
  for (int far = stretch.first; far < stretch.end; ++far) {
    const Eigen::Vector3d& by_far = stretch.velocity[static_cast<std::size_t>(far)];
    for (int near = stretch.first; near <= far; ++near) {
      const Eigen::Vector3d& by_near = stretch.velocity[static_cast<std::size_t>(near)];
      const double along = stretch.direction.dot(by_near) * stretch.direction.dot(by_far);
      const double curved = (by_near.dot(by_far) - along) / stretch.length +
                            stretch.direction.dot(axes[static_cast<std::size_t>(near)].direction.cross(by_far));
      stiffness(near, far) = stiffness(far, near) = -(tension.slope_n_per_m * along + tension.force_n * curved);
    }
  }
  return stiffness;
}

}  // namespace stiffscope::robot
