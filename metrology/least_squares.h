#pragma once

#include <Eigen/Core>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
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
  std::string flaw;  ///< why nothing can be fitted to the readings; empty where something can

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

// Weighted least squares of geometric residuals by Gauss-Newton, damped (Levenberg-Marquardt) where a step
// would not descend. A Model is a shape with
//   kShared   parameters that all groups of points share, moved by `move(step)` from where the model stands,
//   kOwn      parameters of each group alone (a radius, a height), to which steps are added,
//   kResiduals  residuals a point,
//   observe(i, point, own)  the residuals of the i-th point of a group, their rows of derivatives by (shared,
//   own),
//             and the directions in space whose variance they have.
// Residuals are the difference of nearly equal numbers and set the precision of the answer, hence models
// evaluate them in extended precision; everything else may be double, since it only steers the steps.

template <class Model>
struct Observation {
  static constexpr int kColumns = Model::kShared + Model::kOwn;
  Eigen::Matrix<double, Model::kResiduals, 1> residual;
  Eigen::Matrix<double, Model::kResiduals, kColumns> rows;
  Eigen::Matrix<double, 3, Model::kResiduals> directions;
};

/// Divides residuals and rows by their standard deviations (Cholesky factor of their covariance).
template <class Model>
void whiten(const Eigen::Matrix3d& covariance, double factor, Observation<Model>& seen) {
  if constexpr (Model::kResiduals == 1) {
    const double weight =
        1.0 / std::sqrt(factor * seen.directions.col(0).dot(covariance * seen.directions.col(0)));
    seen.residual *= weight;
    seen.rows *= weight;
  } else {
    const Eigen::Matrix<double, Model::kResiduals, Model::kResiduals> of_residuals =
        factor * seen.directions.transpose() * covariance * seen.directions;
    const Eigen::LLT<Eigen::Matrix<double, Model::kResiduals, Model::kResiduals>> cholesky(of_residuals);
    seen.residual = cholesky.matrixL().solve(seen.residual).eval();
    seen.rows = cholesky.matrixL().solve(seen.rows).eval();
  }
}

template <class Model>
Observation<Model> whitened(const Model& model, const Eigen::Matrix<double, Model::kOwn, 1>& own,
                            const LocalPoints& local, const LocalGroup& group, std::size_t i) {
  Observation<Model> seen = model.observe(i, group.points[i], own);
  if (group.covariances != nullptr)
    whiten<Model>((*group.covariances)[i], 1.0 / (local.scale * local.scale), seen);
  return seen;
}

/// A model with its groups' own parameters, what its points leave, and the inverse of its normal matrix. The
/// order of `cofactor` is shared, own of the first group, own of the second, ... All in local units.
template <class Model, int Groups>
struct Estimate {
  static constexpr int kSize =
      Groups == Eigen::Dynamic ? Eigen::Dynamic : Model::kShared + Groups * Model::kOwn;
  using Square = Eigen::Matrix<double, kSize, kSize>;
  using Column = Eigen::Matrix<double, kSize, 1>;
  using Own = Eigen::Matrix<double, Model::kOwn, Groups>;

  Model model;
  Own own = {};
  Square cofactor = {};
  double chi2 = 0.0;   ///< weighted sum of squares
  double plain = 0.0;  ///< sum of squares, local units
  int residuals = 0;
  bool converged = false;   ///< the steps came to an end
  bool determined = false;  ///< and the points hold every parameter

  int parameters() const { return static_cast<int>(cofactor.rows()); }
  int degreesOfFreedom() const { return residuals - parameters(); }
};

namespace least_squares {

/// Sums of one group over the shared and its own parameters: of fixed size, whatever the number of groups.
template <class Model>
struct Block {
  static constexpr int kColumns = Model::kShared + Model::kOwn;
  Eigen::Matrix<double, kColumns, kColumns> matrix = Eigen::Matrix<double, kColumns, kColumns>::Zero();
  Eigen::Matrix<double, kColumns, 1> right = Eigen::Matrix<double, kColumns, 1>::Zero();
  double chi2 = 0.0, plain = 0.0;
};

template <class Model>
Block<Model> sumOf(const Model& model, const Eigen::Matrix<double, Model::kOwn, 1>& own,
                   const LocalPoints& local, const LocalGroup& group) {
  Block<Model> sum;
  for (std::size_t i = 0; i < group.points.size(); ++i) {
    Observation<Model> seen = model.observe(i, group.points[i], own);
    sum.plain += seen.residual.squaredNorm();
    if (group.covariances != nullptr)
      whiten<Model>((*group.covariances)[i], 1.0 / (local.scale * local.scale), seen);
    sum.chi2 += seen.residual.squaredNorm();
    sum.matrix.noalias() += seen.rows.transpose() * seen.rows;
    sum.right.noalias() -= seen.rows.transpose() * seen.residual;
  }
  return sum;
}

template <class Model, int Groups>
struct Normal {
  typename Estimate<Model, Groups>::Square matrix;
  typename Estimate<Model, Groups>::Column right;
  double chi2 = 0.0, plain = 0.0;
};

template <class Model, int Groups>
Normal<Model, Groups> normalEquations(const Estimate<Model, Groups>& at, const LocalPoints& local) {
  constexpr int kShared = Model::kShared, kOwn = Model::kOwn;
  const auto size = static_cast<Eigen::Index>(kShared + kOwn * static_cast<int>(local.groups.size()));
  Normal<Model, Groups> normal;
  normal.matrix.setZero(size, size);
  normal.right.setZero(size);
  for (std::size_t k = 0; k < local.groups.size(); ++k) {
    const auto block =
        sumOf<Model>(at.model, at.own.col(static_cast<Eigen::Index>(k)), local, local.groups[k]);
    normal.chi2 += block.chi2;
    normal.plain += block.plain;
    normal.matrix.template topLeftCorner<kShared, kShared>() +=
        block.matrix.template topLeftCorner<kShared, kShared>();
    normal.right.template head<kShared>() += block.right.template head<kShared>();
    if constexpr (kOwn > 0) {
      const Eigen::Index place = kShared + kOwn * static_cast<Eigen::Index>(k);
      normal.matrix.template block<kShared, kOwn>(0, place) =
          block.matrix.template topRightCorner<kShared, kOwn>();
      normal.matrix.template block<kOwn, kShared>(place, 0) =
          block.matrix.template bottomLeftCorner<kOwn, kShared>();
      normal.matrix.template block<kOwn, kOwn>(place, place) =
          block.matrix.template bottomRightCorner<kOwn, kOwn>();
      normal.right.template segment<kOwn>(place) = block.right.template tail<kOwn>();
    }
  }
  return normal;
}

/// The normal matrix with a unit diagonal, factorised: parameters of different kind become comparable.
template <class Square>
struct Factorised {
  using Column = Eigen::Matrix<double, Square::RowsAtCompileTime, 1>;
  Column scale;
  Eigen::LDLT<Square> ldlt;

  Factorised(const Square& matrix, double damping) : scale(matrix.diagonal().cwiseMax(0.0).cwiseSqrt()) {
    for (Eigen::Index i = 0; i < scale.size(); ++i) scale[i] = scale[i] > 0.0 ? 1.0 / scale[i] : 0.0;
    Square even = scale.asDiagonal() * matrix * scale.asDiagonal();
    even.diagonal().setConstant(1.0 + damping);
    ldlt.compute(even);
  }
  template <class Right>
  Right solve(const Right& right) const {
    return scale.asDiagonal() * ldlt.solve(scale.asDiagonal() * right);
  }
  /// Does every parameter have an effect that the others cannot replace, beyond rounding?
  bool regular() const {
    constexpr double kSmallestPivot = 1e-13;
    return scale.minCoeff() > 0.0 && ldlt.vectorD().minCoeff() > kSmallestPivot;
  }
};

}  // namespace least_squares

/// Refines `estimate` (its model and own parameters are the start). Weights follow the directions of the
/// residuals from step to step. Steps end where they are of the size of rounding.
template <class Model, int Groups>
void refine(Estimate<Model, Groups>& estimate, const LocalPoints& local) {
  using namespace least_squares;
  constexpr int kMostSteps = 200, kMostRefusals = 30;
  constexpr double kRounding = std::numeric_limits<double>::epsilon();
  constexpr double kSmall = 1e-8;  // a step from which only rounding can keep the sum from falling
  Normal<Model, Groups> normal = normalEquations(estimate, local);
  double damping = 0.0, previous = std::numeric_limits<double>::infinity();
  estimate.converged = false;
  for (int steps = 0, refusals = 0; steps < kMostSteps && refusals < kMostRefusals;) {
    const auto step =
        Factorised<typename Estimate<Model, Groups>::Square>(normal.matrix, damping).solve(normal.right);
    Estimate<Model, Groups> next = estimate;
    next.model.move(step.template head<Model::kShared>());
    if constexpr (Model::kOwn > 0) next.own.reshaped() += step.tail(next.own.size());
    const Normal<Model, Groups> there = normalEquations(next, local);
    double size = 1.0;
    if constexpr (Model::kOwn > 0) size = std::max(size, next.own.cwiseAbs().maxCoeff());
    const double length = step.cwiseAbs().maxCoeff() / size;
    // A per cent more is let pass: weights change with the directions of the residuals.
    if (!(length < kSmall || there.chi2 <= 1.01 * normal.chi2)) {
      damping = std::max(10.0 * damping, 1e-3);
      ++refusals;
      continue;
    }
    damping = damping > 1e-6 ? 0.1 * damping : 0.0;
    estimate.model = next.model;
    estimate.own = next.own;
    normal = there;
    ++steps;
    estimate.converged = length < 1e-9 && damping == 0.0;
    if (length <= kRounding || (estimate.converged && length >= previous)) break;
    previous = length;
  }
  estimate.chi2 = normal.chi2;
  estimate.plain = normal.plain;
  estimate.residuals = Model::kResiduals * static_cast<int>(local.count());
  const Factorised<typename Estimate<Model, Groups>::Square> factors(normal.matrix, 0.0);
  const Eigen::Index size = normal.right.size();
  estimate.cofactor = factors.solve(Estimate<Model, Groups>::Square::Identity(size, size).eval());
  estimate.determined = estimate.converged && factors.regular() && estimate.cofactor.allFinite();
}

/// The factor from cofactor to covariance: see FitQuality.
template <class Model, int Groups>
double varianceFactor(const Estimate<Model, Groups>& estimate, bool weighted) {
  if (estimate.degreesOfFreedom() < 1) return weighted ? 1.0 : 0.0;
  const double variance = estimate.chi2 / estimate.degreesOfFreedom();
  return weighted ? std::max(1.0, variance) : variance;
}

/// Fills in what the residuals say; false, with the reason, where the estimate is not determined.
template <class Model, int Groups>
bool describeQuality(const Estimate<Model, Groups>& estimate, const LocalPoints& local, FitQuality& quality) {
  quality.degrees_of_freedom = estimate.degreesOfFreedom();
  if (!estimate.determined) {
    quality.reason = estimate.converged
                         ? "the readings leave a parameter of the shape free"
                         : "no shape of this kind is nearest to the readings: the fit does not settle";
    return false;
  }
  const int dof = quality.degrees_of_freedom;
  quality.rms = local.scale * std::sqrt(estimate.plain / static_cast<double>(local.count()));
  quality.residual_sd = dof > 0 ? local.scale * std::sqrt(estimate.plain / dof) : 0.0;
  quality.chi2_per_dof = !local.weighted() ? 1.0 : dof > 0 ? estimate.chi2 / dof : 0.0;
  return true;
}

/// Is there anything to tell the result's uncertainty by? Covariances, or a degree of freedom.
template <class Model, int Groups>
bool tellsUncertainty(const Estimate<Model, Groups>& estimate, const LocalPoints& local) {
  return local.weighted() || estimate.degreesOfFreedom() > 0;
}

/// A standard uncertainty of a direction (rad) from which on it is no direction any more.
inline constexpr double kNoDirection = 0.5;

/// A radius is determined where the curvature 1/r differs from that of a straight line by two standard
/// uncertainties.
inline bool curved(double radius, double sd) { return radius > 2.0 * sd; }

}  // namespace stiffscope::metrology
