#include "core/simulation/spec.h"

namespace stiffscope::simulation {

SpringNow springNow(const LinkSpring& spring, const PerBody<Eigen::Isometry3d>& body_motions) {
  SpringNow now;
  now.from = body_motions[static_cast<std::size_t>(spring.from_body)] * spring.from_in_base_at_zero;
  now.to = body_motions[static_cast<std::size_t>(spring.to_body)] * spring.to_in_base_at_zero;
  const Eigen::Vector3d along = now.to - now.from;
  const double length = along.norm();
  const double longer = length - (spring.to_in_base_at_zero - spring.from_in_base_at_zero).norm();
  // Two ends that meet have no direction to pull in: the force is left out there.
  if (length > 0.0) {
    now.pull = (spring.tension + spring.rate * longer) / length * along;
  } else {
    now.pull.setZero();
  }
  now.energy = spring.tension * longer + 0.5 * spring.rate * longer * longer;
  return now;
}

}  // namespace stiffscope::simulation
