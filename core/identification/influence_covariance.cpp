#include "core/identification/influence_covariance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>

#include "core/identification/coverage_factor.h"

namespace stiffscope {

namespace {

constexpr Eigen::Index kExact = 64;

/// The postures of the largest own influence, in their order.
std::vector<Eigen::Index> largest(const Eigen::VectorXd& own, Eigen::Index count) {
  std::vector<Eigen::Index> postures(static_cast<std::size_t>(own.size()));
  std::iota(postures.begin(), postures.end(), Eigen::Index{0});
  const auto end = postures.begin() + std::min(count, own.size());
  std::partial_sort(postures.begin(), end, postures.end(), [&](Eigen::Index a, Eigen::Index b) {
    return own[a] > own[b] || (own[a] == own[b] && a < b);
  });
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

InfluenceCovariance influenceCovariance(const std::vector<PostureGain>& gains, const std::vector<NormalEquations>& normal,
                                        const Matrix6d& inverse, int joint) {
  const auto n = static_cast<Eigen::Index>(gains.size());
  InfluenceCovariance covariance{Eigen::VectorXd(n), Eigen::MatrixXd(6, n), -inverse};
  for (Eigen::Index p = 0; p < n; ++p) {
    const auto at = static_cast<std::size_t>(p);
    const Vector6d row = gains[at].row(joint).transpose(), through = normal[at].matrix * row;
    covariance.through.col(p) = through;
    covariance.own[p] = row.dot(through);
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

}  // namespace stiffscope
