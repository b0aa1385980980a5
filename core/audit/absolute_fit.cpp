#include "core/audit/absolute_fit.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "core/audit/absolute_rows.h"
#include "core/audit/chance.h"
#include "core/audit/limits.h"

namespace stiffscope {

namespace {

using namespace audit_limits;

/// Weighted normal equations over the postures that take part, with what is known beforehand on the diagonal.
struct Normal {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  double squares = 0.0;  ///< chi2 with all parameters at zero
  int rows = 0;
};

Normal sumUp(const AbsoluteRows& rows, const std::set<int>& left_out) {
  const auto size = static_cast<Eigen::Index>(rows.parameters);
  Normal normal{rows.prior, Eigen::VectorXd::Zero(size)};
  for (const AbsoluteRow& row : rows.rows) {
    if (left_out.contains(row.pose)) continue;
    normal.matrix += row.jacobian.transpose() * row.weight * row.jacobian;
    normal.right += row.jacobian.transpose() * row.weight * row.residual;
    normal.squares += row.residual.dot(row.weight * row.residual);
    normal.rows += 3;
  }
  // A reflector that no row of the postures left shows stays where it is.
  for (Eigen::Index i = 0; i < size; ++i) {
    if (normal.matrix(i, i) == 0.0) normal.matrix(i, i) = 1.0;
  }
  return normal;
}

double leastSquares(const Normal& normal, Eigen::Index from) {
  const Eigen::Index size = normal.right.size() - from;
  const Eigen::VectorXd right = normal.right.tail(size);
  return normal.squares - right.dot(normal.matrix.bottomRightCorner(size, size).ldlt().solve(right));
}

/// Joint angles of one posture from what the fit leaves of its reflectors.
PostureReadBack readBackOf(const AbsoluteRows& rows, const Eigen::VectorXd& parameters, int pose) {
  PostureReadBack result;
  result.pose = pose;
  Matrix6d normal = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  double squares = 0.0;
  for (const AbsoluteRow& row : rows.rows) {
    if (row.pose != pose) continue;
    const Eigen::Vector3d left = row.residual - row.jacobian * parameters;
    normal += row.by_angles.transpose() * row.weight * row.by_angles;
    right += row.by_angles.transpose() * row.weight * left;
    squares += left.dot(row.weight * left);
  }
  const Eigen::CompleteOrthogonalDecomposition<Matrix6d> solver(normal);
  result.correction = solver.solve(right);
  const Vector6d sd = solver.pseudoInverse().diagonal().cwiseMax(0.0).cwiseSqrt();
  double best = -1.0;
  for (int j = 0; j < 6; ++j) {
    result.significance[j] = sd[j] > 0.0 ? result.correction[j] / sd[j] : 0.0;
    const double alone = normal(j, j) > 0.0 ? right[j] * right[j] / normal(j, j) : 0.0;
    if (alone <= best) continue;
    best = alone;
    result.joint = j;
    result.joint_correction = right[j] / normal(j, j);
  }
  result.explained = squares > 0.0 ? right.dot(result.correction) / squares : 0.0;
  return result;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Scores against the campaign's own scatter of each joint (median absolute deviation, never below the
/// reading noise), because geometry errors put more than noise into every posture.
void scorePostures(std::vector<PostureReadBack>& postures, double limit) {
  constexpr double kMadOfNormal = 1.4826;  // median absolute deviation to standard deviation
  for (PostureReadBack& posture : postures) posture.score = 0.0;
  for (int j = 0; j < 6; ++j) {
    std::vector<double> values;
    for (const PostureReadBack& posture : postures) values.push_back(posture.significance[j]);
    const double middle = median(values);
    for (double& value : values) value = std::abs(value - middle);
    const double scale = std::max(1.0, kMadOfNormal * median(values));
    for (PostureReadBack& posture : postures) {
      posture.score = std::max(posture.score, std::abs(posture.significance[j] - middle) / scale);
    }
  }
  for (PostureReadBack& posture : postures) posture.outlier = posture.score > limit;
}

/// Limit of a score: Student's t, the median absolute deviation being worth 0.37 of its sample (its
/// efficiency).
double scoreLimit(std::size_t postures) {
  const double count = static_cast<double>(postures);
  return studentLimit(kLevel / (6.0 * count), std::max(1.0, 0.37 * (count - 1.0)));
}

void describe(const AbsoluteRows& rows, const Normal& normal, const std::set<int>& left_out,
              const Eigen::VectorXd& parameters, AbsoluteFit& fit) {
  fit.shift = parameters.head<6>();
  fit.shift_covariance = normal.matrix.ldlt()
                             .solve(Eigen::MatrixXd::Identity(normal.right.size(), normal.right.size()))
                             .topLeftCorner<6, 6>();
  fit.chi2 = leastSquares(normal, 0);
  fit.shift_chi2 = leastSquares(normal, 6) - fit.chi2;
  fit.positions = normal.rows / 3;
  fit.dof = normal.rows - 6 - 3 * rows.targets;
  for (const AbsoluteRow& row : rows.rows) {
    if (left_out.contains(row.pose)) continue;
    fit.rms_before += row.residual.squaredNorm() / normal.rows;
    fit.rms_after += (row.residual - row.jacobian * parameters).squaredNorm() / normal.rows;
  }
  fit.rms_before = std::sqrt(fit.rms_before);
  fit.rms_after = std::sqrt(fit.rms_after);
}

}  // namespace

AbsoluteFit fitAbsolutePositions(const Campaign& campaign, const Frames& frames,
                                 const LoadingGeometry& geometry, const std::vector<StatePoints>& states,
                                 const std::optional<TrackerNoise>& noise) {
  AbsoluteFit fit;
  const AbsoluteRows rows = absoluteRows(campaign, frames, geometry, states, noise);
  fit.reason = rows.reason;
  if (!rows.reason.empty()) return fit;
  fit.centre = rows.centre;
  fit.sag_known = frames.weight.links_known && !geometry.compliance.isZero();
  constexpr std::size_t kLeastPostures = 4;  // more than shift and reflectors take, with some to check by
  if (rows.poses.size() < kLeastPostures) {
    fit.reason =
        fmt::format("{} unloaded postures: {} or more are needed", rows.poses.size(), kLeastPostures);
    return fit;
  }
  fit.score_limit = scoreLimit(rows.poses.size());
  // An outlier pulls the common fit, so the fit is made again without those found; each round finds fewer.
  std::set<int> left_out;
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds; ++round) {
    const Normal normal = sumUp(rows, left_out);
    const Eigen::VectorXd parameters = normal.matrix.ldlt().solve(normal.right);
    fit.postures.clear();
    for (const int pose : rows.poses) fit.postures.push_back(readBackOf(rows, parameters, pose));
    scorePostures(fit.postures, fit.score_limit);
    std::set<int> outliers;
    for (const PostureReadBack& posture : fit.postures) {
      if (posture.outlier) outliers.insert(posture.pose);
    }
    const bool settled =
        outliers == left_out || 2 * outliers.size() > rows.poses.size() || round + 1 == kRounds;
    if (settled) {
      fit.rms_before = fit.rms_after = 0.0;
      describe(rows, normal, left_out, parameters, fit);
      break;
    }
    left_out = outliers;
  }
  fit.done = true;
  return fit;
}

}  // namespace stiffscope
