#include "core/audit/wrist_residuals.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <vector>

#include "core/audit/moved_axes.h"

namespace stiffscope {

namespace {

constexpr Eigen::Index kCentre = 3, kAxes = 12;

/// One reading: radial distance less the model's, its derivatives, its standard deviation. The derivative by its reflector's
/// radius is 1, by the others' 0.
struct Row {
  double residual = 0.0, sd = 0.0;
  int target = 0;
  std::array<double, kCentre> by_centre{};
  std::array<double, kAxes> by_axes{};

  Eigen::RowVectorXd jacobian(Eigen::Index targets) const {
    Eigen::RowVectorXd all = Eigen::RowVectorXd::Zero(kCentre + targets + kAxes);
    for (Eigen::Index k = 0; k < kCentre; ++k) all[k] = by_centre[static_cast<std::size_t>(k)];
    all[kCentre + target] = 1.0;
    for (Eigen::Index k = 0; k < kAxes; ++k) all[kCentre + targets + k] = by_axes[static_cast<std::size_t>(k)];
    return all;
  }
};

std::vector<Row> rowsOf(const Evidence& evidence) {
  const WristSweep& sweep = *evidence.campaign.wrist_sweep;
  const Frames& frames = evidence.frames;
  const Robot& arm = frames.arm.arm;
  const WristCentre& wrist = frames.wrist;
  const MovedAxes axes(frames);
  std::vector<Row> rows;
  rows.reserve(sweep.rows.size());
  for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
    const WristReading& reading = sweep.rows[i];
    const auto& at_zero = frames.targets_in_r0_at_zero[static_cast<std::size_t>(reading.target)];
    if (!at_zero) continue;
    const Eigen::Vector3d from_centre =
        frames.arm.r0_from_points * evidence.rigid.wrist_sweep[i] - wrist.centre_in_r0;
    const ArmPosture posture = postureAt(arm, reading.q);
    const Eigen::Vector3d centre = posture.motion[3] * wrist.centre_at_zero_in_r0;
    const auto modelled = [&](const ArmPosture& at) { return (at.motion[6] * *at_zero - centre).norm(); };
    const Eigen::Vector3d radial = from_centre.normalized();
    const Eigen::Vector3d seen = frames.arm.r0_from_points.linear().transpose() * radial;
    Row row;
    row.residual = from_centre.norm() - modelled(posture);
    row.sd = std::sqrt(seen.dot(evidence.noise->covarianceAt(reading.point) * seen));
    row.target = reading.target;
    row.by_centre = {radial.x(), radial.y(), radial.z()};
    for (int k = 0; k < kAxes; ++k) {
      const ArmPosture moved =
          axes.postureWithMoved(arm, reading.q, static_cast<std::size_t>(3 + k / 4), k % 4);
      row.by_axes[static_cast<std::size_t>(k)] = (modelled(moved) - modelled(posture)) / MovedAxes::kStep;
    }
    rows.push_back(row);
  }
  return rows;
}

/// Normal matrix of the prior on the axes.
Eigen::MatrixXd priorOf(const Frames& frames, Eigen::Index targets) {
  const MovedAxes axes(frames);
  const Eigen::Index at = kCentre + targets;
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(at + kAxes, at + kAxes);
  for (Eigen::Index j = 0; j < 3; ++j) {
    prior.block<4, 4>(at + 4 * j, at + 4 * j) = axes.covariance(static_cast<std::size_t>(3 + j)).inverse();
  }
  return prior;
}

}  // namespace

WristResiduals wristResiduals(const Evidence& evidence) {
  const auto targets = static_cast<Eigen::Index>(evidence.campaign.targets.size());
  const std::vector<Row> rows = rowsOf(evidence);
  const Eigen::MatrixXd prior = priorOf(evidence.frames, targets);
  Eigen::MatrixXd normal = prior;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(normal.rows());
  for (const Row& row : rows) {
    const Eigen::RowVectorXd jacobian = row.jacobian(targets);
    normal += jacobian.transpose() * jacobian / (row.sd * row.sd);
    right += jacobian.transpose() * row.residual / (row.sd * row.sd);
  }
  WristResiduals result;
  result.dof = static_cast<int>(rows.size()) - static_cast<int>(kCentre);
  for (Eigen::Index k = 0; k < targets; ++k) {
    // A reflector that was not swept has no radius to find.
    if (normal(kCentre + k, kCentre + k) == 0.0) {
      normal(kCentre + k, kCentre + k) = 1.0;
    } else {
      --result.dof;
    }
  }
  const Eigen::VectorXd found = normal.ldlt().solve(right);
  result.chi2 = found.dot(prior * found);
  double farthest = -1.0;
  std::size_t at = 0;
  for (const WristReading& reading : evidence.campaign.wrist_sweep->rows) {
    if (!evidence.frames.targets_in_r0_at_zero[static_cast<std::size_t>(reading.target)]) continue;
    const Row& row = rows[at++];
    const double left = row.residual - row.jacobian(targets).dot(found), sigmas = std::abs(left) / row.sd;
    result.chi2 += sigmas * sigmas;
    result.rms += left * left;
    if (sigmas > farthest) farthest = sigmas, result.worst = reading.line;
  }
  result.rms = result.dof > 0 ? std::sqrt(result.rms / result.dof) : 0.0;
  return result;
}

}  // namespace stiffscope
