#pragma once

#include <limits>

#include "core/diagnosis/fit.h"

namespace stiffscope::diagnosis {

/// The equations of a design with the readings, free of noise, of a field. `field`: effect parameters.
Projection withField(const Projection& projection, const Eigen::VectorXd& field);

/// chi2 by which the field of one effect, which `made` is made with, stays unexplained by another effect (its best
/// parameters) on top of `others`, which stay in the model. From `matters` on it may come out too large.
double separation(const SystemInput& input, const GapFit& fit, const Projection& made,
                  const std::vector<ChosenModel>& others, std::size_t by_model, const std::vector<bool>& allowed,
                  double matters = std::numeric_limits<double>::infinity());

/// Effects that noise hides from each other: a field is told apart from another effect's where that leaves
/// three standard deviations of chi2 or more.
inline constexpr double kSeparated = 9.0;

/// Groups of effects that this design (postures, loads, readings) cannot separate at twice the noise of one
/// state: each part of each effect against every other effect. Looks at columns only, at no reading.
std::vector<std::vector<effects::Effect>> designConfounding(const SystemInput& input, const GapFit& fit,
                                                            const std::vector<bool>& allowed);

}  // namespace stiffscope::diagnosis
