#pragma once

#include <ceres/sized_cost_function.h>

#include "core/identification/position_residual.h"

namespace stiffscope {

/// PositionResidual with its derivatives by axes, base and target. A joint's turn depends on that axis's four numbers and
/// on the point that it turns, so each is differentiated by those seven alone and the chain is multiplied out from the
/// base to the target: a tenth of the work of carrying all 33 derivatives through every step.
class PositionCost : public ceres::SizedCostFunction<3, 24, 6, 3> {
 public:
  explicit PositionCost(PositionResidual residual) : residual_(std::move(residual)) {}

  const PositionResidual& residual() const { return residual_; }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;

 private:
  PositionResidual residual_;
};

}  // namespace stiffscope
