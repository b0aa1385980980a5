#include "core/identification/coverage_factor.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/identification/stiffness_interval.h"
#include "metrology/tail_probability.h"

namespace stiffscope {

namespace {

constexpr int kNodes = 32;  // of the midpoint rule, exact to 1e-5 of a probability for three degrees and more

/// 1 / sin^2 at the midpoints.
const Eigen::Array<double, kNodes, 1>& inverseSquares() {
  static const Eigen::Array<double, kNodes, 1> values = [] {
    Eigen::Array<double, kNodes, 1> at;
    for (int i = 0; i < kNodes; ++i) at[i] = std::pow(std::sin(0.5 * std::numbers::pi * (i + 0.5) / kNodes), -2);
    return at;
  }();
  return values;
}

/// Where a function that falls with its positive argument crosses `level`; by bisection of the logarithm.
template <class Falling>
double crossing(double low, double high, double level, const Falling& falling) {
  constexpr int kHalvings = 34;
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = std::sqrt(low * high);
    (falling(middle) > level ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

constexpr double kLeast = 0.1, kMost = 1e3;  // factors

/// The same integral for Student's t: dof weights of 1 / dof.
double studentTail(double factor, double dof) {
  return (1.0 + factor * factor / dof * inverseSquares()).pow(-0.5 * dof).mean();
}

}  // namespace

double coverageFactor(const Eigen::VectorXd& weights, double coverage) { return coverageFactor(weights, {}, coverage); }

double coverageFactor(const Eigen::VectorXd& weights, const EqualWeights& more, double coverage) {
  const double sum = weights.sum() + more.count * more.weight;
  const Eigen::VectorXd shares = weights / sum;
  return crossing(kLeast, kMost, 1.0 - coverage, [&](double factor) {
    Eigen::Array<double, kNodes, 1> product = Eigen::Array<double, kNodes, 1>::Ones();
    for (const double share : shares) product *= 1.0 + factor * factor * share * inverseSquares();
    if (more.count > 0.0) product *= (1.0 + factor * factor * more.weight / sum * inverseSquares()).pow(more.count);
    return product.rsqrt().mean();
  });
}

double studentFactor(double dof, double coverage) {
  return crossing(kLeast, kMost, 1.0 - coverage, [&](double factor) { return fTail(factor * factor, 1, dof); });
}

double coverageFactor(const StiffnessEstimate& estimate, int joint, double coverage) {
  const double dof = estimate.dof(joint);
  if (!(dof > 0.0) || !std::isfinite(estimate.covariance(joint, joint))) return std::numeric_limits<double>::quiet_NaN();
  return studentFactor(dof, coverage);
}

double matchedDof(const Eigen::MatrixXd& influence_covariance, const EqualWeights& more) {
  if (!(influence_covariance.trace() > 0.0)) return 0.0;
  const Eigen::VectorXd weights =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(influence_covariance, Eigen::EigenvaluesOnly).eigenvalues().cwiseMax(0.0);
  const double factor = coverageFactor(weights, more, kStatedCoverage);
  // By the same rule as the factor, so that its error drops out. The tail at a given factor falls as the degrees of freedom grow.
  return crossing(0.3, 1e4, 1.0 - kStatedCoverage, [&](double dof) { return studentTail(factor, dof); });
}

}  // namespace stiffscope
