#pragma once

#include "core/diagnosis/fit.h"

namespace stiffscope::diagnosis {

/// chi2 by which a field of one effect, free of noise, stays unexplained by another effect (its best
/// parameters) on top of `others`, which stay in the model. `field`: effect parameters of the one;
/// `projection`: of the design at hand.
double separation(const SystemInput& input, const GapFit& fit, const Projection& projection,
                  const Eigen::VectorXd& field, const std::vector<ChosenModel>& others, std::size_t by_model,
                  const std::vector<bool>& allowed);

/// Effects that noise hides from each other: a field is told apart from another effect's where that leaves
/// three standard deviations of chi2 or more.
inline constexpr double kSeparated = 9.0;

/// Groups of effects that this design (postures, loads, readings) cannot separate at twice the noise of one
/// state: each part of each effect against every other effect. Looks at columns only, at no reading.
std::vector<std::vector<effects::Effect>> designConfounding(const SystemInput& input, const GapFit& fit,
                                                            const std::vector<bool>& allowed);

}  // namespace stiffscope::diagnosis
