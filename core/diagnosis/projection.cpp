#include "core/diagnosis/projection.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace stiffscope::diagnosis {

namespace {

constexpr double kRounding = 1e-12;  // on the unit diagonal

/// Unit diagonal; a column that is nothing keeps its unknown at zero.
Eigen::VectorXd scaleOf(const Eigen::VectorXd& diagonal) {
  return diagonal.unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; });
}

Eigen::LDLT<Eigen::MatrixXd> factorised(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& scale) {
  Eigen::MatrixXd even = scale.asDiagonal() * matrix * scale.asDiagonal();
  for (Eigen::Index i = 0; i < even.rows(); ++i) even(i, i) = 1.0 + kRounding;
  return even.ldlt();
}

}  // namespace

Eigen::MatrixXd sumOf(const LinearSystem& data, const std::vector<double>& weights) {
  return std::move(sumsOf(data, {&weights, 1}).front());
}

std::vector<Eigen::MatrixXd> sumsOf(const LinearSystem& data, std::span<const std::vector<double>> weights) {
  // So few columns of all sums stay in the cache while the postures, tens of megabytes, pass.
  constexpr Eigen::Index kColumns = 8;
  // A posture that has the same weight in all sums is added once: where one is left out after another, nearly all are.
  std::vector<char> common(data.postures.size(), 0);
  for (std::size_t p = 0; p < common.size(); ++p) {
    common[p] = std::all_of(weights.begin(), weights.end(),
                            [&](const std::vector<double>& one) { return one[p] == weights.front()[p]; });
  }
  std::vector<Eigen::MatrixXd> sums(weights.size(), Eigen::MatrixXd(data.sweeps.rows(), data.sweeps.cols()));
  sums.front() = data.sweeps;
  for (Eigen::Index first = 0; first < data.sweeps.cols(); first += kColumns) {
    const Eigen::Index count = std::min(kColumns, data.sweeps.cols() - first);
    const auto add = [&](std::size_t p, std::size_t k) {
      if (weights[k][p] != 0.0) data.postures[p].normal.addTo(weights[k][p], sums[k], first, count);
    };
    for (std::size_t p = 0; p < common.size(); ++p) {
      if (common[p]) add(p, 0);
    }
    for (std::size_t k = 1; k < sums.size(); ++k)
      sums[k].middleCols(first, count) = sums.front().middleCols(first, count);
    for (std::size_t p = 0; p < common.size(); ++p) {
      for (std::size_t k = 0; k < sums.size() && !common[p]; ++k) add(p, k);
    }
  }
  for (Eigen::MatrixXd& sum : sums) sum.triangularView<Eigen::StrictlyUpper>() = sum.transpose();
  return sums;
}

Eigen::VectorXd allParameters(const Eigen::VectorXd& nuisances, const Eigen::VectorXd& effects) {
  Eigen::VectorXd all(nuisances.size() + effects.size());
  all << nuisances, effects;
  return all;
}

Projection project(const Eigen::MatrixXd& normal, const GapLayout& layout) {
  const Eigen::Index effects_at = layout.effects, joints = layout.joints();
  const Eigen::Index end = normal.rows() - 1, effects = end - effects_at;
  const Eigen::MatrixXd nuisance = normal.topLeftCorner(effects_at, effects_at);
  const Eigen::VectorXd scale = scaleOf(nuisance.diagonal());
  const auto factor = factorised(nuisance, scale);
  Eigen::MatrixXd across(effects_at, effects + 1);
  across << normal.block(0, effects_at, effects_at, effects), normal.col(end).head(effects_at);
  const Eigen::MatrixXd solved = scale.asDiagonal() * factor.solve(scale.asDiagonal() * across);
  Projection result;
  result.by_effects = solved.leftCols(effects);
  result.by_nothing = solved.col(effects);
  const Eigen::MatrixXd transposed = across.leftCols(effects).transpose();
  result.matrix = normal.block(effects_at, effects_at, effects, effects);
  // Of no effect the product is empty, whose first element Eigen would look for.
  if (effects > 0) result.matrix.triangularView<Eigen::Lower>() -= transposed * result.by_effects;
  result.matrix.triangularView<Eigen::StrictlyUpper>() = result.matrix.transpose();
  result.right = normal.col(end).segment(effects_at, effects) - transposed * result.by_nothing;
  result.before = normal.diagonal().segment(effects_at, effects);
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(effects_at, joints));
  result.compliance_variance.resize(joints);
  for (Eigen::Index j = 0; j < joints; ++j) result.compliance_variance[j] = scale[j] * scale[j] * inverse(j, j);
  result.chi2_none = normal(end, end) - across.col(effects).dot(result.by_nothing);
  return result;
}

StiffnessesAlone stiffnessesAlone(const LinearSystem& data, const std::vector<double>& weights,
                                  const Projection& projection) {
  const Eigen::Index joints = data.layout.joints();
  StiffnessNormal sum = StiffnessNormal::Zero(joints + 1, joints + 1);
  for (std::size_t p = 0; p < data.postures.size(); ++p) sum += weights[p] * data.postures[p].stiffness_normal;
  const Eigen::VectorXd scale = scaleOf(sum.diagonal().head(joints));
  StiffnessesAlone alone;
  alone.for_deflection = Eigen::VectorXd::Zero(data.layout.end);
  alone.for_deflection.head(joints) =
      scale.asDiagonal() * factorised(sum.topLeftCorner(joints, joints), scale)
                               .solve(Eigen::VectorXd(scale.asDiagonal() * sum.col(joints).head(joints)));
  alone.for_position = Eigen::VectorXd::Zero(data.layout.end);
  alone.for_position.head(projection.by_nothing.size()) = projection.by_nothing;
  return alone;
}

double complianceSd(const Projection& projection, const std::vector<Eigen::Index>& indices,
                    const Eigen::VectorXd& prior, Eigen::Index joint) {
  const auto size = static_cast<Eigen::Index>(indices.size());
  double variance = projection.compliance_variance[joint];
  if (size > 0) {
    Eigen::MatrixXd matrix = projection.matrix(indices, indices);
    Eigen::VectorXd across(size);
    for (Eigen::Index a = 0; a < size; ++a) {
      matrix(a, a) += prior[indices[static_cast<std::size_t>(a)]];
      across[a] = projection.by_effects(joint, indices[static_cast<std::size_t>(a)]);
    }
    const Eigen::VectorXd scale = scaleOf(matrix.diagonal());
    variance +=
        across.dot(scale.asDiagonal() * factorised(matrix, scale).solve(Eigen::VectorXd(scale.asDiagonal() * across)));
  }
  return std::sqrt(std::max(0.0, variance));
}

SubsetFit fitSubset(const Projection& projection, const std::vector<Eigen::Index>& indices,
                    const std::vector<bool>& positive, const Eigen::VectorXd& prior) {
  SubsetFit fit;
  fit.value = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(indices.size()));
  std::vector<std::size_t> active(indices.size());
  for (std::size_t i = 0; i < active.size(); ++i) active[i] = i;
  while (!active.empty()) {
    const auto size = static_cast<Eigen::Index>(active.size());
    Eigen::MatrixXd matrix(size, size);
    Eigen::VectorXd right(size);
    for (Eigen::Index a = 0; a < size; ++a) {
      const Eigen::Index ia = indices[active[static_cast<std::size_t>(a)]];
      right[a] = projection.right[ia];
      for (Eigen::Index b = 0; b < size; ++b)
        matrix(a, b) = projection.matrix(ia, indices[active[static_cast<std::size_t>(b)]]);
      matrix(a, a) = std::max(matrix(a, a), 0.0) + prior[ia];
    }
    const Eigen::VectorXd scale = scaleOf(matrix.diagonal());
    const Eigen::VectorXd value =
        scale.asDiagonal() * factorised(matrix, scale).solve(Eigen::VectorXd(scale.asDiagonal() * right));
    // A compliance that comes out negative is nothing: the most negative one first, in its own scale.
    Eigen::Index worst = -1;
    double least = 0.0;
    for (Eigen::Index a = 0; a < size; ++a) {
      const double own = scale[a] > 0.0 ? value[a] / scale[a] : 0.0;
      if (positive[active[static_cast<std::size_t>(a)]] && own < least) least = own, worst = a;
    }
    if (worst < 0) {
      for (Eigen::Index a = 0; a < size; ++a)
        fit.value[static_cast<Eigen::Index>(active[static_cast<std::size_t>(a)])] = value[a];
      fit.drop = right.dot(value);
      break;
    }
    active.erase(active.begin() + worst);
  }
  return fit;
}

GrowingSubset::GrowingSubset(const Projection& projection, const Eigen::VectorXd& prior)
    : projection_(projection), prior_(prior) {}

void GrowingSubset::add(Eigen::Index index, bool positive) {
  constexpr double kLeastPivot = 0.1 * kRounding;
  const double own = std::max(projection_.matrix(index, index), 0.0) + prior_[index];
  Unknown one{index, positive, own > 0.0 ? 1.0 / std::sqrt(own) : 0.0};
  double pivot = 1.0 + kRounding, turned = one.scale * projection_.right[index];
  const std::size_t row = lower_.size();
  std::size_t at = 0;  // begin of the row of each parameter before it
  for (std::size_t j = 0; j < unknowns_.size(); ++j, at += j) {
    double left = one.scale * unknowns_[j].scale * projection_.matrix(unknowns_[j].index, index);
    for (std::size_t k = 0; k < j; ++k) left -= lower_[row + k] * lower_[at + k];
    left /= lower_[at + j];
    lower_.push_back(left);
    pivot -= left * left;
    turned -= left * unknowns_[j].turned;
  }
  one.sound = pivot > kLeastPivot && (unknowns_.empty() || unknowns_.back().sound);
  const double root = one.sound ? std::sqrt(pivot) : 1.0;
  lower_.push_back(root);
  one.turned = turned / root;
  one.drop = (unknowns_.empty() ? 0.0 : unknowns_.back().drop) + one.turned * one.turned;
  unknowns_.push_back(one);
}

void GrowingSubset::cutTo(std::size_t size) {
  unknowns_.resize(size);
  lower_.resize(size * (size + 1) / 2);
}

void GrowingSubset::remove(std::size_t place) {
  const std::vector<Unknown> beyond(unknowns_.begin() + static_cast<std::ptrdiff_t>(place) + 1, unknowns_.end());
  cutTo(place);
  for (const Unknown& one : beyond) add(one.index, one.positive);
}

std::ptrdiff_t GrowingSubset::mostNegative() const {
  if (std::none_of(unknowns_.begin(), unknowns_.end(), [](const Unknown& one) { return one.positive; })) return -1;
  std::vector<double> value;  // in its own scale
  for (const Unknown& one : unknowns_) value.push_back(one.turned);
  std::ptrdiff_t worst = -1;
  double least = 0.0;
  std::size_t at = lower_.size();
  for (std::size_t i = value.size(); i-- > 0;) {
    at -= i + 1;
    value[i] /= lower_[at + i];
    for (std::size_t j = 0; j < i; ++j) value[j] -= lower_[at + j] * value[i];
    if (unknowns_[i].positive && value[i] < least) least = value[i], worst = static_cast<std::ptrdiff_t>(i);
  }
  return worst;
}

double GrowingSubset::drop() const {
  if (unknowns_.empty()) return 0.0;
  if (!unknowns_.back().sound) return dropOfSubset();
  const std::ptrdiff_t worst = mostNegative();
  if (worst < 0) return unknowns_.back().drop;
  GrowingSubset fewer = *this;
  fewer.remove(static_cast<std::size_t>(worst));
  return fewer.drop();
}

double GrowingSubset::mostDrop() const {
  if (unknowns_.empty()) return 0.0;
  return unknowns_.back().sound ? unknowns_.back().drop : std::numeric_limits<double>::infinity();
}

double GrowingSubset::dropOfSubset() const {
  std::vector<Eigen::Index> indices;
  std::vector<bool> positive;
  for (const Unknown& one : unknowns_) {
    indices.push_back(one.index);
    positive.push_back(one.positive);
  }
  return fitSubset(projection_, indices, positive, prior_).drop;
}

}  // namespace stiffscope::diagnosis
