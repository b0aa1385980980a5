#include "core/diagnosis/gap_covariance.h"

#include "core/frames/reading_covariance.h"

namespace stiffscope {

namespace {

/// The station between two rounds of the nests, where it was interpolated: one rigid motion of all
/// reflectors in a state, a Brownian bridge over time. Postures share it; that is left out.
void addWander(const GapInput& input, const GapRows& posture, Eigen::Index at_rest,
               const Eigen::Isometry3d& r0_from_points, Eigen::MatrixXd& covariance) {
  if (input.wandering == nullptr || input.wandering->wander.isZero()) return;
  const StationMotion& station = input.wandering->motion;
  const ArmState& rest = posture.states.front();
  const Eigen::Vector3d centre = r0_from_points * station.centre;
  Eigen::MatrixXd motion(rest.rows(), 6);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = r0_from_points.linear().col(k);
    motion.col(k) = byMotion(rest, centre, axis, Eigen::Vector3d::Zero());
    motion.col(3 + k) = byMotion(rest, centre, Eigen::Vector3d::Zero(), axis);
  }
  const Eigen::MatrixXd a_second = motion * input.wandering->wander * motion.transpose();
  const auto bridge = [&](std::size_t s, std::size_t r) {
    return bridgeBetweenRounds(station, posture.states[s].time_s, posture.states[r].time_s);
  };
  const Eigen::Index per_state = rest.rows();
  const std::size_t first = at_rest > 0 ? 0 : 1;
  for (std::size_t s = first; s < posture.states.size(); ++s) {
    for (std::size_t r = first; r < posture.states.size(); ++r) {
      double seconds = bridge(s, r);
      if (s > 0) seconds -= bridge(0, r);
      if (r > 0) seconds -= bridge(s, 0);
      if (s > 0 && r > 0) seconds += bridge(0, 0);
      covariance.block(static_cast<Eigen::Index>(s - first) * per_state,
                       static_cast<Eigen::Index>(r - first) * per_state, per_state, per_state) +=
          seconds * a_second;
    }
  }
}

/// What the model is not good for: more noise in absolute positions; in a deflection an error that grows
/// with the load, one number a posture, reflector and direction, so that it counts once however many load
/// steps show it.
void addModelError(const GapState& state, const GapRows& rows, Eigen::Index at_rest,
                   Eigen::MatrixXd& covariance) {
  const Eigen::Index per_state = rows.states.front().rows();
  covariance.topLeftCorner(at_rest, at_rest) *= state.position_slack;
  const double variance = state.model_error * state.model_error;
  if (variance == 0.0) return;
  const auto share = [&](std::size_t s) { return rows.states[s].load.force.norm() / state.at.largest_force; };
  for (std::size_t s = 1; s < rows.states.size(); ++s) {
    for (std::size_t r = 1; r < rows.states.size(); ++r) {
      covariance
          .block(at_rest + static_cast<Eigen::Index>(s - 1) * per_state,
                 at_rest + static_cast<Eigen::Index>(r - 1) * per_state, per_state, per_state)
          .diagonal()
          .array() += variance * share(s) * share(r);
    }
  }
}

}  // namespace

GapCovariance gapCovariance(const GapInput& input, const GapState& state, const GapRows& rows,
                            Eigen::Index at_rest) {
  GapCovariance result;
  const Eigen::Index per_state = rows.states.front().rows();
  const auto steps = static_cast<Eigen::Index>(rows.states.size()) - 1;
  const Eigen::Index size = at_rest + steps * per_state;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  // Displacements alone are in the frame of their station.
  const Eigen::Isometry3d r0_from_points =
      state.geometry.r0_from_loading.value_or(state.at.r0_from_base_link);
  for (std::size_t t = 0; t < rows.states.front().points.size(); ++t) {
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(t);
    const Eigen::Matrix3d reading =
        readingCovariance(input.noise, r0_from_points, rows.states.front().points[t]);
    const Eigen::Matrix3d rest = reading / rows.unloaded_readings, loaded = reading / rows.loaded_readings;
    result.displacement_trace += (rest + loaded).trace() * static_cast<double>(steps);
    result.displacements += 3.0 * static_cast<double>(steps);
    if (at_rest > 0) covariance.block<3, 3>(row, row) = rest;
    for (Eigen::Index s = 0; s < steps; ++s) {
      const Eigen::Index i = at_rest + s * per_state + row;
      if (at_rest > 0) covariance.block<3, 3>(i, row) = covariance.block<3, 3>(row, i) = -rest;
      for (Eigen::Index r = 0; r < steps; ++r) {
        covariance.block<3, 3>(i, at_rest + r * per_state + row) = rest;
      }
      covariance.block<3, 3>(i, i) += loaded;
    }
  }
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(input.force_sigma * input.force_sigma),
      Eigen::Vector3d::Constant(input.moment_sigma * input.moment_sigma);
  for (Eigen::Index s = 0; s < steps; ++s) {
    const auto& by_wrench = rows.by_wrench[static_cast<std::size_t>(s)];
    covariance.block(at_rest + s * per_state, at_rest + s * per_state, per_state, per_state) +=
        by_wrench * variances.asDiagonal() * by_wrench.transpose();
  }
  addWander(input, rows, at_rest, r0_from_points, covariance);
  result.by_measuring = covariance;
  addModelError(state, rows, at_rest, covariance);
  result.whole = std::move(covariance);
  return result;
}

}  // namespace stiffscope
