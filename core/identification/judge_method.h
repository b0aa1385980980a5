#pragma once

#include "core/identification/identification.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope {

/// Judges a solved method, `out.estimate`, on all postures and on subsets, and fills the rest of `out`. `equations` are
/// those of the arm's points, `normal` the method's normal equations, one a posture (byPosture); the decoupled method's
/// are those of P_wrist, and its second stage takes the reflectors'.
void judgeMethod(const LoadingGeometry& geometry, PointEquations equations, std::vector<NormalEquations> normal,
                 bool decoupled, const IdentifyOptions& options, MethodResult& out);

}  // namespace stiffscope
