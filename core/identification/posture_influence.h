#pragma once

#include <vector>

#include "core/identification/equations.h"
#include "core/identification/normal_equations.h"

namespace stiffscope {

/// How the residuals of a posture move the compliances, M_p in g_p = M_p A_p^T (b_p - A_p c), g_p its influence:
/// M_p A_p^T = N^-1 A_p^T (I - H_p)^-1/2, H_p = A_p N^-1 A_p^T. The root makes up for what the posture pulled the fit
/// towards itself (Bell and McCaffrey 2002, CR2), which matters for few postures. With N = L L^T and G = L^-1 A_p^T A_p L^-T
/// it acts on six numbers: M_p = L^-T (I - G)^-1/2 L^-1.
using PostureGain = Matrix6d;

/// Gains in one least-squares problem.
class PostureGains {
 public:
  PostureGains(const NormalEquations& sum, const JointMask& unknown);

  /// Of a posture by its own A_p^T A_p.
  PostureGain of(const Matrix6d& own) const;

 private:
  Matrix6d whiten_;  ///< L^-1 with the columns' scales; rows of joints that are no unknowns zero
};

/// N^-1 over the joints of the mask, the others' rows and columns zero.
Matrix6d inverseNormal(const NormalEquations& sum, const JointMask& unknown);

/// Degrees of freedom of a sum of squares of numbers with that covariance: tr^2 / tr(square), Satterthwaite's, as
/// Bell and McCaffrey (2002) give a scatter covariance its Student quantile.
double satterthwaite(const Eigen::MatrixXd& covariance);

/// Whether the two are of one posture.
bool sharePosture(const CaseEquations& a, const CaseEquations& b);

/// Equations of equal `posture` in a row, joined to one: the errors of a posture (its unloaded readings above all) are in
/// all its load steps, so it acts as one.
std::vector<CaseEquations> byPosture(std::vector<CaseEquations> equations);

/// The normal equations of those, one a posture.
std::vector<NormalEquations> normalByPosture(const std::vector<CaseEquations>& equations);

}  // namespace stiffscope
