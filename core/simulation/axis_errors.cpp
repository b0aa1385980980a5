#include "core/simulation/axis_errors.h"

#include <Eigen/Cholesky>

#include "core/simulation/random.h"
#include "core/simulation/rotation.h"

namespace stiffscope::simulation {

namespace {

constexpr double kMeets = 1e-6;  ///< m: nominal axes closer than this meet

/// The point where axes 4, 5 and 6 meet at zero, if they do.
std::optional<Eigen::Vector3d> wristCentre(const Robot& robot) {
  // The point with the least sum of squared distances from the three lines.
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int i = 3; i < 6; ++i) {
    const Line& axis = robot.axes_in_base_at_zero[i];
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis.direction * axis.direction.transpose();
    normal += across;
    right += across * axis.point;
  }
  const Eigen::Vector3d centre = normal.ldlt().solve(right);
  for (int i = 3; i < 6; ++i) {
    const Line& axis = robot.axes_in_base_at_zero[i];
    if ((centre - axis.point).cross(axis.direction).norm() > kMeets) return std::nullopt;
  }
  return centre;
}

}  // namespace

std::array<AxisError, 6> drawAxisErrors(const SimulationSpec& spec) {
  const GeometryErrors& geometry = spec.machine.geometry;
  RandomStream random(spec.seed, "geometry");
  std::array<AxisError, 6> errors;
  for (int i = 0; i < 6; ++i) {
    const Line& axis = spec.nominal.axes_in_base_at_zero[i];
    const Eigen::Matrix3d frame = frameAlong(axis.point, axis.direction).linear();
    const double position_sigma =
        i >= 4 ? geometry.wrist_position_sigma.value_or(geometry.position_sigma) : geometry.position_sigma;
    const auto across = [&](double sigma) -> Eigen::Vector3d {
      const double x = random.normal(), y = random.normal();
      return sigma * (frame.col(0) * x + frame.col(1) * y);
    };
    // Drawn for listed axes too, so that listing one leaves the others' draws as they were.
    errors[i].offset = across(position_sigma);
    errors[i].tilt = across(geometry.direction_sigma);
    errors[i].zero = geometry.zero_sigma * random.normal();
    if (geometry.listed[i]) errors[i] = *geometry.listed[i];
  }
  return errors;
}

Eigen::Isometry3d frameError(const Robot& nominal, int joint, const AxisError& error) {
  const std::optional<Eigen::Vector3d> wrist = joint >= 3 ? wristCentre(nominal) : std::nullopt;
  const Eigen::Vector3d pivot = wrist.value_or(nominal.axes_in_base_at_zero[joint].point);
  return Eigen::Translation3d(error.offset) * turnAbout(pivot, error.tilt);
}

}  // namespace stiffscope::simulation
