#include "app/figures/arm_pose.h"

#include <algorithm>

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

double heightOfR0(const Identification& identification) {
  return std::max(0.0, -identification.frames.arm.r0_from_base_link.translation().z());
}

ArmPose armPose(const ReportCampaign& one, std::size_t index) {
  const Identification& result = one.identification;
  const Robot& arm = result.frames.arm.arm;
  const LoadCase& load_case = result.cases[index];
  const Eigen::Vector3d up(0.0, 0.0, heightOfR0(result));  // from R0's origin to the scene's
  const auto shown = page::shownMethod(result);
  const MethodResult* method = shown ? &result.of(*shown) : nullptr;

  ArmPose pose;
  const auto points = jointPointsAtZero(arm, -up);
  for (int joint = 0; joint < 6; ++joint) {
    const auto j = static_cast<std::size_t>(joint);
    pose.joint_points.push_back(load_case.posture.motion[j] * points[j] + up);
    pose.axis_directions.push_back(axisAt(arm, load_case.posture, joint).direction);
  }
  pose.joint_points.push_back(flangeAt(arm, load_case.posture).translation() + up);
  for (std::size_t t = 0; t < load_case.targets.size(); ++t) {
    const TargetMove& move = load_case.targets[t];
    ScenePoint point{page::pointName(one.campaign.targets[static_cast<std::size_t>(move.target)].id),
                     move.unloaded + up, move.displacement(), std::nullopt};
    if (method) point.predicted = predicted(method->target_rows, index, t, method->estimate.compliance);
    pose.targets.push_back(std::move(point));
  }
  if (index < result.wrist.size()) {
    const WristMove& move = result.wrist[index];
    pose.wrist = ScenePoint{"P_{wrist}", move.unloaded + up, move.displacement(), std::nullopt};
    if (method) pose.wrist->predicted = predicted(method->wrist_rows, index, 0, method->estimate.compliance);
  }
  return pose;
}

}  // namespace stiffscope
