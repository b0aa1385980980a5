#include "core/simulation/spec.h"

#include <cmath>

namespace stiffscope::simulation {

namespace {

struct Pull {
  double tension = 0.0, energy = 0.0;  ///< N; J from all joints zero
};

/// Of gas whose cylinder is `longer` than with all joints at zero: the work against gas inside and air outside, and its
/// derivative.
Pull pullOf(const CylinderGas& gas, double longer) {
  constexpr double kAir = 1.01325e5;  // Pa
  const double swept = (gas.pushes ? 1.0 : -1.0) * gas.area * longer;
  const double ratio = gas.volume / (gas.volume + swept), start = gas.pressure + kAir;
  const double now = start * std::pow(ratio, gas.exponent);
  const double compressed =
      gas.exponent == 1.0 ? start * gas.volume * std::log(ratio)
                          : start * gas.volume * (std::pow(ratio, gas.exponent - 1.0) - 1.0) / (gas.exponent - 1.0);
  return {(gas.pushes ? -1.0 : 1.0) * gas.area * (now - kAir), compressed + kAir * swept};
}

}  // namespace

SpringNow springNow(const LinkSpring& spring, const PerBody<Eigen::Isometry3d>& body_motions) {
  SpringNow now;
  now.from = body_motions[static_cast<std::size_t>(spring.from_body)] * spring.from_in_base_at_zero;
  now.to = body_motions[static_cast<std::size_t>(spring.to_body)] * spring.to_in_base_at_zero;
  const Eigen::Vector3d along = now.to - now.from;
  const double length = along.norm();
  const double longer = length - (spring.to_in_base_at_zero - spring.from_in_base_at_zero).norm();
  const Pull gas = spring.gas ? pullOf(*spring.gas, longer) : Pull{};
  // Two ends that meet have no direction to pull in: the force is left out there.
  if (length > 0.0) {
    now.pull = (spring.tension + spring.rate * longer + gas.tension) / length * along;
  } else {
    now.pull.setZero();
  }
  now.energy = spring.tension * longer + 0.5 * spring.rate * longer * longer + gas.energy;
  return now;
}

}  // namespace stiffscope::simulation
