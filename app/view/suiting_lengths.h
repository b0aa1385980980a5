#pragma once

#include <vector>

#include "app/view/view_material.h"

namespace stiffscope {

/// The magnification, and the factor of the residual vectors, that suit a load step: the median over its
/// postures of what suits each, so that one posture with much deflection does not make the others' arrows
/// short. 1 where there are no vectors.
double magnificationForStep(const std::vector<ViewFrame>& frames, int step, double residual_factor);
double residualFactorForStep(const std::vector<ViewFrame>& frames, int step);

}  // namespace stiffscope
