#include "core/diagnosis/posture_equations.h"

#include <Eigen/Dense>
#include <cmath>

#include "core/diagnosis/gap_covariance.h"
#include "core/diagnosis/normal_matrix.h"
#include "core/diagnosis/sag_by_body.h"

namespace stiffscope {

namespace {

/// Columns and right side of one posture but for the geometry's steps, unwhitened.
GapPosture unwhitened(const GapInput& input, const GapState& state, const ContainedEffects& now,
                      const GapLayout& layout, const GapRows& rows) {
  GapPosture posture;
  posture.pose = rows.pose;
  posture.states = rows.states;
  const Eigen::Index at_rest = input.absolute ? rows.position.size() : 0;
  const Eigen::Index per_state = rows.states.front().rows();
  posture.position_rows = at_rest;
  posture.columns.setZero(at_rest + rows.displacement.size(), layout.end);
  posture.right.resize(posture.columns.rows());
  posture.columns.bottomLeftCorner(rows.displacement.size(), 6) = rows.by_compliance;
  posture.right.tail(rows.displacement.size()) = rows.displacement;
  for (std::size_t m = 0; m < input.models.size(); ++m) {
    const Eigen::MatrixXd rest = input.models[m].columns(state.at, rows.states, 0);
    if (at_rest > 0) posture.columns.block(0, layout.model_at[m], at_rest, rest.cols()) = rest;
    for (std::size_t s = 1; s < rows.states.size(); ++s) {
      posture.columns.block(at_rest + static_cast<Eigen::Index>(s - 1) * per_state, layout.model_at[m],
                            per_state, rest.cols()) =
          input.models[m].columns(state.at, rows.states, s) - rest;
    }
  }
  if (at_rest > 0) {
    posture.columns.topLeftCorner(at_rest, 6) = rows.sag_by_compliance;
    posture.columns.block(0, layout.weights, at_rest, kBodies) = sagByBody(state.at, rows.states.front());
    posture.right.head(at_rest) = rows.position + rows.sag_by_compliance * state.at.compliance;
  }
  // What the corrections took off comes back, so that the right side is that of the whole effect.
  if (now.in_positions.size() > 0) {
    const Eigen::Index effects = now.in_positions.size();
    posture.right.head(at_rest) += posture.columns.topRightCorner(at_rest, effects) * now.in_positions;
    posture.right.tail(rows.displacement.size()) +=
        posture.columns.bottomRightCorner(rows.displacement.size(), effects) * now.in_deflections;
  }
  return posture;
}

/// Derivatives of measured less modelled by the geometry's steps: differences of the rows themselves.
void addGeometry(const GapInput& input, const GapState& state, const std::vector<GapRows>& rows,
                 GapData& data) {
  const Eigen::Index steps = GeometrySteps::count(input.campaign.targets.size());
  for (Eigen::Index k = 0; k < steps; ++k) {
    const LoadingGeometry there =
        moved(state.geometry, GeometrySteps::kSmall * Eigen::VectorXd::Unit(steps, k), state.at.epoch_centre);
    const auto other = loadingRows(input.campaign, there, state.at, state.corrections);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      GapPosture& posture = data.postures[i];
      auto column = posture.columns.col(data.layout.geometry + k);
      if (posture.position_rows > 0)
        column.head(posture.position_rows) = (rows[i].position - other[i].position) / GeometrySteps::kSmall;
      const Vector6d& c = state.at.compliance;
      column.tail(rows[i].displacement.size()) = ((rows[i].displacement - rows[i].by_compliance * c) -
                                                  (other[i].displacement - other[i].by_compliance * c)) /
                                                 GeometrySteps::kSmall;
    }
  }
}

Eigen::Matrix<double, 7, 7> stiffnessNormalOf(const GapPosture& posture, const Eigen::MatrixXd& covariance) {
  const Eigen::Index rows = posture.right.size() - posture.position_rows;
  Eigen::MatrixXd both(rows, 7);
  both << posture.columns.bottomLeftCorner(rows, 6), posture.right.tail(rows);
  covariance.bottomRightCorner(rows, rows).llt().matrixL().solveInPlace(both);
  return both.transpose() * both;
}

Eigen::MatrixXd normalOf(const GapPosture& posture, const Eigen::LLT<Eigen::MatrixXd>& noise) {
  Eigen::MatrixXd both(posture.columns.rows(), posture.columns.cols() + 1);
  both << posture.columns, posture.right;
  noise.matrixL().solveInPlace(both);
  return normalMatrix(both);
}

void whiten(const GapRows& rows, const GapCovariance& covariance, GapPosture& posture) {
  const Eigen::Index per_state = rows.states.front().rows();
  const Eigen::Index size = posture.right.size(), at_rest = posture.position_rows;
  posture.noise.resize(size, per_state);
  for (Eigen::Index at = 0; at < size; at += per_state) {
    posture.noise.middleRows(at, per_state) = covariance.by_measuring.block(at, at, per_state, per_state);
  }
  const Eigen::LLT<Eigen::MatrixXd> cholesky(covariance.whole);
  posture.position_lower =
      cholesky.matrixLLT().topLeftCorner(at_rest, at_rest).triangularView<Eigen::Lower>();
  posture.normal = LowerTriangle(normalOf(posture, cholesky));
  posture.stiffness_normal = stiffnessNormalOf(posture, covariance.whole);
}

}  // namespace

void addPostureEquations(const GapInput& input, const GapState& state, const ContainedEffects& effects_now,
                         GapData& data) {
  const auto rows = loadingRows(input.campaign, state.geometry, state.at, state.corrections);
  for (const GapRows& one : rows)
    data.postures.push_back(unwhitened(input, state, effects_now, data.layout, one));
  addGeometry(input, state, rows, data);
  double noise = 0.0, count = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    GapPosture& posture = data.postures[i];
    const GapCovariance covariance = gapCovariance(input, state, rows[i], posture.position_rows);
    whiten(rows[i], covariance, posture);
    noise += covariance.displacement_trace;
    count += covariance.displacements;
    data.loading_rows += posture.right.size();
  }
  data.state_noise = count > 0.0 ? std::sqrt(noise / count) : 0.0;
}

}  // namespace stiffscope
