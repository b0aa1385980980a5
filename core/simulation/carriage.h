#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/numerics/random.h"
#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// The carriage of a rail through the day: what the controller reports of it, and where it truly is.
class Carriage {
 public:
  /// It stands at RailSpec::sweeps_at; of a robot without a rail it never moves. Stops are missed by random amounts of
  /// the measurement (stream "carriage").
  explicit Carriage(const SimulationSpec& spec);

  bool onRail() const { return rail_.has_value(); }

  /// Drives to a position that is then reported, m.
  void driveTo(double position);

  double reported() const { return position_; }
  /// Of everything on it against the carriage at zero, base_link, m: scale r d + straightness sin(2 pi r / wave)
  /// across, level and upwards, + what the stop missed along d; d the true direction.
  const Eigen::Vector3d& displacement() const { return displacement_; }

 private:
  Eigen::Vector3d along(double position) const;

  RailSpec spec_;
  std::optional<robot::Rail> rail_;
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  ///< true direction, across it, and across both
  numerics::RandomStream missed_;
  double position_ = 0.0;
  Eigen::Vector3d displacement_ = Eigen::Vector3d::Zero();
};

/// The true direction of the rail, level across it, and across both: columns in base_link.
Eigen::Matrix3d railAxes(const SimulationSpec& spec);

/// Where the carriage stands in so many postures, evenly at random between RailSpec::low and high (stream "rail" of the
/// seed). Nested, as postures are.
std::vector<double> carriagePositions(const SimulationSpec& spec, std::size_t postures);

}  // namespace stiffscope::simulation
