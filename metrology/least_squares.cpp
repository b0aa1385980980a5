#include "metrology/least_squares.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "metrology/remarks.h"

namespace stiffscope::metrology {

namespace {

Eigen::Vector3d meanOf(const MeasuredPoints* groups, std::size_t count, std::size_t points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    for (const Eigen::Vector3d& point : groups[k].points) mean += point;
  }
  return mean / static_cast<double>(points);
}

Remark flawOfCovariances(const MeasuredPoints& group, bool expected) {
  if (!expected && group.covariances.empty()) return {};
  if (group.covariances.size() != group.points.size()) return Remark(RemarkId::covariances_not_one_a_reading);
  for (const Eigen::Matrix3d& covariance : group.covariances) {
    const Eigen::LLT<Eigen::Matrix3d> cholesky(covariance);
    if (!covariance.allFinite() || cholesky.info() != Eigen::Success) {
      return Remark(RemarkId::covariance_not_positive_definite);
    }
  }
  return {};
}

}  // namespace

std::size_t LocalPoints::count() const {
  std::size_t sum = 0;
  for (const LocalGroup& group : groups) sum += group.points.size();
  return sum;
}

LocalPoints localPoints(const MeasuredPoints* groups, std::size_t count) {
  LocalPoints local;
  std::size_t points = 0;
  for (std::size_t k = 0; k < count; ++k) points += groups[k].points.size();
  if (points == 0) {
    local.flaw = Remark(RemarkId::no_readings);
    return local;
  }
  const bool weighted = !groups[0].covariances.empty();
  for (std::size_t k = 0; k < count && local.flaw.empty(); ++k) {
    local.flaw = flawOfCovariances(groups[k], weighted);
  }
  if (!local.flaw.empty()) return local;

  local.origin = meanOf(groups, count, points);
  double size = 0.0, farthest = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    for (const Eigen::Vector3d& point : groups[k].points) {
      // Written so that a coordinate that is not a number stays one.
      const double from_mean = (point - local.origin).cwiseAbs().sum();
      if (!(from_mean <= std::numeric_limits<double>::max())) {
        local.flaw = Remark(RemarkId::reading_not_finite);
        return local;
      }
      size = std::max(size, (point - local.origin).cwiseAbs().maxCoeff());
      farthest = std::max(farthest, point.cwiseAbs().maxCoeff());
    }
  }
  constexpr double kRounding = std::numeric_limits<double>::epsilon();
  constexpr double kDigits = 1e4;     // of the spread that double precision must hold
  constexpr double kLargest = 1e140;  // covariances and their sums are squares
  if (!(size > 4.0 * kRounding * farthest)) {
    local.flaw = Remark(RemarkId::readings_in_one_place);
  } else if (farthest > kLargest || size < 1.0 / kLargest) {
    local.flaw = Remark(RemarkId::squares_beyond_double);
  } else if (size < kDigits * kRounding * farthest) {
    local.flaw = Remark(RemarkId::readings_too_far_out);
  }
  if (!local.flaw.empty()) return local;

  local.scale = std::exp2(std::floor(std::log2(size)));
  local.rounding = kRounding * farthest / local.scale;
  local.groups.resize(count);
  const double inverse = 1.0 / local.scale;
  for (std::size_t k = 0; k < count; ++k) {
    local.groups[k].points.reserve(groups[k].points.size());
    for (const Eigen::Vector3d& point : groups[k].points) {
      local.groups[k].points.push_back(inverse * (point - local.origin));
    }
    if (weighted) local.groups[k].covariances = &groups[k].covariances;
  }
  return local;
}

PrincipalAxes principalAxes(const LocalPoints& local) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const LocalGroup& group : local.groups) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& point : group.points) mean += point;
    mean /= std::max<double>(1.0, static_cast<double>(group.points.size()));
    for (const Eigen::Vector3d& point : group.points) {
      const Eigen::Vector3d from_mean = point - mean;
      scatter.noalias() += from_mean * from_mean.transpose();
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

bool spreads(double small, double large, const LocalPoints& local) {
  constexpr double kFlat = 1e-12;  // squared
  const double rounding = 8.0 * local.rounding;
  return small > kFlat * large && small > rounding * rounding * static_cast<double>(local.count());
}

bool standsOut(double greater, double lesser, std::size_t count) {
  constexpr double kOfOneScatter = 4.9;
  const double both = std::sqrt(std::max(0.0, lesser) * greater / static_cast<double>(count));
  return greater - lesser > std::max(kOfOneScatter * both, 1e-9 * greater);
}

namespace {

void whiten(const Eigen::Matrix3d& covariance, double factor, const Model::Size& size, Observation& seen) {
  if (size.residuals == 1) {
    const double weight = 1.0 / std::sqrt(factor * seen.directions[0].dot(covariance * seen.directions[0]));
    seen.residual[0] *= weight;
    for (int c = 0; c < size.columns(); ++c) seen.rows[0][c] *= weight;
    return;
  }
  double of_residuals[Observation::kMaxResiduals][Observation::kMaxResiduals];
  for (int r = 0; r < size.residuals; ++r) {
    const Eigen::Vector3d along = factor * (covariance * seen.directions[r]);
    for (int q = 0; q < size.residuals; ++q) of_residuals[r][q] = seen.directions[q].dot(along);
  }
  // Cholesky's factor, row by row, is divided off as it comes.
  double lower[Observation::kMaxResiduals][Observation::kMaxResiduals];
  for (int r = 0; r < size.residuals; ++r) {
    for (int q = 0; q <= r; ++q) {
      double left = of_residuals[r][q];
      for (int k = 0; k < q; ++k) left -= lower[r][k] * lower[q][k];
      lower[r][q] = q == r ? std::sqrt(left) : left / lower[q][q];
    }
    for (int q = 0; q < r; ++q) {
      seen.residual[r] -= lower[r][q] * seen.residual[q];
      for (int c = 0; c < size.columns(); ++c) seen.rows[r][c] -= lower[r][q] * seen.rows[q][c];
    }
    seen.residual[r] /= lower[r][r];
    for (int c = 0; c < size.columns(); ++c) seen.rows[r][c] /= lower[r][r];
  }
}

struct NormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  double chi2 = 0.0, plain = 0.0;
};

/// Adds the sums of one group. They are gathered over the shared and its own parameters alone: of fixed size, whatever
/// the number of groups.
void addGroup(const Model& model, const double* own, const LocalPoints& local, std::size_t k, NormalEquations& normal) {
  constexpr int kMax = Observation::kMaxColumns;
  const Model::Size size = model.size();
  const int columns = size.columns();
  const LocalGroup& group = local.groups[k];
  const double factor = 1.0 / (local.scale * local.scale);
  double upper[kMax][kMax] = {};
  long double right[kMax] = {};  // where this vanishes is the answer
  Observation seen;
  for (std::size_t i = 0; i < group.points.size(); ++i) {
    model.observe(i, group.points[i], own, seen);
    normal.plain += seen.squaredNorm(size.residuals);
    if (group.covariances != nullptr) whiten((*group.covariances)[i], factor, size, seen);
    normal.chi2 += seen.squaredNorm(size.residuals);
    for (int r = 0; r < size.residuals; ++r) {
      const auto& row = seen.rows[r];
      for (int a = 0; a < columns; ++a) {
        right[a] -= static_cast<long double>(row[a]) * seen.residual[r];
        for (int b = a; b < columns; ++b) upper[a][b] += row[a] * row[b];
      }
    }
  }
  const auto place = [&](int c) {
    return static_cast<Eigen::Index>(c < size.shared ? c : c + size.own * static_cast<int>(k));
  };
  for (int a = 0; a < columns; ++a) {
    normal.right[place(a)] += static_cast<double>(right[a]);
    for (int b = a; b < columns; ++b) {
      normal.matrix(place(a), place(b)) += upper[a][b];
      if (a != b) normal.matrix(place(b), place(a)) += upper[a][b];
    }
  }
}

NormalEquations normalEquations(const Model& model, const Eigen::MatrixXd& own, const LocalPoints& local) {
  const Model::Size size = model.size();
  const auto unknowns = static_cast<Eigen::Index>(size.shared + size.own * static_cast<int>(local.groups.size()));
  NormalEquations normal{Eigen::MatrixXd::Zero(unknowns, unknowns), Eigen::VectorXd::Zero(unknowns)};
  for (std::size_t k = 0; k < local.groups.size(); ++k) {
    addGroup(model, own.data() + static_cast<std::size_t>(size.own) * k, local, k, normal);
  }
  return normal;
}

/// The normal matrix with a unit diagonal, factorised: parameters of different kind become comparable.
class Factorised {
 public:
  Factorised(const Eigen::MatrixXd& matrix, double damping) : scale_(matrix.rows()) {
    const Eigen::Index size = scale_.size();
    for (Eigen::Index i = 0; i < size; ++i) scale_[i] = matrix(i, i) > 0.0 ? 1.0 / std::sqrt(matrix(i, i)) : 0.0;
    Eigen::MatrixXd even(size, size);
    for (Eigen::Index j = 0; j < size; ++j) {
      for (Eigen::Index i = 0; i < size; ++i)
        even(i, j) = i == j ? 1.0 + damping : scale_[i] * matrix(i, j) * scale_[j];
    }
    ldlt_.compute(even);
  }
  Eigen::MatrixXd solve(Eigen::MatrixXd right) const {
    right.array().colwise() *= scale_.array();
    ldlt_.solveInPlace(right);
    right.array().colwise() *= scale_.array();
    return right;
  }
  /// Does every parameter have an effect that the others cannot replace, beyond rounding?
  bool regular() const {
    constexpr double kSmallestPivot = 1e-13;
    return scale_.minCoeff() > 0.0 && ldlt_.vectorD().minCoeff() > kSmallestPivot;
  }

 private:
  Eigen::VectorXd scale_;
  Eigen::LDLT<Eigen::MatrixXd> ldlt_;
};

}  // namespace

Observation whitened(const Model& model, const double* own, const LocalPoints& local, const LocalGroup& group,
                     std::size_t i) {
  Observation seen;
  model.observe(i, group.points[i], own, seen);
  if (group.covariances != nullptr) {
    whiten((*group.covariances)[i], 1.0 / (local.scale * local.scale), model.size(), seen);
  }
  return seen;
}

Estimate fitLeastSquares(Model& model, const LocalPoints& local, const Eigen::MatrixXd& own) {
  constexpr int kMostSteps = 200, kMostRefusals = 30;
  constexpr double kRounding = std::numeric_limits<double>::epsilon();
  constexpr double kSmall = 1e-8;  // a step from which only rounding can keep the sum from falling
  const Model::Size size = model.size();
  Estimate estimate;
  estimate.own = own;
  estimate.own.resize(size.own, static_cast<Eigen::Index>(local.groups.size()));
  NormalEquations normal = normalEquations(model, estimate.own, local);
  double damping = 0.0, previous = std::numeric_limits<double>::infinity();
  for (int steps = 0, refusals = 0; steps < kMostSteps && refusals < kMostRefusals;) {
    const Eigen::VectorXd step = Factorised(normal.matrix, damping).solve(normal.right);
    Eigen::MatrixXd moved = estimate.own;
    for (Eigen::Index i = 0; i < moved.size(); ++i) moved.data()[i] += step[size.shared + i];
    model.move(step.head(size.shared));
    NormalEquations there = normalEquations(model, moved, local);
    double largest = 1.0;
    for (Eigen::Index i = 0; i < moved.size(); ++i) largest = std::max(largest, std::abs(moved.data()[i]));
    const double length = step.cwiseAbs().maxCoeff() / largest;
    // A per cent more is let pass: weights change with the directions of the residuals.
    if (!(length < kSmall || there.chi2 <= 1.01 * normal.chi2)) {
      model.undo();
      damping = std::max(10.0 * damping, 1e-3);
      ++refusals;
      continue;
    }
    damping = damping > 1e-6 ? 0.1 * damping : 0.0;
    estimate.own = std::move(moved);
    normal = std::move(there);
    ++steps;
    estimate.converged = length < 1e-9 && damping == 0.0;
    if (length <= kRounding || (estimate.converged && length >= previous)) break;
    previous = length;
  }
  estimate.chi2 = normal.chi2;
  estimate.plain = normal.plain;
  estimate.residuals = size.residuals * static_cast<int>(local.count());
  const Factorised factors(normal.matrix, 0.0);
  estimate.cofactor = factors.solve(Eigen::MatrixXd::Identity(normal.right.size(), normal.right.size()));
  estimate.determined = estimate.converged && factors.regular() && estimate.cofactor.allFinite();
  return estimate;
}

double varianceFactor(const Estimate& estimate, bool weighted) {
  if (estimate.degreesOfFreedom() < 1) return weighted ? 1.0 : 0.0;
  const double variance = estimate.chi2 / estimate.degreesOfFreedom();
  return weighted ? std::max(1.0, variance) : variance;
}

Eigen::MatrixXd covarianceOf(const Eigen::MatrixXd& derivatives, const Estimate& estimate, bool weighted) {
  const Eigen::MatrixXd left = varianceFactor(estimate, weighted) * derivatives * estimate.cofactor;
  return left * derivatives.transpose();
}

bool describeQuality(const Estimate& estimate, const LocalPoints& local, FitQuality& quality) {
  quality.degrees_of_freedom = estimate.degreesOfFreedom();
  if (!estimate.determined) {
    quality.reason = estimate.converged ? Remark(RemarkId::parameter_free) : Remark(RemarkId::does_not_settle);
    return false;
  }
  const int dof = quality.degrees_of_freedom;
  quality.rms = local.scale * std::sqrt(estimate.plain / static_cast<double>(local.count()));
  quality.residual_sd = dof > 0 ? local.scale * std::sqrt(estimate.plain / dof) : 0.0;
  quality.chi2_per_dof = !local.weighted() ? 1.0 : dof > 0 ? estimate.chi2 / dof : 0.0;
  return true;
}

bool tellsUncertainty(const Estimate& estimate, const LocalPoints& local) {
  return local.weighted() || estimate.degreesOfFreedom() > 0;
}

}  // namespace stiffscope::metrology
