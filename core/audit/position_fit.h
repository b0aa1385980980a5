#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "core/audit/audit_input.h"
#include "core/frames/position_equations.h"

namespace stiffscope::audit {

// The fit of unloaded positions (AbsoluteFit) as sums over postures, for what asks it with other weights or a parameter
// more.

/// Weighted normal equations over the postures that take part, with what is known beforehand on the diagonal.
struct PositionNormal {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  double squares = 0.0;  ///< chi2 with all parameters at zero
  int rows = 0;
};

/// Weight in the common fit by the index of the posture; 0 for one that is left out.
using PostureWeights = std::vector<double>;

PostureWeights equalWeights(const frames::AbsoluteRows& rows);
PositionNormal sumUp(const frames::AbsoluteRows& rows, const PostureWeights& weights);

/// The sum of squares that is left; `held`: with the six parameters of the shift from there on at zero.
double leastSquares(PositionNormal normal, std::optional<Eigen::Index> held = {});

/// A fit that one posture cannot pull: each is weighted down by its own misfit against the median one
/// (Cauchy's weights, 2.385 being their usual constant), again and again.
struct RobustFit {
  Eigen::VectorXd parameters;
  PostureWeights weights;
};
RobustFit robustFit(const frames::AbsoluteRows& rows);

/// What moved while loading went on (MovedMeanwhile), taken off the rows. Found is a motion beyond chance and beyond
/// what geometry errors make of it, that takes more of the misfit with it than is left, and that explains the readings
/// better than stale angles of single postures do (BIC: a motion has six numbers and a place, the angles of a posture
/// six numbers). `weights_of`: 0 for the postures whose angles stand apart, which take no part.
std::vector<MovedMeanwhile> takeOffMoves(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                         const std::vector<campaign::StatePoints>& states,
                                         const std::function<PostureWeights(const frames::AbsoluteRows&)>& weights_of,
                                         frames::AbsoluteRows& rows);

}  // namespace stiffscope::audit
