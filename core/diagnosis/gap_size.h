#pragma once

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/gap_fit.h"

namespace stiffscope {

/// How large the gap of the deflection is, rms per coordinate: left by stiffnesses alone (`before`, on the
/// equations of `alone`, withoutEffects), by noise, and by `after`, a parameter vector (allParameters) of the
/// equations of `fit`.
Gap deflectionGap(const GapFit& alone, const StiffnessesAlone& before, const GapFit& fit,
                  const Eigen::VectorXd& after);

/// The same of the unloaded absolute positions; all zero where they are not held against the arm.
Gap positionGap(const GapFit& alone, const StiffnessesAlone& before, const GapFit& fit,
                const Eigen::VectorXd& after);

}  // namespace stiffscope
