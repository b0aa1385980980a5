#include "app/figures/arm_pose.h"

#include <algorithm>
#include <utility>

#include "core/robot/kinematics.h"
#include "metrology/common_perpendicular.h"
#include "reports/page/names.h"

namespace stiffscope {

namespace {

/// A point on each axis, all joints at zero: a chain that looks like the arm for any place of the axes' own
/// points.
std::array<Eigen::Vector3d, 6> jointPointsAtZero(const Robot& arm, const Eigen::Vector3d& foot) {
  std::array<Eigen::Vector3d, 6> points;
  points[0] = nearestPoint(arm.axes_in_base_at_zero[0], foot);
  for (std::size_t i = 1; i < 6; ++i) points[i] = nearestPoint(arm.axes_in_base_at_zero[i], points[i - 1]);
  return points;
}

/// The three rows of a point out of A c; empty where the method does not have them.
std::optional<Eigen::Vector3d> predicted(const std::vector<CaseEquations>& rows, std::size_t index,
                                         std::size_t point, const Vector6d& compliance) {
  if (index >= rows.size()) return std::nullopt;
  const auto row = static_cast<Eigen::Index>(3 * point);
  if (row + 3 > rows[index].matrix.rows()) return std::nullopt;
  return Eigen::Vector3d(rows[index].matrix.middleRows<3>(row) * compliance);
}

}  // namespace

double heightOfR0(const Frames& frames) {
  return std::max(0.0, -frames.arm.r0_from_base_link.translation().z());
}

ArmPose bareArm(const Frames& frames, const ArmPosture& posture) {
  const Robot& arm = frames.arm.arm;
  const Eigen::Vector3d up(0.0, 0.0, heightOfR0(frames));  // from R0's origin to the scene's
  ArmPose pose;
  const auto points = jointPointsAtZero(arm, -up);
  for (int joint = 0; joint < 6; ++joint) {
    const auto j = static_cast<std::size_t>(joint);
    pose.joint_points.push_back(posture.motion[j] * points[j] + up);
    pose.axis_directions.push_back(axisAt(arm, posture, joint).direction);
  }
  pose.joint_points.push_back(flangeAt(arm, posture).translation() + up);
  return pose;
}

ArmPose armPose(const ReportCampaign& one, std::size_t index, std::optional<Method> which) {
  const Identification& result = one.identification;
  const LoadCase& load_case = result.cases[index];
  const Eigen::Vector3d up(0.0, 0.0, heightOfR0(result.frames));
  const MethodResult* method = which && result.of(*which).available ? &result.of(*which) : nullptr;
  const auto pointOf = [&](std::string label, const Eigen::Vector3d& unloaded,
                           const Eigen::Vector3d& displacement, const auto& rows, std::size_t at) {
    ScenePoint point{std::move(label), unloaded + up, displacement, std::nullopt, std::nullopt};
    if (method) point.predicted = predicted(method->*rows, index, at, method->estimate.compliance);
    if (point.predicted) point.residual = displacement - *point.predicted;
    return point;
  };

  ArmPose pose = bareArm(result.frames, unloadedPosture(result.frames.arm.arm, load_case));
  for (std::size_t t = 0; t < load_case.targets.size(); ++t) {
    const TargetMove& move = load_case.targets[t];
    pose.targets.push_back(
        pointOf(page::pointName(one.campaign.targets[static_cast<std::size_t>(move.target)].id), move.unloaded,
                move.displacement(), &MethodResult::target_rows, t));
  }
  if (index < result.wrist.size()) {
    const WristMove& move = result.wrist[index];
    pose.wrist = pointOf("P_{wrist}", move.unloaded, move.displacement(), &MethodResult::wrist_rows, 0);
  }
  return pose;
}

}  // namespace stiffscope
