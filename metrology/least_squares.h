#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "metrology/measured_points.h"

namespace stiffscope::metrology {

/// One group of readings (a reflector's, say) in local coordinates.
struct LocalGroup {
  std::vector<Eigen::Vector3d> points;
  const std::vector<Eigen::Matrix3d>* covariances = nullptr;  ///< in the unit of the readings; null: none
};

/// Readings about their mean, in units of their own size: x = origin + scale x_local. Far from the origin
/// nothing is lost by this, and squares neither overflow nor lose the small against the large. The scale is a
/// power of two, so that scaling rounds nothing; local coordinates lie within -2..2.
struct LocalPoints {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double scale = 1.0;
  double rounding = 0.0;  ///< of the readings' coordinates in double precision, in local units
  std::vector<LocalGroup> groups;
  Remark flaw;  ///< why nothing can be fitted to the readings; empty where something can

  std::size_t count() const;
  bool weighted() const { return groups.front().covariances != nullptr; }
};

/// The readings must outlive the result, which refers to their covariances. Flaws: no readings, numbers that
/// are not finite, covariances that are not one a point and positive definite, all readings in one place, or
/// so far from the origin that double precision holds less than four digits of their spread.
LocalPoints localPoints(const MeasuredPoints* groups, std::size_t count);

/// The pooled spread of all points about the means of their groups: eigenvalues of the scatter matrix,
/// ascending (local units squared), and the directions that belong to them.
struct PrincipalAxes {
  Eigen::Vector3d spread;
  Eigen::Matrix3d directions;
};

PrincipalAxes principalAxes(const LocalPoints& local);

/// Do two spreads (eigenvalues of a scatter of points) tell a direction from rounding? `small` must be more
/// than a millionth of `large` in length, and more than the coordinates' rounding.
bool spreads(double small, double large, const LocalPoints& local);

/// Do the greater of two neighbouring spreads and its direction stand out from the lesser? For `count` points
/// of one scatter in both directions the difference of the two lies, at 95 %, below 4.9 times the root of
/// their product over the count (the spread of a 2x2 Wishart matrix: twice a Rayleigh variable).
bool standsOut(double greater, double lesser, std::size_t count);

/// What a model computes for one point.
struct Observation {
  static constexpr int kMaxResiduals = 3, kMaxColumns = 6;
  /// Only the model's own number of residuals, and of columns (shared, own), has a meaning.
  std::array<double, kMaxResiduals> residual;
  std::array<std::array<double, kMaxColumns>, kMaxResiduals> rows;  ///< derivatives
  std::array<Eigen::Vector3d, kMaxResiduals> directions;            ///< in space, whose variance a residual has

  double squaredNorm(int residuals) const {
    double sum = 0.0;
    for (int r = 0; r < residuals; ++r) sum += residual[r] * residual[r];
    return sum;
  }
};

/// A shape for weighted least squares of its geometric residuals. Residuals are the difference of nearly equal
/// numbers and set the precision of the answer, hence models evaluate them in extended precision; everything else
/// may be double, since it only steers the steps.
class Model {
 public:
  struct Size {
    int shared = 0;     ///< parameters that all groups of points share, moved by `move`
    int own = 0;        ///< parameters of each group alone (a radius, a height), to which steps are added
    int residuals = 1;  ///< of one point
    int columns() const { return shared + own; }
  };

  virtual ~Model() = default;
  virtual Size size() const = 0;
  /// Evaluates residuals and derivatives at the i-th point of a group, by the group's own parameters.
  virtual void observe(std::size_t i, const Eigen::Vector3d& point, const double* own, Observation& seen) const = 0;
  /// Moves the shared parameters from where the model stands.
  virtual void move(const Eigen::VectorXd& step) = 0;
  /// Takes the last move back.
  virtual void undo() = 0;
};

/// The observation of the i-th point of a group, divided by the standard deviations (the Cholesky factor of the
/// residuals' covariance) where there are covariances.
Observation whitened(const Model& model, const double* own, const LocalPoints& local, const LocalGroup& group,
                     std::size_t i);

/// What a model's points leave, with the inverse of its normal matrix. The order of `cofactor` is shared, own of the
/// first group, own of the second, ... All in local units.
struct Estimate {
  Eigen::MatrixXd own;  ///< a column a group
  Eigen::MatrixXd cofactor;
  double chi2 = 0.0;   ///< weighted sum of squares
  double plain = 0.0;  ///< sum of squares, local units
  int residuals = 0;
  bool converged = false;   ///< the steps came to an end
  bool determined = false;  ///< and the points hold every parameter

  int parameters() const { return static_cast<int>(cofactor.rows()); }
  int degreesOfFreedom() const { return residuals - parameters(); }
};

/// Gauss-Newton from where `model` and `own` stand, damped (Levenberg-Marquardt) where a step would not descend.
/// Weights follow the directions of the residuals from step to step. Steps end where they are of the size of
/// rounding; `model` is left at the solution. A model without own parameters takes none.
Estimate fitLeastSquares(Model& model, const LocalPoints& local, const Eigen::MatrixXd& own = {});

/// The factor from cofactor to covariance: see FitQuality.
double varianceFactor(const Estimate& estimate, bool weighted);

/// The covariance of numbers with these derivatives by the parameters.
Eigen::MatrixXd covarianceOf(const Eigen::MatrixXd& derivatives, const Estimate& estimate, bool weighted);

/// Fills in what the residuals say; false, with the reason, where the estimate is not determined.
bool describeQuality(const Estimate& estimate, const LocalPoints& local, FitQuality& quality);

/// Is there anything to tell the result's uncertainty by? Covariances, or a degree of freedom.
bool tellsUncertainty(const Estimate& estimate, const LocalPoints& local);

/// A standard uncertainty of a direction (rad) from which on it is no direction any more.
inline constexpr double kNoDirection = 0.5;

/// A radius is determined where the curvature 1/r differs from that of a straight line by two standard
/// uncertainties.
inline bool curved(double radius, double sd) { return radius > 2.0 * sd; }

}  // namespace stiffscope::metrology
