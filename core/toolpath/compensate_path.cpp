#include "core/toolpath/compensate_path.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "core/numerics/parallel.h"
#include "core/robot/inverse_kinematics.h"
#include "core/toolpath/remarks.h"

namespace stiffscope::toolpath {

namespace {

/// Joint angles at which the unloaded arm, bent by its own weight, holds the tool; empty where it does not come to rest
/// or the steps do not end. The rigid arm is sent to the pose less the sag found before: a contraction of a hundredth.
std::optional<JointVector> bentSolution(const compensation::DeflectingArm& arm,
                                        const Eigen::Isometry3d& flange_from_tool,
                                        const Eigen::Isometry3d& r0_from_tool, const JointVector& rigid) {
  constexpr int kMostSteps = 20;
  constexpr double kClose = 1e-9;  // m and rad
  JointVector q = rigid;
  Eigen::Isometry3d sent = r0_from_tool;
  for (int step = 0; step < kMostSteps; ++step) {
    const auto flange = compensation::restingFlange(arm.geometry, arm.estimate, arm.with, q);
    if (!flange) return std::nullopt;
    const Eigen::Isometry3d tool = *flange * flange_from_tool;
    const Eigen::Vector3d shift = r0_from_tool.translation() - tool.translation();
    const Eigen::Matrix3d turn = r0_from_tool.linear() * tool.linear().transpose();
    if (shift.cwiseAbs().maxCoeff() < kClose && robot::rotationVector(turn).cwiseAbs().maxCoeff() < kClose) return q;
    sent.translation() += shift;
    sent.linear() = turn * sent.linear();
    const robot::InverseKinematics found = robot::inverseKinematics(arm.geometry.arm, sent, flange_from_tool, q);
    if (!found.reached) return std::nullopt;
    q = found.q;
  }
  return std::nullopt;
}

SmallMotion offsetOf(const compensation::DeflectingArm& arm, const PathJob& job,
                     const Eigen::Matrix3d& workpiece_from_r0, const compensation::CompensatedPosture& found) {
  const auto toolAt = [&](const JointVector& q) {
    return robot::flangeAt(arm.geometry.arm, robot::postureAt(arm.geometry.arm, q)) * job.flange_from_tool;
  };
  const Eigen::Isometry3d before = toolAt(found.posture.q), after = toolAt(found.commands);
  return {workpiece_from_r0 * (after.translation() - before.translation()),
          workpiece_from_r0 * robot::rotationVector(after.linear() * before.linear().transpose())};
}

/// The postures of the day, from which branches are looked for, and their range, which is preferred.
JointPathOptions jointOptions(const compensation::DeflectingArm& arm, const PathJob& job) {
  JointPathOptions options = job.joints;
  if (arm.campaign.states) {
    for (const campaign::State& state : arm.campaign.states->rows) {
      if (state.step == 0) options.seeds.push_back(state.q);
    }
  }
  options.seeds.push_back(JointVector::Zero(arm.geometry.arm.joints()));
  if (arm.certainty != nullptr && !options.preferred_low) {
    options.preferred_low = arm.certainty->range.low;
    options.preferred_high = arm.certainty->range.high;
    if (compensation::turnsFreely(arm.geometry, 0)) {
      constexpr double kAny = std::numeric_limits<double>::infinity();
      (*options.preferred_low)[0] = -kAny, (*options.preferred_high)[0] = kAny;
    }
  }
  return options;
}

}  // namespace

ToolWrench CompensatedPathPose::wrenchAtTip() const {
  ToolWrench at_tip = wrench;
  at_tip.point_in_tool.setZero();
  at_tip.moment += (workpiece_from_tool * wrench.point_in_tool).cross(wrench.force);
  return at_tip;
}

std::vector<compensation::CompensatedPosture> CompensatedPath::postures() const {
  std::vector<compensation::CompensatedPosture> all;
  for (const CompensatedPathPose& pose : poses) all.push_back(pose.compensated);
  return all;
}

CompensatedPath compensatePath(const compensation::DeflectingArm& arm, const PathJob& job) {
  const Eigen::Isometry3d r0_from_workpiece = arm.geometry.r0_from_base_link * job.base_from_workpiece;
  const Eigen::Matrix3d &to_r0 = r0_from_workpiece.linear(), from_r0 = to_r0.transpose();
  std::vector<Eigen::Isometry3d> wanted;
  for (const PathPose& pose : job.path.poses) wanted.push_back(r0_from_workpiece * pose.workpiece_from_tool);
  const JointPath joints =
      jointPath(arm.geometry.arm, wanted, job.flange_from_tool, job.turn_free, jointOptions(arm, job));
  // Axes of the tool are those of the tool as it is held: about its own axis it may be turned.
  ToolPath held = job.path;
  for (std::size_t i = 0; i < held.poses.size(); ++i) {
    if (joints.poses[i].q.size() > 0)
      held.poses[i].workpiece_from_tool.linear() = from_r0 * joints.poses[i].base_from_tool.linear();
  }
  const std::vector<ToolWrench> wrenches = toolWrenches(held, job.base_from_workpiece, job.load);
  const std::vector<double> lengths = lengthsAlong(job.path);

  CompensatedPath result;
  result.branches = joints.branches;
  result.poses.resize(wanted.size());
  numerics::onAllCores(wanted.size(), [&](std::size_t i) {
    CompensatedPathPose& pose = result.poses[i];
    pose.tip_in_workpiece = job.path.poses[i].workpiece_from_tool.translation();
    pose.workpiece_from_tool = job.path.poses[i].workpiece_from_tool.linear();
    pose.along = lengths[i];
    pose.joints = joints.poses[i];
    pose.wrench = wrenches[i];
    compensation::CompensatedPosture& found = pose.compensated;
    found.posture.id = job.path.poses[i].id;
    const int axes = arm.geometry.arm.joints();
    found.posture.q = JointVector::Constant(axes, std::numeric_limits<double>::quiet_NaN());
    found.commands = pose.joint_torque = JointVector::Zero(axes);
    found.reason = pose.joints.reason.empty() ? pose.wrench.reason : pose.joints.reason;
    if (!pose.joints.q.allFinite()) return;
    const auto q = bentSolution(arm, job.flange_from_tool, pose.joints.base_from_tool, pose.joints.q);
    if (!q) {
      if (found.reason.empty()) found.reason = Remark(RemarkId::arm_does_not_rest);
      return;
    }
    found.posture.q = *q;
    found.posture.load = effects::FlangeLoad{job.flange_from_tool * pose.wrench.point_in_tool,
                                             to_r0 * pose.wrench.force, to_r0 * pose.wrench.moment};
  });

  std::vector<compensation::PostureToCompensate> asked;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < result.poses.size(); ++i) {
    if (!result.poses[i].compensated.reason.empty()) continue;
    asked.push_back(result.poses[i].compensated.posture);
    places.push_back(i);
  }
  const std::vector<compensation::CompensatedPosture> compensated = compensation::compensate(
      arm.campaign, arm.geometry, arm.estimate, job.flange_from_tool.translation(), asked, {}, arm.with, arm.certainty);
  for (std::size_t k = 0; k < places.size(); ++k) {
    CompensatedPathPose& pose = result.poses[places[k]];
    pose.compensated = compensated[k];
    const compensation::CompensatedPosture& found = pose.compensated;
    pose.deflection = {from_r0 * found.tcp.deflection, from_r0 * found.rotation};
    const robot::ArmPosture posture = robot::postureAt(arm.geometry.arm, found.posture.q);
    const effects::FlangeLoad& load = *found.posture.load;
    pose.joint_torque = robot::jointTorque(
        arm.geometry.arm, posture,
        {robot::flangeAt(arm.geometry.arm, posture) * load.point_in_flange, load.force, load.moment});
    if (found.solved) pose.offset = offsetOf(arm, job, from_r0, found);
  }
  return result;
}

}  // namespace stiffscope::toolpath
