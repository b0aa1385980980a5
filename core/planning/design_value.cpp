#include "core/planning/design_value.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace stiffscope {

namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

}  // namespace

double choleskyLogDeterminant(const Matrix6d& matrix) {
  const Eigen::LLT<Matrix6d> cholesky(matrix);
  if (cholesky.info() != Eigen::Success) return kNever;
  double sum = 0.0;
  for (int j = 0; j < 6; ++j) sum += std::log(cholesky.matrixLLT()(j, j));
  return 2.0 * sum;
}

double balanceOf(const Vector6d& sd, const Vector6d& reference, const JointMask& unknown) {
  double sum = 0.0;
  for (int j = 0; j < 6; ++j) {
    if (!unknown[static_cast<std::size_t>(j)]) continue;
    const double square = sd[j] * sd[j] / (reference[j] * reference[j]);
    sum += square * square * square * square;
  }
  return -std::log(sum) / 8.0;
}

double logDeterminant(const Matrix6d& information, const JointMask& unknown) {
  const ScaledNormal normal = scaledNormal(information, unknown);
  double logarithm = choleskyLogDeterminant(normal.matrix);
  for (std::size_t j = 0; j < 6; ++j) {
    if (!unknown[j]) continue;
    const double scale = normal.scale[static_cast<Eigen::Index>(j)];
    if (scale == 0.0) return kNever;
    logarithm -= 2.0 * std::log(scale);
  }
  return logarithm;
}

Vector6d standardDeviations(const Matrix6d& information, const JointMask& unknown) {
  const ScaledNormal normal = scaledNormal(information, unknown);
  const Eigen::LLT<Matrix6d> cholesky(normal.matrix);
  Vector6d sd = Vector6d::Constant(std::numeric_limits<double>::quiet_NaN());
  const bool determined = cholesky.info() == Eigen::Success;
  const Matrix6d inverse =
      determined ? Matrix6d(cholesky.solve(Matrix6d::Identity())) : Matrix6d::Zero().eval();
  for (int j = 0; j < 6; ++j) {
    if (!unknown[static_cast<std::size_t>(j)]) continue;
    const bool seen = determined && normal.scale[j] > 0.0;
    sd[j] = seen ? normal.scale[j] * std::sqrt(inverse(j, j)) : std::numeric_limits<double>::infinity();
  }
  return sd;
}

double designValue(const Matrix6d& information, const JointMask& unknown,
                   const std::optional<Vector6d>& reference) {
  if (!reference) return logDeterminant(information, unknown);
  return balanceOf(standardDeviations(information, unknown), *reference, unknown);
}

}  // namespace stiffscope
