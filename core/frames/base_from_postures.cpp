#include "core/frames/base_from_postures.h"

#include <Eigen/Dense>
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

}  // namespace

std::optional<BaseFromPostures> baseFromPostures(const robot::Robot& arm,
                                                 const std::vector<UnloadedPosition>& positions,
                                                 std::size_t target_count) {
  const std::map<int, Seen> poses = byPose(arm, positions);
  if (poses.size() < 3) return std::nullopt;
  const Seen& first = poses.begin()->second;
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (const auto& [pose, seen] : poses) {
    const auto turn = measuredTurn(first, seen);
    if (!turn) continue;
    const Eigen::Matrix3d by_model =
        seen.posture.motion.back().linear() * first.posture.motion.back().linear().transpose();
    cross += robot::rotationVector(*turn) * robot::rotationVector(by_model).transpose();
  }
  const metrology::NearestRotation nearest = metrology::nearestRotation(cross);
  constexpr double kOneAxis = 1e-3;
  if (!(nearest.singular_values[1] > kOneAxis * nearest.singular_values[0])) return std::nullopt;
  const Eigen::Matrix3d& points_from_base = nearest.rotation;

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
  const Eigen::VectorXd solution = solveSymmetric(normal, right);
  BaseFromPostures result;
  result.points_from_base.linear() = points_from_base;
  result.points_from_base.translation() = solution.head<3>();
  result.targets_at_zero.resize(target_count);
  for (std::size_t k = 0; k < target_count; ++k) {
    if (counts[k] > 0) result.targets_at_zero[k] = solution.segment<3>(3 + 3 * static_cast<int>(k));
  }
  return result;
}

}  // namespace stiffscope::frames
