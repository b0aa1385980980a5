#include "core/identification/estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/identification/remarks.h"
#include "core/numerics/distributions.h"
#include "core/numerics/parallel.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::identification {

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

double studentFactor(double dof, double coverage) { return numerics::studentLimit(1.0 - coverage, dof); }

double coverageFactor(const StiffnessEstimate& estimate, int joint, double coverage) {
  const double dof = estimate.dof(joint);
  if (!(dof > 0.0) || !std::isfinite(estimate.covariance(joint, joint)))
    return std::numeric_limits<double>::quiet_NaN();
  return studentFactor(dof, coverage);
}

double matchedDof(const Eigen::MatrixXd& influence_covariance, const EqualWeights& more) {
  if (!(influence_covariance.trace() > 0.0)) return 0.0;
  const Eigen::VectorXd weights = symmetricEigenvalues(influence_covariance).cwiseMax(0.0);
  const double factor = coverageFactor(weights, more, kStatedCoverage);
  // By the same rule as the factor, so that its error drops out. The tail at a given factor falls as the degrees of
  // freedom grow.
  return crossing(0.3, 1e4, 1.0 - kStatedCoverage, [&](double dof) { return studentTail(factor, dof); });
}

namespace {

constexpr Eigen::Index kExact = 64;

/// The postures of the largest own influence, in their order.
std::vector<Eigen::Index> largest(const Eigen::VectorXd& own, Eigen::Index count) {
  std::vector<Eigen::Index> postures(static_cast<std::size_t>(own.size()));
  std::iota(postures.begin(), postures.end(), Eigen::Index{0});
  const auto end = postures.begin() + std::min(count, own.size());
  std::partial_sort(postures.begin(), end, postures.end(),
                    [&](Eigen::Index a, Eigen::Index b) { return own[a] > own[b] || (own[a] == own[b] && a < b); });
  postures.erase(end, postures.end());
  std::sort(postures.begin(), postures.end());
  return postures;
}

}  // namespace

double InfluenceCovariance::trace() const { return own.sum() + (middle * (through * through.transpose())).trace(); }

double InfluenceCovariance::squaredNorm() const {
  const Eigen::MatrixXd shared = middle * (through * through.transpose());
  const Eigen::MatrixXd crossed = middle * (through * own.asDiagonal() * through.transpose());
  return own.squaredNorm() + 2.0 * crossed.trace() + (shared * shared).trace();
}

Eigen::MatrixXd InfluenceCovariance::between(const std::vector<Eigen::Index>& postures) const {
  const Eigen::MatrixXd chosen = through(Eigen::all, postures);
  Eigen::MatrixXd covariance = chosen.transpose() * middle * chosen;
  covariance.diagonal() += own(postures);
  return covariance;
}

InfluenceCovariance combined(double a, const InfluenceCovariance& first, double b, const InfluenceCovariance& second) {
  const Eigen::Index rank = first.middle.rows(), more = second.middle.rows();
  InfluenceCovariance sum;
  sum.own = a * first.own + b * second.own;
  sum.through.resize(rank + more, first.own.size());
  sum.through << first.through, second.through;
  sum.middle = Eigen::MatrixXd::Zero(rank + more, rank + more);
  sum.middle.topLeftCorner(rank, rank) = a * first.middle;
  sum.middle.bottomRightCorner(more, more) = b * second.middle;
  return sum;
}

namespace {

/// `Joints` where a posture's every time is at fixed size; else Eigen::Dynamic.
template <int Joints>
void addInfluences(const GainOfEach& gains, const std::vector<NormalEquations>& normal, int joint,
                   InfluenceCovariance& covariance) {
  using Matrix = Eigen::Matrix<double, Joints, Joints>;
  using Vector = Eigen::Matrix<double, Joints, 1>;
  const Eigen::Index joints = covariance.through.rows();
  for (std::size_t p = 0; p < gains.size(); ++p) {
    const Vector row = gains[p].row(joint).transpose();
    const Vector through = Eigen::Map<const Matrix>(normal[p].matrix.data(), joints, joints).lazyProduct(row);
    covariance.through.col(static_cast<Eigen::Index>(p)) = through;
    covariance.own[static_cast<Eigen::Index>(p)] = row.dot(through);
  }
}

}  // namespace

InfluenceCovariance influenceCovariance(const GainOfEach& gains, const std::vector<NormalEquations>& normal,
                                        const JointMatrix& inverse, int joint) {
  const auto n = static_cast<Eigen::Index>(gains.size());
  InfluenceCovariance covariance{Eigen::VectorXd(n), Eigen::MatrixXd(inverse.rows(), n), -inverse};
  if (inverse.rows() == 6) {
    addInfluences<6>(gains, normal, joint, covariance);
  } else {
    addInfluences<Eigen::Dynamic>(gains, normal, joint, covariance);
  }
  return covariance;
}

double matchedDof(const InfluenceCovariance& covariance) {
  const Eigen::MatrixXd block = covariance.between(largest(covariance.own, kExact));
  if (covariance.own.size() <= kExact) return matchedDof(block);
  EqualWeights rest;
  const double trace = covariance.trace() - block.trace(), squares = covariance.squaredNorm() - block.squaredNorm();
  if (trace > 0.0 && squares > 0.0) rest = {squares / trace, trace * trace / squares};
  return matchedDof(block, rest);
}

namespace {

template <class Matrix>
Matrix rootOfRest(const Matrix& g) {
  // With many postures G is small: by the series sum (2k)! / (4^k k!^2) G^k, the rest of which is below 1e-16.
  constexpr double kSmall = 0.006;
  if (g.trace() < kSmall) {
    constexpr std::array<double, 6> kSeries{0.5, 3.0 / 8.0, 5.0 / 16.0, 35.0 / 128.0, 63.0 / 256.0, 231.0 / 1024.0};
    Matrix sum = kSeries.back() * g;
    for (std::size_t k = kSeries.size() - 1; k-- > 0;) {
      sum.diagonal().array() += kSeries[k];
      sum = (sum * g).eval();
    }
    return Matrix::Identity(g.rows(), g.cols()) + sum;
  }
  const SymmetricEigen own = symmetricEigen(g);
  constexpr double kMost = 0.95;  // a posture that alone determines a combination has no residual to correct
  const Eigen::VectorXd root = (1.0 - own.values.array().min(kMost)).rsqrt();
  return own.vectors * root.asDiagonal() * own.vectors.transpose();
}

template <class Matrix>
Matrix gainOf(const Matrix& whiten, const Matrix& own) {
  return whiten.transpose() * rootOfRest<Matrix>(whiten * own * whiten.transpose()) * whiten;
}

}  // namespace

Eigen::MatrixXd inverseRootOfRest(const Eigen::MatrixXd& g) { return rootOfRest(g); }

PostureGains::PostureGains(const NormalEquations& sum, const robot::JointMask& unknown) {
  const ScaledNormal scaled = scaledNormal(sum.matrix, unknown);
  const Eigen::LLT<JointMatrix> cholesky(scaled.matrix);
  whiten_ = cholesky.matrixL().solve(JointMatrix(scaled.scale.asDiagonal()));
}

PostureGain PostureGains::of(const JointMatrix& own) const {
  // A posture's every time: of most machines at fixed size.
  if (own.rows() == 6) return gainOf<Matrix6d>(whiten_, own);
  return gainOf<JointMatrix>(whiten_, own);
}

JointMatrix inverseNormal(const NormalEquations& sum, const robot::JointMask& unknown) {
  const ScaledNormal scaled = scaledNormal(sum.matrix, unknown);
  return scaled.scale.asDiagonal() * inverseOf(scaled.matrix) * scaled.scale.asDiagonal();
}

double satterthwaite(const Eigen::MatrixXd& covariance) {
  const double trace = covariance.trace();
  return trace > 0.0 ? trace * trace / covariance.squaredNorm() : 0.0;
}

bool sharePosture(const CaseEquations& a, const CaseEquations& b) { return a.posture >= 0 && a.posture == b.posture; }

std::vector<CaseEquations> byPosture(std::vector<CaseEquations> equations) {
  std::size_t postures = 0;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    CaseEquations& one = equations[i];
    if (i == 0 || !sharePosture(equations[postures - 1], one)) {
      if (postures != i) equations[postures] = std::move(one);
      ++postures;
      continue;
    }
    CaseEquations& last = equations[postures - 1];
    const Eigen::Index had = last.right.size(), more = one.right.size();
    last.matrix.conservativeResize(had + more, Eigen::NoChange);
    last.right.conservativeResize(had + more);
    last.matrix.bottomRows(more) = one.matrix;
    last.right.tail(more) = one.right;
  }
  equations.resize(postures);
  return equations;
}

std::vector<NormalEquations> normalByPosture(const std::vector<CaseEquations>& equations) {
  std::vector<NormalEquations> normal(equations.size());
  numerics::smallWorkOnAllCores(equations.size(), [&](std::size_t i) { normal[i] = normalEquations(equations[i]); });
  std::size_t postures = 0;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    if (i > 0 && sharePosture(equations[i - 1], equations[i])) {
      normal[postures - 1] += normal[i];
    } else {
      if (postures != i) normal[postures] = normal[i];
      ++postures;
    }
  }
  normal.resize(postures);
  return normal;
}

double StiffnessEstimate::stiffnessSd(int joint) const {
  return std::sqrt(covariance(joint, joint)) / (compliance[joint] * compliance[joint]);
}

double StiffnessEstimate::dof(int joint) const {
  const double scatter = parts.scatter(joint, joint);
  if (scatter <= 0.0) return scatter_dof[joint];
  const double ratio = covariance(joint, joint) / scatter;
  return scatter_dof[joint] * ratio * ratio;
}

Remark StiffnessEstimate::mark(int joint) const {
  if (compliance[joint] < 0.0) return Remark(RemarkId::negative);
  // What could hide has long tails: they make the standard deviation large, and the stated interval hardly wider.
  const double sd = stated.empty() ? stiffnessSd(joint) : expandedUncertainty(*this, joint) / 2.0;
  if (sd > std::abs(stiffness(joint))) return Remark(RemarkId::imprecise);
  return {};
}

JointMatrix scatterCovariance(const std::vector<JointVector>& influences, const robot::JointMask& unknown,
                              double per_posture) {
  const double unknowns = static_cast<double>(std::count(unknown.begin(), unknown.end(), true));
  const auto joints = static_cast<Eigen::Index>(unknown.size());
  if (static_cast<double>(influences.size()) < unknowns / per_posture + 2.0) {
    return JointMatrix::Constant(joints, joints, std::numeric_limits<double>::quiet_NaN());
  }
  JointMatrix sum = JointMatrix::Zero(joints, joints);
  for (const JointVector& one : influences) sum += one * one.transpose();
  return sum;
}

void setScatter(std::vector<JointVector> influences, const JointVector& dof, StiffnessEstimate& estimate,
                double per_posture) {
  estimate.parts = CovarianceParts(static_cast<Eigen::Index>(estimate.identifiable.size()));
  estimate.parts.scatter = scatterCovariance(influences, estimate.identifiable, per_posture);
  estimate.covariance = estimate.parts.scatter;
  estimate.scatter_dof = dof;
  estimate.influences = std::move(influences);
}

void setScatterOfOneStage(const std::vector<NormalEquations>& normal, const NormalEquations& sum,
                          StiffnessEstimate& estimate, double per_posture) {
  const PostureGains gain(sum, estimate.identifiable);
  GainOfEach gains(static_cast<Eigen::Index>(estimate.identifiable.size()), normal.size());
  std::vector<JointVector> influences(normal.size());
  numerics::smallWorkOnAllCores(normal.size(), [&](std::size_t p) {
    gains[p] = gain.of(normal[p].matrix);
    const JointVector left = normal[p].right - normal[p].matrix.lazyProduct(estimate.compliance);
    influences[p] = gains[p].lazyProduct(left);
  });
  const JointMatrix inverse = inverseNormal(sum, estimate.identifiable);
  JointVector dof = JointVector::Zero(inverse.rows());
  numerics::onAllCores(
      estimate.identifiable.size(),
      [&](std::size_t j) {
        if (!estimate.identifiable[j]) return;
        const auto joint = static_cast<int>(j);
        dof[joint] = matchedDof(influenceCovariance(gains, normal, inverse, joint));
      },
      normal.size() >= numerics::kWorthThreads);
  setScatter(std::move(influences), dof, estimate, per_posture);
}

void describeResiduals(const std::vector<CaseEquations>& equations, StiffnessEstimate& estimate) {
  const double sum = numerics::sumInBlocks<double>(equations.size(), [&](std::size_t i, double& squares) {
    squares += (equations[i].right - equations[i].matrix.lazyProduct(estimate.compliance)).squaredNorm();
  });
  Eigen::Index rows = 0;
  for (const CaseEquations& one : equations) rows += one.right.size();
  const auto unknowns = std::count(estimate.identifiable.begin(), estimate.identifiable.end(), true);
  estimate.rms_residual = rows > 0 ? std::sqrt(sum / static_cast<double>(rows)) : 0.0;
  estimate.sigma = rows > unknowns ? std::sqrt(sum / static_cast<double>(rows - unknowns)) : 0.0;
}

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

CoverageInterval complianceInterval(const StiffnessEstimate& estimate, int joint, double coverage) {
  if (!estimate.stated.empty() && coverage == kStatedCoverage) return estimate.stated[static_cast<std::size_t>(joint)];
  const double reach = coverageFactor(estimate, joint, coverage) * std::sqrt(estimate.covariance(joint, joint));
  if (!std::isfinite(reach)) return {-kInfinite, kInfinite};
  return {estimate.compliance[joint] - reach, estimate.compliance[joint] + reach};
}

CoverageInterval stiffnessInterval(const CoverageInterval& compliance) {
  if (!std::isfinite(compliance.low) || !std::isfinite(compliance.high)) return {-kInfinite, kInfinite};
  if (compliance.low > 0.0 || compliance.high < 0.0) return {1.0 / compliance.high, 1.0 / compliance.low};
  return {compliance.high > 0.0 ? 1.0 / compliance.high : -kInfinite, kInfinite};
}

CoverageInterval stiffnessInterval(const StiffnessEstimate& estimate, int joint, double coverage) {
  return stiffnessInterval(complianceInterval(estimate, joint, coverage));
}

double expandedUncertainty(const StiffnessEstimate& estimate, int joint) {
  if (estimate.stated.empty()) return coverageFactor(estimate, joint, kStatedCoverage) * estimate.stiffnessSd(joint);
  const CoverageInterval interval = stiffnessInterval(estimate, joint);
  const double k = estimate.stiffness(joint);
  return std::max(interval.high - k, k - interval.low);
}

double coveringSd(const StiffnessEstimate& estimate, int joint) {
  return std::sqrt(std::max(0.0, estimate.covariance(joint, joint))) *
         coverageFactor(estimate, joint, kStatedCoverage) / kNormalFactor;
}

JointMatrix coveringCovariance(const StiffnessEstimate& estimate) {
  JointVector scale = JointVector::Zero(estimate.joints());
  for (int j = 0; j < estimate.joints(); ++j) {
    const double sd = std::sqrt(std::max(0.0, estimate.covariance(j, j)));
    if (!estimate.identifiable[static_cast<std::size_t>(j)]) continue;
    const double covering = sd > 0.0 ? coveringSd(estimate, j) / sd : 1.0;
    scale[j] = std::isfinite(covering) ? covering : 1.0;  // known without degrees of freedom: normal as it stands
  }
  return scale.asDiagonal() * estimate.covariance * scale.asDiagonal();
}

JointMatrix correlation(const StiffnessEstimate& estimate) {
  JointVector scale = JointVector::Zero(estimate.joints());
  for (int j = 0; j < estimate.joints(); ++j) {
    const double variance = estimate.covariance(j, j);
    if (variance > 0.0) scale[j] = 1.0 / std::sqrt(variance);
  }
  return scale.asDiagonal() * estimate.covariance * scale.asDiagonal();
}

}  // namespace stiffscope::identification
