#include "core/toolpath/compensate_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "core/extended_model/effect_deflection.h"
#include "core/extended_model/extend_model.h"
#include "core/identification/known_stiffness.h"
#include "core/preparation/prepare.h"
#include "core/simulation/measure.h"
#include "core/simulation/read_spec.h"
#include "reports/words/compensation_words.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/known_arm.h"

namespace stiffscope {
namespace compensate_path_test {

using Eigen::Vector3d;

/// An arm with known springs and a path near one of its postures.
struct KnownPath : KnownArm {
  toolpath::PathJob job;

  KnownPath() {
    job.flange_from_tool.translation() << 0.05, -0.02, 0.25;
    job.flange_from_tool.linear() = robot::rotationFromRpy({0.1, 0.4, 0.0});
    const Eigen::Isometry3d first =
        lab.actual.flangeAt(lab.settled(degrees(20, 10, -20, 50, 60, -30))) * job.flange_from_tool;
    job.base_from_workpiece = first;
    job.base_from_workpiece.linear() = robot::rotationFromRpy({0.0, 0.0, 0.3});
    for (int k = 0; k < 6; ++k) {
      toolpath::PathPose pose;
      pose.id = std::to_string(k);
      pose.workpiece_from_tool = job.base_from_workpiece.inverse() * first;
      pose.workpiece_from_tool.translation() = Vector3d(0.02 * k, 0.01 * k, 0.0);
      job.path.poses.push_back(pose);
    }
    job.load.constant << 300, -200, 150, 0, 0, 0;
    job.joints.start = degrees(20, 10, -20, 50, 60, -30);
  }

  toolpath::CompensatedPath run() const { return toolpath::compensatePath({campaign, geometry, estimate}, job); }
};

// By the test's own kinematics and statics: the arm that its weight bends holds the tool on the path, the process moves
// it by the deflection, and commands under load bring it back.
TEST(CompensatePath, HoldsThePathUnderLoad) {
  KnownPath path;
  path.lab.hook_in_flange = path.job.flange_from_tool.translation();
  const toolpath::CompensatedPath found = path.run();
  ASSERT_EQ(found.poses.size(), path.job.path.poses.size());
  for (std::size_t i = 0; i < found.poses.size(); ++i) {
    const toolpath::CompensatedPathPose& pose = found.poses[i];
    ASSERT_TRUE(pose.compensated.solved) << reports::words(pose.compensated.reason);
    const Eigen::Isometry3d& workpiece = path.job.base_from_workpiece;
    const Eigen::Isometry3d wanted = workpiece * path.job.path.poses[i].workpiece_from_tool;
    const Vector3d force = workpiece.linear() * path.job.load.constant.head<3>();
    const auto toolAt = [&](const JointVector& settled) {
      return Eigen::Isometry3d(path.lab.actual.flangeAt(settled) * path.job.flange_from_tool);
    };
    const JointVector &q = pose.compensated.posture.q, &commands = pose.compensated.commands;
    const Eigen::Isometry3d unloaded = toolAt(path.lab.settled(q)), loaded = toolAt(path.lab.settled(q, force)),
                            back = toolAt(path.lab.settled(commands, force));
    // Ends of iterations at 1e-9 m and rad, two of them.
    EXPECT_LT((unloaded.translation() - wanted.translation()).norm(), 5e-9);
    EXPECT_LT((unloaded.linear() - wanted.linear()).norm(), 5e-9);
    EXPECT_LT((back.translation() - wanted.translation()).norm(), 1e-8);
    EXPECT_LT((back.linear() - wanted.linear()).norm(), 1e-8);
    EXPECT_GT(pose.deflection.shift.norm(), 1e-5);
    EXPECT_LT((workpiece.linear() * pose.deflection.shift - (loaded.translation() - wanted.translation())).norm(),
              1e-8);
    // The offset in the workpiece's axes, by the rigid arm.
    const Eigen::Isometry3d rigid = toolAt(q), sent = toolAt(commands);
    EXPECT_LT((workpiece.linear() * pose.offset.shift - (sent.translation() - rigid.translation())).norm(), 1e-9);
    // It is about the deflection, turned round.
    EXPECT_LT((pose.offset.shift + pose.deflection.shift).norm(), 0.1 * pose.deflection.shift.norm());
  }
}

// Held turned about its axis, the tool takes its axes along, and what is stated in them.
TEST(CompensatePath, AxesOfTheToolTurnWithIt) {
  KnownPath path;
  path.job.turn_free = true;
  path.job.joints.start.reset();
  path.job.load.axes = toolpath::WrenchAxes::tool;
  path.job.load.constant << 300, 0, 0, 0, 0, 0;
  double turned = 0.0;
  for (const toolpath::CompensatedPathPose& pose : path.run().poses) {
    ASSERT_TRUE(pose.joints.reason.empty());
    turned = std::max(turned, std::abs(pose.joints.turn));
    const Vector3d x = pose.joints.base_from_tool.linear().col(0);
    const Vector3d force =
        path.geometry.r0_from_base_link.linear() * path.job.base_from_workpiece.linear() * pose.wrench.force;
    EXPECT_LT((force - 300.0 * x).norm(), 1e-6);
  }
  EXPECT_GT(turned, 0.05);
}

// A torque about the tool's axis and a force at half the depth.
TEST(CompensatePath, MomentsAreAboutTheTip) {
  KnownPath path;
  path.job.load.constant.setZero();
  path.job.load.cutting = toolpath::Cutting{0.5e-3, 10e-3, 10e-3, 20e-3, 1000e6, 0.3, 0.0, false};
  const toolpath::CompensatedPathPose pose = path.run().poses.front();
  const toolpath::ToolWrench at_tip = pose.wrenchAtTip();
  const Vector3d axis = -pose.workpiece_from_tool.col(2);
  EXPECT_LT((at_tip.moment - pose.wrench.moment - (5e-3 * axis).cross(pose.wrench.force)).norm(), 1e-9);
  EXPECT_NEAR(pose.wrench.moment.dot(axis), toolpath::meanCuttingForce(*path.job.load.cutting).torque, 1e-9);
  EXPECT_NEAR(at_tip.force.dot(axis), 0.0, 1e-9);
}

TEST(CompensatePath, RefusalsOfBothKindsAreCounted) {
  KnownPath path;
  path.job.path.poses[2].workpiece_from_tool.translation().x() += 50.0;
  path.estimate.identifiable[0] = false;
  const toolpath::CompensatedPath found = path.run();
  const compensation::CompensationSummary summary = compensation::summaryOf(found.postures());
  EXPECT_EQ(summary.compensated, 0u);
  EXPECT_EQ(reports::summaryWords(summary),
            "0 of 6 postures compensated; 6 refused: 5 because the load turns a joint whose stiffness is not known, 1 "
            "because no joint angles hold the tool there");
}

/// Five-axis milling round an oval of 0.6 x 0.4 m on a part in front of the sample's machine, the tool leaning outward.
toolpath::ToolPath oval(int poses) {
  toolpath::ToolPath path;
  path.turn_free = true;
  Eigen::Matrix3d axes = Eigen::DiagonalMatrix<double, 3>(1.0, -1.0, -1.0).toDenseMatrix();
  for (int k = 0; k < poses; ++k) {
    const double angle = 2.0 * EIGEN_PI * k / poses;
    toolpath::PathPose pose;
    pose.id = std::to_string(k + 1);
    const Vector3d z = -Vector3d(0.17 * std::cos(angle), 0.17 * std::sin(angle), 1.0).normalized();
    axes = Eigen::Quaterniond::FromTwoVectors(axes.col(2), z).toRotationMatrix() * axes;
    pose.workpiece_from_tool.linear() = axes;
    pose.workpiece_from_tool.translation() =
        Vector3d(0.3 * std::cos(angle), 0.2 * std::sin(angle), 0.02 * std::cos(2.0 * angle));
    path.poses.push_back(pose);
  }
  return path;
}

/// A dead force that is the same load as this wrench: a moment across the force moves its line aside.
simulation::DeadForce deadForce(const toolpath::CompensatedPathPose& pose, const toolpath::PathJob& job,
                                const Eigen::Isometry3d& base_from_flange) {
  const Vector3d force = job.base_from_workpiece.linear() * pose.wrench.force,
                 moment = job.base_from_workpiece.linear() * pose.wrench.moment;
  const Vector3d aside = base_from_flange.linear().transpose() * (force.cross(moment) / force.squaredNorm());
  return {job.flange_from_tool * pose.wrench.point_in_tool + aside, force, Vector3d::Zero()};
}

// The sample's true machine, which gives across its axes too and is not known to the identification: its tool's tip
// under the mean forces of milling, with the joint angles of the path and with the commands. STIFFSCOPE_PATH_POSES says
// how many poses.
TEST(CompensatePath, TheSimulatorStaysOnTheMilledPath) {
  const char* const wanted = std::getenv("STIFFSCOPE_PATH_POSES");
  const int poses = wanted != nullptr ? std::atoi(wanted) : 30;
  simulation::SimulationSpec spec = simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
  if (wanted == nullptr) spec.wrist_sweep->readings = 300;
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(spec));
  extended_model::ExtendedModel model =
      extended_model::supportedModel(prepared, prepared.campaign, identification::valuesOnly());
  const identification::Method method = identification::bestMethod(model.with);
  // The day's weights do not turn axis 1: its stiffness is known from elsewhere to 3 %, and off by 2 %.
  const double k1 = *spec.machine.joints[0].torsion;
  const std::vector<campaign::KnownStiffness> known{{0, 1.02 * k1, 0.03 * k1, "elsewhere"}};

  toolpath::PathJob job;
  job.path = oval(poses);
  job.turn_free = true;
  job.base_from_workpiece.translation() << 1.9, 0.1, 0.9;
  job.flange_from_tool.translation() << 0.12, 0.0, 0.3;
  job.flange_from_tool.linear() = robot::rotationFromRpy({0.0, radians(45), 0.0});
  job.load.cutting = toolpath::Cutting{0.5e-3, 4e-3, 15e-3, 20e-3, 1500e6, 0.3, 0.0, false};

  const auto run = [&] {
    const compensation::Certainty certainty = compensation::certaintyOf(model, method, 0.0);
    const effects::EffectDeflection with = extended_model::effectDeflection(model, method);
    return toolpath::compensatePath({model.campaign, model.with.of(method).geometry, model.with.of(method).estimate,
                                     Eigen::Vector3d::Zero(), &with, &certainty},
                                    job);
  };
  // Side forces turn axis 1, and without its stiffness are refused but where the force happens to pass the axis.
  const toolpath::CompensatedPath without = run();
  EXPECT_LT(compensation::summaryOf(without.postures()).compensated, without.poses.size() / 10 + 1);
  for (const toolpath::CompensatedPathPose& pose : without.poses) {
    if (pose.compensated.solved) continue;
    EXPECT_TRUE(pose.compensated.reason.is(compensation::RemarkId::turns_joint_of_unknown_k))
        << reports::words(pose.compensated.reason);
  }
  for (identification::Identification* result : {&model.with, &model.without})
    identification::completeByKnown(known, result->methods[static_cast<std::size_t>(method)].estimate);
  const toolpath::CompensatedPath path = run();

  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  double before = 0.0, after = 0.0, most_before = 0.0, most_after = 0.0, stated = 0.0, longest = 0.0;
  int judged = 0, held = 0;
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const toolpath::CompensatedPathPose& pose = path.poses[i];
    EXPECT_TRUE(pose.compensated.solved) << pose.compensated.posture.id << ": "
                                         << reports::words(pose.compensated.reason);
    if (!pose.compensated.solved) continue;
    const JointVector &q = pose.compensated.posture.q, &commands = pose.compensated.commands;
    if (i > 0) longest = std::max(longest, (q - path.poses[i - 1].compensated.posture.q).cwiseAbs().maxCoeff());
    const simulation::MachineState unloaded = simulation::equilibrium(machine, q);
    const simulation::AppliedLoad load = deadForce(pose, job, unloaded.base_from_flange);
    const simulation::MachineState loaded = simulation::equilibrium(machine, q, load),
                                   commanded = simulation::equilibrium(machine, commands, load);
    ASSERT_TRUE(unloaded.converged && loaded.converged && commanded.converged);
    const Vector3d tip = job.flange_from_tool.translation(), rest = unloaded.base_from_flange * tip;
    const double moved = (loaded.base_from_flange * tip - rest).norm(),
                 left = (commanded.base_from_flange * tip - rest).norm();
    before += moved * moved, after += left * left;
    stated += pose.compensated.tcp.expanded * pose.compensated.tcp.expanded;
    most_before = std::max(most_before, moved), most_after = std::max(most_after, left);
    held += left <= pose.compensated.tcp.expanded;
    ++judged;
  }
  ASSERT_GT(judged, 0);
  std::printf(
      "%d of %zu poses: deviation of the tip %.1f um rms, %.1f at most; with the commands %.1f um rms, %.1f at most; U "
      "%.1f um rms, held in %d; longest step of a joint %.2f deg\n",
      judged, path.poses.size(), 1e6 * std::sqrt(before / judged), 1e6 * most_before, 1e6 * std::sqrt(after / judged),
      1e6 * most_after, 1e6 * std::sqrt(stated / judged), held, longest * 180.0 / std::numbers::pi);
  // k1 alone is 2 % off, and the model leaves of the day some per cent of the deflection.
  EXPECT_LT(after, 0.1 * 0.1 * before);
  // One machine: where its error is within U at one pose it is at nearly all.
  EXPECT_GE(held, 0.9 * judged);
  EXPECT_LT(longest, 0.25);
}

}  // namespace compensate_path_test
}  // namespace stiffscope
