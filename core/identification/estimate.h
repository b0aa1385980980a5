#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/identification/equations.h"
#include "core/identification/identifiability.h"

namespace stiffscope::identification {

/// What the covariance of the compliances is made of; independent of each other, so that they add.
///
/// `scatter` is the errors that differ between postures, whatever they are: the tracker's noise, the load cell's, the
/// angles', and what joint springs do not explain. The others are errors that all postures share, which no scatter
/// shows: derivatives of the whole solution times the covariance of what was estimated on the way. Two loops are left
/// out, both of a thousandth: noise of the unloaded readings that also calibrate Partial Pose's geometry, and
/// stiffnesses that take the sag off the sweeps they stand on. A load cell's gain, axes and point are taken as
/// declared: the format has no uncertainty for them.
struct CovarianceParts {
  JointMatrix scatter;
  JointMatrix frames;    ///< the measured axes: R0, links, the flange's place
  JointMatrix wrist;     ///< radii about the wrist centre
  JointMatrix geometry;  ///< calibrated on the unloaded positions, Partial Pose only
  JointMatrix effects;   ///< fitted to the same data and taken off it; zero without any

  CovarianceParts() = default;  ///< of no joints
  /// All zero.
  explicit CovarianceParts(Eigen::Index joints)
      : scatter(JointMatrix::Zero(joints, joints)),
        frames(scatter),
        wrist(scatter),
        geometry(scatter),
        effects(scatter) {}

  JointMatrix total() const { return scatter + frames + wrist + geometry + effects; }
};

/// Between two numbers; infinite where it is open.
struct CoverageInterval {
  double low = 0.0, high = 0.0;
  bool holds(double value) const { return low <= value && value <= high; }
};

/// Joint stiffnesses by one method, from one set of load cases.
struct StiffnessEstimate {
  JointVector compliance;  ///< c = 1/k, rad/Nm; 0 for a joint that is not identifiable
  /// Of c: `parts` summed, what scatters between the postures and what they all have in common.
  JointMatrix covariance;
  CovarianceParts parts;
  std::vector<JointVector> influences;  ///< g_p, one a posture
  JointVector scatter_dof;              ///< of the scatter, by matchedDof
  /// Where effects besides joint springs were weighed (extended_model/hidden_effects.h): for each joint the interval of
  /// c at the stated coverage, which holds what could still hide. Empty without: Student's interval is the stated one.
  std::vector<CoverageInterval> stated;
  robot::JointMask identifiable;
  double condition = 0.0;     ///< of the stacked equations, columns scaled to unit length
  double rms_residual = 0.0;  ///< plain, of the positions the method fits, per coordinate, m
  double sigma = 0.0;         ///< the same over degrees of freedom, m

  StiffnessEstimate() = default;  ///< of no joints
  /// Nothing identifiable, all zero.
  explicit StiffnessEstimate(int joints)
      : compliance(JointVector::Zero(joints)),
        covariance(JointMatrix::Zero(joints, joints)),
        parts(joints),
        scatter_dof(JointVector::Zero(joints)),
        identifiable(static_cast<std::size_t>(joints), false) {}

  int joints() const { return static_cast<int>(compliance.size()); }

  /// Effective degrees of freedom of a compliance's uncertainty (Welch and Satterthwaite): the shared parts count as
  /// known exactly.
  double dof(int joint) const;

  double stiffness(int joint) const { return 1.0 / compliance[joint]; }
  /// Standard uncertainty of k to first order, sd(c) / c^2.
  double stiffnessSd(int joint) const;
  /// What a reader must know of the entry: "negative", "imprecise" (u above the value, or half of a stated U), or
  /// empty.
  Remark mark(int joint) const;
};

/// Covariance of least squares from the scatter between postures, which errors shared within a posture (its
/// unloaded readings, its wrench) do not fool: the sum of g_p g_p^T over the influences g_p of the postures.
/// Not a number with fewer than two postures beyond those that `unknowns` take up, a posture giving `per_posture` of
/// them: by the tracker the three coordinates of what it sees.
JointMatrix scatterCovariance(const std::vector<JointVector>& influences, const robot::JointMask& unknown,
                              double per_posture = 3.0);

/// Puts influences, scatter covariance and its degrees of freedom into an estimate, and the covariance so far.
void setScatter(std::vector<JointVector> influences, const JointVector& dof, StiffnessEstimate& estimate,
                double per_posture = 3.0);

/// The same of one least-squares problem, a posture each, solved by `estimate.compliance` over `estimate.identifiable`.
void setScatterOfOneStage(const std::vector<NormalEquations>& normal, const NormalEquations& sum,
                          StiffnessEstimate& estimate, double per_posture = 3.0);

/// Fills rms_residual and sigma from the positional residuals of `equations`.
void describeResiduals(const std::vector<CaseEquations>& equations, StiffnessEstimate& estimate);

/// k of U = k u for a normal error whose estimated variance is a sum of squares of correlated normal numbers: weights,
/// the eigenvalues of the numbers' covariance, positive. By Craig's integral, P(|z| > k s) = 2/pi times the integral
/// over 0..pi/2 of prod (1 + k^2 w_i / sin^2 t)^-1/2, w normalised to sum one; exact for independent z and s.
double coverageFactor(const Eigen::VectorXd& weights, double coverage);

/// `count` more weights of one size; count need not be whole.
struct EqualWeights {
  double weight = 0.0;
  double count = 0.0;
};
double coverageFactor(const Eigen::VectorXd& weights, const EqualWeights& more, double coverage);

/// The same for Student's t of any degrees of freedom (weights 1/nu, nu times).
double studentFactor(double dof, double coverage);

/// Of a joint's compliance: Student's, with the estimate's effective degrees of freedom. NaN where there are none.
double coverageFactor(const StiffnessEstimate& estimate, int joint, double coverage);

/// Degrees of freedom of Student's t with the same factor at the stated coverage as a sum of squares of influences with
/// that covariance. Satterthwaite's match the second moment instead, and where one posture makes most of a
/// scatter (fewer than five degrees) state intervals that hold the truth 98 % of the time instead of 95 %.
double matchedDof(const Eigen::MatrixXd& influence_covariance, const EqualWeights& more = {});

/// How the residuals of a posture move the compliances, M_p in g_p = M_p A_p^T (b_p - A_p c), g_p its influence:
/// M_p A_p^T = N^-1 A_p^T (I - H_p)^-1/2, H_p = A_p N^-1 A_p^T. The root makes up for what the posture pulled the fit
/// towards itself (Bell and McCaffrey 2002, CR2), which matters for few postures. With N = L L^T and G = L^-1 A_p^T A_p
/// L^-T it acts on one number a joint: M_p = L^-T (I - G)^-1/2 L^-1.
using PostureGain = JointMatrix;

/// Those of many postures, without the room that a JointMatrix keeps for more joints.
class GainOfEach {
 public:
  GainOfEach(Eigen::Index joints, std::size_t postures)
      : all_(joints, joints * static_cast<Eigen::Index>(postures)), postures_(postures) {}

  std::size_t size() const { return postures_; }
  auto operator[](std::size_t posture) { return all_.middleCols(first(posture), all_.rows()); }
  auto operator[](std::size_t posture) const { return all_.middleCols(first(posture), all_.rows()); }

 private:
  Eigen::Index first(std::size_t posture) const { return static_cast<Eigen::Index>(posture) * all_.rows(); }

  Eigen::MatrixXd all_;
  std::size_t postures_;
};

/// Gains in one least-squares problem.
class PostureGains {
 public:
  PostureGains(const NormalEquations& sum, const robot::JointMask& unknown);

  /// Of a posture by its own A_p^T A_p.
  PostureGain of(const JointMatrix& own) const;

 private:
  JointMatrix whiten_;  ///< L^-1 with the columns' scales; rows of joints that are no unknowns zero
};

/// N^-1 over the joints of the mask, the others' rows and columns zero.
JointMatrix inverseNormal(const NormalEquations& sum, const robot::JointMask& unknown);

/// Degrees of freedom of a sum of squares of numbers with that covariance: tr^2 / tr(square), Satterthwaite's, as
/// Bell and McCaffrey (2002) give a scatter covariance its Student quantile.
double satterthwaite(const Eigen::MatrixXd& covariance);

/// Whether the two are of one posture.
bool sharePosture(const CaseEquations& a, const CaseEquations& b);

/// Equations of equal `posture` in a row, joined to one: the errors of a posture (its unloaded readings above all) are
/// in all its load steps, so it acts as one.
std::vector<CaseEquations> byPosture(std::vector<CaseEquations> equations);

/// The normal equations of those, one a posture.
std::vector<NormalEquations> normalByPosture(const std::vector<CaseEquations>& equations);

/// Covariance between the influences of n postures on one joint, C = diag(own) + through^T middle through. What ties
/// postures together is the few parameters they share, so C is a diagonal and a matrix of rank r, two a joint at most;
/// as n x n numbers it would cost n^2 in memory and its eigenvalues n^3.
struct InfluenceCovariance {
  Eigen::VectorXd own;      ///< n
  Eigen::MatrixXd through;  ///< r x n
  Eigen::MatrixXd middle;   ///< r x r, symmetric

  double trace() const;
  /// Sum of the squares of all entries of C, in n r^2.
  double squaredNorm() const;
  /// The entries of C between these postures.
  Eigen::MatrixXd between(const std::vector<Eigen::Index>& postures) const;
};

/// a first + b second, of the same postures.
InfluenceCovariance combined(double a, const InfluenceCovariance& first, double b, const InfluenceCovariance& second);

/// If all residuals came from errors that are independent and have variance 1: with l_p the row of M_p A_p^T
/// (PostureGain) and U_p = A_p^T l_p, C_pq = delta_pq |l_p|^2 - U_p^T N^-1 U_q. `normal`: A_p^T A_p.
InfluenceCovariance influenceCovariance(const GainOfEach& gains, const std::vector<NormalEquations>& normal,
                                        const JointMatrix& inverse, int joint);

/// Degrees of freedom of Student's t with the same factor at the stated coverage as a sum of squares of influences with
/// that covariance. Up to 64 postures by the eigenvalues of C. Of more, the 64 with the largest influence are taken so
/// and the others, each below a 64th of the sum, as equal weights of the same trace, C's squares kept: for them only
/// the second moment matters.
double matchedDof(const InfluenceCovariance& covariance);

/// (I - G)^-1/2 of a symmetric G with eigenvalues in 0 .. 1, a thousand postures' as well as two's: what a residual of
/// equations that are part of the fit is multiplied by, G their hat matrix.
Eigen::MatrixXd inverseRootOfRest(const Eigen::MatrixXd& g);

/// Coverage of the intervals that reports state.
inline constexpr double kStatedCoverage = 0.95;
/// Coverage factor of a normal number at that coverage.
inline constexpr double kNormalFactor = 1.959963984540054;

/// The estimate's own `stated` one where it has that and `coverage` is the stated one; else c -+ t u(c), t the quantile
/// of Student's distribution with the estimate's effective degrees of freedom. Infinite where the postures are too few
/// for an uncertainty.
CoverageInterval complianceInterval(const StiffnessEstimate& estimate, int joint, double coverage = kStatedCoverage);

/// 1/c over an interval of compliances. Where that includes zero, the data only says that the joint is stiffer than
/// 1/high: the result is open above. Both ends negative for an interval that lies below zero.
CoverageInterval stiffnessInterval(const CoverageInterval& compliance);
CoverageInterval stiffnessInterval(const StiffnessEstimate& estimate, int joint, double coverage = kStatedCoverage);

/// U of k, Nm/rad, at the stated coverage: t u(k) to first order, or, of an estimate with a `stated` interval, the
/// distance of its farther end, so that k -+ U holds it. Infinite where the interval is open.
double expandedUncertainty(const StiffnessEstimate& estimate, int joint);

/// Standard deviation, rad/Nm, of a normal number that has c's coverage factor: u(c) by Student's over the normal
/// quantile at the stated coverage. For sums of such numbers with others.
double coveringSd(const StiffnessEstimate& estimate, int joint);

/// The covariance scaled to those; rows and columns of joints that are not identifiable are zero.
JointMatrix coveringCovariance(const StiffnessEstimate& estimate);

/// Correlation of the compliances; rows and columns of joints that are not identifiable are zero.
JointMatrix correlation(const StiffnessEstimate& estimate);

}  // namespace stiffscope::identification
