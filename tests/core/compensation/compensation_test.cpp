#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include "core/comparison/deflection_avoided.h"
#include "core/compensation/compensate.h"
#include "core/identification/identify.h"
#include "core/simulation/measure.h"
#include "core/simulation/read_spec.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/known_arm.h"

namespace stiffscope {
namespace compensation_test {

const Eigen::Vector3d kForce{500, -400, -1500};  // N, R0

/// That arm, asked for compensation.
struct AskedArm : KnownArm {
  Eigen::Vector3d tcp{0.0, 0.0, 0.0};

  /// By what the load cell reads under the force, and by the force itself.
  compensation::PostureToCompensate asked(const JointVector& q) const {
    return {"a", q, lab.cellReading(lab.settled(q, kForce), kForce)};
  }
  compensation::PostureToCompensate askedByLoad(const JointVector& q, const Eigen::Vector3d& force) const {
    return {"a", q, Vector6d::Zero(), effects::FlangeLoad{lab.hook_in_flange, force, Eigen::Vector3d::Zero()}};
  }
  compensation::CompensatedPosture run(const compensation::PostureToCompensate& one) const {
    return compensation::compensate(campaign, geometry, estimate, tcp, {one}).front();
  }
};

TEST(Compensate, CommandsBringTheLoadedArmBack) {
  const AskedArm arm;
  Noise noise(4);
  for (int k = 0; k < 6; ++k) {
    const JointVector q = somePosture(noise);
    const compensation::CompensatedPosture found = arm.run(arm.askedByLoad(q, kForce));
    ASSERT_TRUE(found.solved) << reports::words(found.reason);
    const Eigen::Isometry3d wanted = arm.lab.actual.flangeAt(arm.lab.settled(q));
    const Eigen::Isometry3d loaded = arm.lab.actual.flangeAt(arm.lab.settled(q, kForce));
    const Eigen::Isometry3d back = arm.lab.actual.flangeAt(arm.lab.settled(found.commands, kForce));
    // Newton stops at 1e-9 m and rad; the test's own equilibrium settles far below.
    EXPECT_LT((back.translation() - wanted.translation()).norm(), 5e-9);
    EXPECT_LT((back.linear() - wanted.linear()).norm(), 5e-9);
    EXPECT_LT((found.tcp.deflection - (loaded.translation() - wanted.translation())).norm(), 1e-9);
    ASSERT_EQ(found.targets.size(), 3u);
    const Eigen::Vector3d& target = arm.lab.targets_in_flange[1];
    EXPECT_LT((found.targets[1].deflection - (loaded * target - wanted * target)).norm(), 1e-9);
    // Mirrored once, micrometres remain: the second order of deflections of millimetres over metres.
    EXPECT_GT(found.mirrored_remaining, 1e-7);
    EXPECT_LT(found.mirrored_remaining, 0.03 * found.tcp.deflection.norm());
  }
}

// A cell's axes stand as the flange of the loaded arm does: the same load, stated by its direction in R0, deflects the
// arm alike. Five times as soft as the other tests' arm, whose flange turns by so much that a reading directed as the
// unloaded flange stands would be off by the share `turn` of the load.
TEST(Compensate, AReadingIsDirectedAsTheLoadedFlangeStands) {
  AskedArm arm;
  arm.lab.compliance *= 5.0;
  arm.estimate.compliance = arm.lab.compliance;
  Noise noise(5);
  for (int k = 0; k < 4; ++k) {
    const JointVector q = somePosture(noise);
    const compensation::PostureToCompensate by_reading = arm.asked(q);
    const Eigen::Matrix3d unloaded = arm.lab.actual.flangeAt(arm.lab.settled(q)).linear(),
                          loaded = arm.lab.actual.flangeAt(arm.lab.settled(q, kForce)).linear();
    const Eigen::Vector3d force = loaded * arm.lab.flange_from_cell.linear() * by_reading.wrench_in_cell.head<3>();
    const compensation::CompensatedPosture found = arm.run(by_reading), expected = arm.run(arm.askedByLoad(q, force));
    const double turn = Eigen::AngleAxisd(unloaded.transpose() * loaded).angle();
    ASSERT_GT(turn, 5e-3);
    EXPECT_LT((found.tcp.deflection - expected.tcp.deflection).norm(), 1e-6 * expected.tcp.deflection.norm());
    EXPECT_LT((found.rotation - expected.rotation).norm(), 1e-6 * expected.rotation.norm());
  }
}

TEST(Compensate, UncertaintiesAreThoseOfRandomStiffnesses) {
  AskedArm arm;
  const compensation::PostureToCompensate one = arm.asked(degrees(20, 10, -20, 50, 60, -30));
  const compensation::CompensatedPosture stated = arm.run(one);
  Noise noise(8);
  constexpr int kDraws = 2000;
  Eigen::Matrix<double, 9, 1> sum = Eigen::Matrix<double, 9, 1>::Zero(), squares = sum;
  for (int draw = 0; draw < kDraws; ++draw) {
    for (int j = 0; j < 6; ++j) {
      arm.estimate.compliance[j] = arm.lab.compliance[j] * (1.0 + 0.03 * noise.normal());
    }
    const compensation::CompensatedPosture drawn = arm.run(one);
    Eigen::Matrix<double, 9, 1> all;
    all << drawn.tcp.deflection, drawn.rotation, drawn.targets[0].deflection;
    sum += all, squares += all.cwiseAbs2();
  }
  const Eigen::Matrix<double, 9, 1> sd = (squares / kDraws - (sum / kDraws).cwiseAbs2()).cwiseSqrt();
  Eigen::Matrix<double, 9, 1> expected;
  expected << stated.tcp.sd, stated.rotation_sd, stated.targets[0].sd;
  // A standard deviation of 2000 draws is known to 1.6 %; first order neglects about 1 % of K_c: 6 % in all.
  EXPECT_LT((sd.cwiseQuotient(expected).array() - 1.0).abs().maxCoeff(), 0.06) << sd.transpose() << "\n"
                                                                               << expected.transpose();
}

// Moments given in Nmm turn joints by tens of degrees; the right ones by hundredths.
TEST(Compensate, AMomentInNewtonMillimetresIsCautionedOf) {
  const AskedArm arm;
  Noise noise(6);
  compensation::PostureToCompensate asked = arm.asked(somePosture(noise));
  asked.wrench_in_cell.tail<3>() = Eigen::Vector3d(0.0, 0.0, 20.0);
  EXPECT_TRUE(compensation::implausibleCommands({arm.run(asked)}).empty());
  asked.wrench_in_cell.tail<3>() *= 1e3;
  const compensation::CompensatedPosture turned = arm.run(asked);
  ASSERT_TRUE(turned.solved) << reports::words(turned.reason);
  const std::vector<Remark> remarks = compensation::implausibleCommands({turned});
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_TRUE(remarks[0].is(compensation::RemarkId::implausible_command));
  EXPECT_EQ(reports::words(remarks[0]).rfind("posture a would turn joint ", 0), 0u) << reports::words(remarks[0]);
}

TEST(Compensate, RefusesWithTheReason) {
  AskedArm arm;
  const compensation::CompensatedPosture straight = arm.run(arm.asked(degrees(20, 10, -20, 50, 0.1, -30)));
  EXPECT_FALSE(straight.solved);
  EXPECT_TRUE(straight.predicted);
  EXPECT_TRUE(straight.reason.is(compensation::RemarkId::near_singularity)) << reports::words(straight.reason);

  const compensation::PostureToCompensate fine = arm.asked(degrees(20, 10, -20, 50, 60, -30));
  const double command = arm.run(fine).commands[1], middle = 0.5 * (command + fine.q[1]);
  arm.geometry.arm.limits[1] = command > middle ? robot::JointLimits{-6.2, middle} : robot::JointLimits{middle, 6.2};
  const compensation::CompensatedPosture at_limit = arm.run(fine);
  EXPECT_FALSE(at_limit.solved);
  EXPECT_EQ(reports::words(at_limit.reason).rfind("joint 2 would have to go to ", 0), 0u);
  arm.geometry.arm.limits[1] = {-1.0, 0.1};
  EXPECT_EQ(reports::words(arm.run(fine).reason), "joint 2 stands at 10.000 deg, outside its limits -57.3 to 5.7 deg");
  arm.geometry.arm.limits[1] = {-6.2, 6.2};

  // On the second axis's line: its length is the same in every posture.
  robot::Balancer rod;
  const metrology::Line& second = arm.geometry.arm.axes_in_base_at_zero[1];
  rod.from = {1, second.point}, rod.to = {2, second.point + 0.3 * second.direction};
  rod.shortest_m = 0.35;
  arm.geometry.arm.balancers = {rod};
  EXPECT_EQ(reports::words(arm.run(fine).reason), "balancer 1 would be 300.0 mm long, outside its stroke");
  arm.geometry.arm.balancers[0].shortest_m = 0.25;
  EXPECT_TRUE(arm.run(fine).solved);
  arm.geometry.arm.balancers.clear();

  arm.estimate.identifiable[3] = false;
  EXPECT_NE(reports::words(arm.run(fine).reason).find("k4 is not known"), std::string::npos);
  arm.estimate.identifiable[3] = true;
  arm.estimate.compliance[3] *= -1.0;
  EXPECT_NE(reports::words(arm.run(fine).reason).find("k4 came out negative: no spring has that"), std::string::npos);
  arm.estimate.compliance = arm.lab.compliance * 1e4;
  const compensation::CompensatedPosture collapsed = arm.run(fine);
  EXPECT_FALSE(collapsed.predicted);
  EXPECT_TRUE(collapsed.reason.is(compensation::RemarkId::unloaded_arm_does_not_rest));
}

/// How far a machine's reflectors stand from their places unloaded, mean over them.
double meanMove(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
  double sum = 0.0;
  for (std::size_t k = 0; k < from.size(); ++k) sum += (to[k] - from[k]).norm();
  return sum / static_cast<double>(from.size());
}

// The sample's machine gives across its axes too, which the six springs do not know: commands from the
// springs that its campaign shows, put back into the machine.
TEST(Compensate, RemovesInTheSimulatorWhatTheIdentificationClaims) {
  for (const std::string sample : {"inactive", "active"}) {
    simulation::SimulationSpec spec =
        simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/" + sample + ".xml");
    spec.wrist_sweep->readings = 300;  // quicker; the sphere's centre is still known to micrometres
    const campaign::Campaign campaign = simulation::simulate(spec);
    identification::IdentifyOptions options;
    options.subsets.most_all = 1;
    options.subsets.sample = 300;
    const identification::Identification result = identification::identify(campaign, options);
    const identification::MethodResult& method = result.of(identification::Method::decoupled_partial_pose);
    ASSERT_TRUE(method.available) << reports::words(method.reason);
    const auto rows = compensation::compensate(campaign, method.geometry, method.estimate, result.frames.tcp_in_flange,
                                               compensation::campaignPostures(campaign, result.step));
    const simulation::ElasticMachine machine = simulation::buildMachine(spec);
    std::vector<comparison::PostureDeflection> true_moves, claimed;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_TRUE(rows[i].solved) << reports::words(rows[i].reason);
      const simulation::AppliedLoad load =
          simulation::loadAtStep(*spec.loading, result.step, machine.gravity_in_base, {});
      const simulation::MachineState unloaded = simulation::equilibrium(machine, rows[i].posture.q);
      const simulation::MachineState loaded = simulation::equilibrium(machine, rows[i].posture.q, load);
      const simulation::MachineState commanded = simulation::equilibrium(machine, rows[i].commands, load);
      ASSERT_TRUE(unloaded.converged && loaded.converged && commanded.converged);
      true_moves.push_back({rows[i].posture.id, meanMove(unloaded.targets_in_base, loaded.targets_in_base),
                            meanMove(unloaded.targets_in_base, commanded.targets_in_base)});
      claimed.push_back({rows[i].posture.id, result.target_displacement[i], method.target_residual[i]});
    }
    const comparison::DeflectionAvoided removed = comparison::shareAvoided(true_moves),
                                        claim = comparison::shareAvoided(claimed);
    EXPECT_NEAR(claim.share, method.at_targets->all_postures, 1e-9);
    EXPECT_GE(removed.share, claim.low) << sample;
    EXPECT_GE(claim.low, 0.5);  // the claim is no empty one
    EXPECT_LE(removed.share, 1.0);
    std::printf("%s: identification claims %.2f %% (%.2f to %.2f), the commands remove %.2f %%\n", sample.c_str(),
                100.0 * claim.share, 100.0 * claim.low, 100.0 * claim.high, 100.0 * removed.share);
  }
}

}  // namespace compensation_test
}  // namespace stiffscope
