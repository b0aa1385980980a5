#pragma once

#include <vector>

#include "core/identification/equations.h"
#include "core/identification/normal_equations.h"

namespace stiffscope {

/// 6 x rows of a posture: how its residuals move the compliances.
using PostureGain = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// N^-1 A_p^T (I - H_p)^-1/2, H_p = A_p N^-1 A_p^T. Times the residual b_p - A_p c it is the influence g_p of a
/// posture. The root makes up for what the posture pulled the fit towards itself (Bell and McCaffrey 2002, CR2), which
/// matters for few postures.
PostureGain correctedGain(const CaseEquations& equations, const NormalEquations& sum, const JointMask& unknown);

/// N^-1 over the joints of the mask, the others' rows and columns zero.
Matrix6d inverseNormal(const NormalEquations& sum, const JointMask& unknown);

/// Degrees of freedom of a sum of squares of numbers with that covariance: tr^2 / tr(square), Satterthwaite's, as
/// Bell and McCaffrey (2002) give a scatter covariance its Student quantile.
double satterthwaite(const Eigen::MatrixXd& covariance);

/// Equations of equal `posture` in a row, joined to one: the errors of a posture (its unloaded readings above all) are in
/// all its load steps, so it acts as one.
std::vector<CaseEquations> byPosture(const std::vector<CaseEquations>& equations);

}  // namespace stiffscope
