#pragma once

#include <Eigen/Core>
#include <vector>

namespace stiffscope::numerics {

/// Columns of a Jacobian that the data cannot tell from those before them, in the order given: what is left
/// of such a column across the span of the earlier ones is under 1e-5 of its length. Parameters that the data
/// would rather determine come first in `order`.
std::vector<int> columnsInSpanOfEarlier(const Eigen::MatrixXd& jacobian, const std::vector<int>& order);

}  // namespace stiffscope::numerics
