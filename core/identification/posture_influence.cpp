#include "core/identification/posture_influence.h"

#include <Eigen/Dense>
#include <array>
#include <utility>

#include "core/parallel/on_all_cores.h"

namespace stiffscope {

namespace {

/// (I - G)^-1/2 of a symmetric G with eigenvalues in 0 .. 1, a thousand postures' as well as two's.
Matrix6d inverseRootOfRest(const Matrix6d& g) {
  // With many postures G is small: by the series sum (2k)! / (4^k k!^2) G^k, the rest of which is below 1e-16.
  constexpr double kSmall = 0.006;
  if (g.trace() < kSmall) {
    constexpr std::array<double, 6> kSeries{0.5, 3.0 / 8.0, 5.0 / 16.0, 35.0 / 128.0, 63.0 / 256.0, 231.0 / 1024.0};
    Matrix6d sum = kSeries.back() * g;
    for (std::size_t k = kSeries.size() - 1; k-- > 0;) {
      sum.diagonal().array() += kSeries[k];
      sum = (sum * g).eval();
    }
    return Matrix6d::Identity() + sum;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> own(g);
  constexpr double kMost = 0.95;  // a posture that alone determines a combination has no residual to correct
  const Vector6d root = (1.0 - own.eigenvalues().array().min(kMost)).rsqrt();
  return own.eigenvectors() * root.asDiagonal() * own.eigenvectors().transpose();
}

}  // namespace

PostureGains::PostureGains(const NormalEquations& sum, const JointMask& unknown) {
  const ScaledNormal scaled = scaledNormal(sum.matrix, unknown);
  const Eigen::LLT<Matrix6d> cholesky(scaled.matrix);
  whiten_ = cholesky.matrixL().solve(Matrix6d(scaled.scale.asDiagonal()));
}

PostureGain PostureGains::of(const Matrix6d& own) const {
  return whiten_.transpose() * inverseRootOfRest(whiten_ * own * whiten_.transpose()) * whiten_;
}

Matrix6d inverseNormal(const NormalEquations& sum, const JointMask& unknown) {
  const ScaledNormal scaled = scaledNormal(sum.matrix, unknown);
  return scaled.scale.asDiagonal() * scaled.matrix.inverse() * scaled.scale.asDiagonal();
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
    last.matrix.conservativeResize(had + more, 6);
    last.right.conservativeResize(had + more);
    last.matrix.bottomRows(more) = one.matrix;
    last.right.tail(more) = one.right;
  }
  equations.resize(postures);
  return equations;
}

std::vector<NormalEquations> normalByPosture(const std::vector<CaseEquations>& equations) {
  std::vector<NormalEquations> normal(equations.size());
  smallWorkOnAllCores(equations.size(), [&](std::size_t i) { normal[i] = normalEquations(equations[i]); });
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

}  // namespace stiffscope
