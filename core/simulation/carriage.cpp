#include "core/simulation/carriage.h"

#include <cmath>
#include <numbers>

#include "core/numerics/random.h"
#include "core/simulation/rotation.h"

namespace stiffscope::simulation {

Carriage::Carriage(const SimulationSpec& spec)
    : spec_(spec.rail), rail_(spec.nominal.rail), missed_(noiseSeed(spec), "carriage") {
  if (!rail_) return;
  axes_ = railAxes(spec);
  driveTo(spec_.sweeps_at);
}

Eigen::Matrix3d railAxes(const SimulationSpec& spec) {
  const Eigen::Vector3d along = rotationExp(spec.rail.tilt) * spec.nominal.rail->direction_in_base;
  // Across a rail that stands upright any direction is level.
  const bool upright = along.head<2>().norm() < 1e-6;
  const Eigen::Vector3d level =
      (upright ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ().cross(along)).normalized();
  Eigen::Matrix3d axes;
  axes << along, level, along.cross(level);
  return axes;
}

void Carriage::driveTo(double position) {
  if (!rail_) return;
  position_ = position;
  displacement_ = along(position) + spec_.stop_sigma * missed_.normal() * axes_.col(0);
}

Eigen::Vector3d Carriage::along(double position) const {
  const double wave = spec_.straightness * std::sin(2.0 * std::numbers::pi * position / spec_.wave);
  return axes_ * Eigen::Vector3d(spec_.scale * position, wave, wave);
}

std::vector<double> carriagePositions(const SimulationSpec& spec, std::size_t postures) {
  numerics::RandomStream random(spec.seed, "rail");
  std::vector<double> positions(postures);
  for (double& position : positions) position = random.uniform(spec.rail.low, spec.rail.high);
  return positions;
}

}  // namespace stiffscope::simulation
