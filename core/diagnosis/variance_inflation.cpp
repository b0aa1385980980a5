#include "core/diagnosis/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/diagnosis/projection.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::diagnosis {

void estimateInflation(const SystemInput& input, const LinearSystem& data, SystemState& state) {
  if (!input.absolute) return;
  const Eigen::Index end = data.layout.end;
  Eigen::MatrixXd normal = sumOf(data, std::vector<double>(data.postures.size(), 1.0));
  normal.diagonal().segment(data.layout.effects, end - data.layout.effects) += priorsOf(input.models);
  Eigen::VectorXd scale =
      normal.diagonal().head(end).unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; });
  Eigen::MatrixXd even = scale.asDiagonal() * normal.topLeftCorner(end, end) * scale.asDiagonal();
  even.diagonal().setConstant(1.0 + 1e-10);
  const Eigen::VectorXd all = scale.asDiagonal() * solveSymmetric(even, scale.asDiagonal() * normal.col(end).head(end));
  double squares = 0.0, count = 0.0;
  for (const GapPosture& posture : data.postures) {
    const Eigen::Index rows = posture.position_rows;
    if (rows == 0) continue;
    Eigen::VectorXd left = posture.right.head(rows) - posture.columns.topRows(rows) * all;
    posture.position_lower.triangularView<Eigen::Lower>().solveInPlace(left);
    squares += left.squaredNorm();
    count += static_cast<double>(rows);
  }
  if (count > 0.0) state.position_inflation = std::max(1.0, state.position_inflation * squares / count);
  if (data.sweep_rows > 0) {
    Eigen::VectorXd both(end + 1);
    both << all, -1.0;
    const double left = both.dot(data.sweeps * both);
    state.sweep_inflation = std::max(1.0, state.sweep_inflation * left / static_cast<double>(data.sweep_rows));
  }
}

}  // namespace stiffscope::diagnosis
