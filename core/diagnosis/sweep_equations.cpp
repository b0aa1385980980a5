#include "core/diagnosis/sweep_equations.h"

#include <Eigen/Dense>

#include "core/diagnosis/normal_matrix.h"
#include "core/diagnosis/position_by_geometry.h"
#include "core/diagnosis/sag_by_body.h"
#include "core/frames/reading_covariance.h"

namespace stiffscope {

namespace {

/// [A y] of one posture, unwhitened.
template <class Rows>
void fill(const GapInput& input, const GapState& state, const ContainedEffects& now, const GapLayout& layout,
          const PositionByGeometry& by_geometry, const SweepRows& one, Rows both) {
  both.leftCols(6) = one.sag_by_compliance;
  both.middleCols(layout.geometry, layout.weights - layout.geometry) = by_geometry.of(one.state);
  both.middleCols(layout.weights, kBodies) = sagByBody(state.at, one.state);
  for (std::size_t m = 0; m < input.models.size(); ++m) {
    const Eigen::MatrixXd columns = input.models[m].columns(state.at, {one.state}, 0);
    both.middleCols(layout.model_at[m], columns.cols()) = columns;
  }
  auto right = both.col(both.cols() - 1);
  right = one.position + one.sag_by_compliance * state.at.compliance;
  if (now.in_positions.size() > 0)
    right += both.middleCols(layout.effects, now.in_positions.size()) * now.in_positions;
}

}  // namespace

void addSweepEquations(const GapInput& input, const GapState& state, const ContainedEffects& effects_now,
                       GapData& data) {
  const auto rows = sweepRows(input.campaign, state.geometry, state.r0_from_sweeps, state.at);
  const PositionByGeometry by_geometry(state.geometry, state.at, state.at.epoch_centre);
  Eigen::Index total = 0;
  for (const SweepRows& one : rows) total += one.position.size();
  Eigen::MatrixXd both = Eigen::MatrixXd::Zero(total, data.layout.end + 1);
  Eigen::Index row = 0;
  for (const SweepRows& one : rows) {
    fill(input, state, effects_now, data.layout, by_geometry, one, both.middleRows(row, one.position.size()));
    row += one.position.size();
  }
  row = 0;
  for (const SweepRows& one : rows) {
    for (const Eigen::Vector3d& point : one.state.points) {
      const Eigen::Matrix3d covariance =
          state.sweep_slack * readingCovariance(input.noise, state.r0_from_sweeps, point);
      both.middleRows<3>(row) = covariance.llt().matrixL().solve(both.middleRows<3>(row)).eval();
      row += 3;
    }
  }
  data.sweeps += normalMatrix(both);
  data.sweep_rows += total;
}

}  // namespace stiffscope
