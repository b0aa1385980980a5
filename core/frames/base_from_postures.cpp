#include "core/frames/base_from_postures.h"

#include <Eigen/Dense>
#include <cmath>
#include <map>

#include "core/robot/inverse_kinematics.h"
#include "core/robot/kinematics.h"
#include "metrology/linear_algebra.h"
#include "metrology/registration.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::frames {

namespace {

struct Seen {
  robot::ArmPosture posture;
  std::map<int, Eigen::Vector3d> points;
};

std::map<int, Seen> byPose(const robot::Robot& arm, const std::vector<UnloadedPosition>& positions) {
  std::map<int, Seen> poses;
  for (const UnloadedPosition& position : positions) {
    Seen& seen = poses[position.pose];
    if (seen.points.empty()) seen.posture = robot::postureAt(arm, position.q);
    seen.points[position.target] = position.point;
  }
  return poses;
}

/// Rotation of the reflectors from one pose to another by their common points.
std::optional<Eigen::Matrix3d> measuredTurn(const Seen& from, const Seen& to) {
  std::vector<Eigen::Vector3d> before, after;
  for (const auto& [target, point] : from.points) {
    const auto same = to.points.find(target);
    if (same == to.points.end()) continue;
    before.push_back(point);
    after.push_back(same->second);
  }
  const metrology::RigidRegistration registration = metrology::registerRigid(before, after);
  if (!registration.determined) return std::nullopt;
  return Eigen::Matrix3d(registration.to_from_source.linear());
}

/// The rows of the turn about one direction `axis` (base axes), `base` being the base's rotation but for that turn:
/// with y = base^T point, c y + s (y x axis) - M x_k - t = m across `axis`, c and s the turn's cosine and sine. Linear
/// in c, s, t and the x_k, and solved for c and s; empty where t and x_k alone explain every y.
std::optional<Eigen::Matrix3d> turnAbout(const Eigen::Vector3d& axis, const Eigen::Matrix3d& base,
                                         const std::map<int, Seen>& poses, std::size_t target_count) {
  const Eigen::Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  Eigen::Matrix<double, 2, 3> across;
  across << u.transpose(), v.transpose();
  const auto size = static_cast<Eigen::Index>(2 + 2 * target_count);
  // Products of the columns of t and x_k with each other, and with those of c, s and the right side.
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(size, size), with = Eigen::MatrixXd::Zero(size, 3);
  Eigen::Matrix3d others = Eigen::Matrix3d::Zero();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const auto& [pose, seen] : poses) {
    for (const auto& [target, point] : seen.points) middle += point, count += 1.0;
  }
  middle /= count;
  for (const auto& [pose, seen] : poses) {
    const Eigen::Isometry3d& motion = seen.posture.motion.back();
    const Eigen::Matrix2d turn = across * motion.linear() * across.transpose();
    for (const auto& [target, point] : seen.points) {
      const Eigen::Vector3d y = base.transpose() * (point - middle);
      Eigen::Matrix<double, 2, 3> rest;
      rest << across * y, across * y.cross(axis), across * motion.translation();
      const Eigen::Index at = 2 + 2 * target;
      own.topLeftCorner<2, 2>() += Eigen::Matrix2d::Identity();
      own.block<2, 2>(0, at) += turn;
      own.block<2, 2>(at, 0) += turn.transpose();
      own.block<2, 2>(at, at) += turn.transpose() * turn;
      with.topRows<2>() += rest;
      with.middleRows<2>(at) += turn.transpose() * rest;
      others += rest.transpose() * rest;
    }
  }
  // Reflectors that were not read, and a flange that always stands turned alike, which t and x_k share.
  own.diagonal().array() += 1e-9 * count;
  const Eigen::Matrix3d left = others - with.transpose() * solveSymmetric(own, with);
  constexpr double kSpread = 0.010;  // m rms: what t and x_k leave of the readings, or their turn is noise
  if (!(left(0, 0) > kSpread * kSpread * count)) return std::nullopt;
  const Eigen::Vector2d turn = solveSymmetric(left.topLeftCorner<2, 2>(), left.topRightCorner<2, 1>());
  return Eigen::AngleAxisd(std::atan2(turn[1], turn[0]), axis).toRotationMatrix();
}

}  // namespace

void BaseFromPostures::slide(double by) {
  points_from_base.translation() -= by * (points_from_base.linear() * *open);
  for (std::optional<Eigen::Vector3d>& target : targets_at_zero) {
    if (target) *target += by * *open;
  }
}

void slideToStated(const std::vector<std::optional<Eigen::Vector3d>>& targets_at_zero,
                   const std::optional<Eigen::Isometry3d>& points_from_base, BaseFromPostures& found) {
  if (!found.open) return;
  double by = 0.0, count = 0.0;
  for (std::size_t k = 0; k < targets_at_zero.size(); ++k) {
    if (!targets_at_zero[k] || !found.targets_at_zero[k]) continue;
    by += found.open->dot(*targets_at_zero[k] - *found.targets_at_zero[k]);
    count += 1.0;
  }
  if (count > 0.0) return found.slide(by / count);
  if (!points_from_base) return;
  const Eigen::Vector3d off = found.points_from_base.translation() - points_from_base->translation();
  found.slide(off.dot(found.points_from_base.linear() * *found.open));
}

std::optional<BaseFromPostures> baseFromPostures(const robot::Robot& arm,
                                                 const std::vector<UnloadedPosition>& positions,
                                                 std::size_t target_count) {
  const std::map<int, Seen> poses = byPose(arm, positions);
  if (poses.size() < 3) return std::nullopt;
  const Seen& first = poses.begin()->second;
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  int turns = 0;
  for (const auto& [pose, seen] : poses) {
    const auto turn = measuredTurn(first, seen);
    if (!turn) continue;
    const Eigen::Matrix3d by_model =
        seen.posture.motion.back().linear() * first.posture.motion.back().linear().transpose();
    cross += robot::rotationVector(*turn) * robot::rotationVector(by_model).transpose();
    ++turns;
  }
  const metrology::NearestRotation nearest = metrology::nearestRotation(cross);
  constexpr double kOneAxis = 1e-3, kTurned = 1e-3;  // rad^2: two degrees
  constexpr int kLeastTurns = 3;                     // the first against itself among them
  if (turns < kLeastTurns || !(nearest.singular_values[0] > kTurned)) return std::nullopt;
  BaseFromPostures result;
  Eigen::Matrix3d points_from_base = nearest.rotation;
  if (!(nearest.singular_values[1] > kOneAxis * nearest.singular_values[0])) {
    result.open = symmetricEigen(cross.transpose() * cross).vectors.col(2);
    const auto turn = turnAbout(*result.open, points_from_base, poses, target_count);
    if (!turn) return std::nullopt;
    points_from_base *= *turn;
  }

  // point = R (M x_k + m) + t is linear in t and the x_k.
  const auto size = static_cast<Eigen::Index>(3 + 3 * target_count);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  std::vector<int> counts(target_count, 0);
  for (const auto& [pose, seen] : poses) {
    const Eigen::Matrix3d turn = points_from_base * seen.posture.motion.back().linear();
    const Eigen::Vector3d shift = points_from_base * seen.posture.motion.back().translation();
    for (const auto& [target, point] : seen.points) {
      const Eigen::Index at = 3 + 3 * target;
      normal.topLeftCorner<3, 3>() += Eigen::Matrix3d::Identity();
      normal.block<3, 3>(0, at) += turn;
      normal.block<3, 3>(at, 0) += turn.transpose();
      normal.block<3, 3>(at, at) += Eigen::Matrix3d::Identity();
      right.head<3>() += point - shift;
      right.segment<3>(at) += turn.transpose() * (point - shift);
      ++counts[static_cast<std::size_t>(target)];
    }
  }
  for (std::size_t k = 0; k < target_count; ++k) {
    if (counts[k] == 0) normal.block<3, 3>(3 + 3 * static_cast<int>(k), 3 + 3 * static_cast<int>(k)).setIdentity();
  }
  if (result.open) {  // the reflectors' mean along it at the flange's
    const Eigen::Vector3d flange = arm.base_from_flange_at_zero.translation();
    Eigen::VectorXd heights = Eigen::VectorXd::Zero(size);
    double seen = 0.0;
    for (std::size_t k = 0; k < target_count; ++k) {
      if (counts[k] == 0) continue;
      heights.segment<3>(3 + 3 * static_cast<int>(k)) = *result.open;
      seen += 1.0;
    }
    normal += heights * heights.transpose();
    right += seen * result.open->dot(flange) * heights;
  }
  const Eigen::VectorXd solution = solveSymmetric(normal, right);
  result.points_from_base.linear() = points_from_base;
  result.points_from_base.translation() = solution.head<3>();
  result.targets_at_zero.resize(target_count);
  for (std::size_t k = 0; k < target_count; ++k) {
    if (counts[k] > 0) result.targets_at_zero[k] = solution.segment<3>(3 + 3 * static_cast<int>(k));
  }
  return result;
}

}  // namespace stiffscope::frames
