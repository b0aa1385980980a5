#include "core/identification/identify.h"

#include <gtest/gtest.h>
#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/remarks.h"
#include "core/io/input_error.h"
#include "metrology/lines.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/example_arm.h"
#include "tests/fixtures/linear_machine.h"

namespace stiffscope {
namespace identify_test {

/// Few subsets: these tests do not look at them.
identification::IdentifyOptions quick(bool finite_deflection = true) {
  identification::IdentifyOptions options;
  options.finite_deflection = finite_deflection;
  options.subsets.most_all = 1;
  options.subsets.sample = 5;
  return options;
}

const robot::JointMask kWithoutFirst{false, true, true, true, true, true};

TEST(Identify, TheNonlinearEquilibriumGivesTheSpringsBack) {
  // Springs and loads in equilibrium on the moved arm, by the test's iteration. With K_c and Jacobians at the
  // middle what is left is of the third order of turns of 1e-3 to 1e-2 rad; neglected, it is of the first.
  const SimulatedLab lab = springyLab();
  const campaign::Campaign campaign = fullDay(lab, pulledForce);
  const identification::Identification found = identification::identify(campaign, quick());
  for (const identification::Method method : identification::kMethods) {
    ASSERT_TRUE(found.of(method).available) << reports::words(found.of(method).reason);
    EXPECT_LT(worstError(found.of(method).estimate.compliance, lab.compliance), 1e-4) << static_cast<int>(method);
    EXPECT_GT(found.of(method).at_wrist->all_postures, 0.999);
    EXPECT_GT(found.of(method).at_targets->all_postures, 0.999);
  }
  EXPECT_GT(found.geometric_stiffness_share, 1e-4);
  const identification::Identification neglected = identification::identify(campaign, quick(false));
  EXPECT_GT(worstError(neglected.of(identification::Method::partial_pose).estimate.compliance, lab.compliance), 5e-4);
}

TEST(Identify, OwnWeightAndSpringsAreFoundInTurns) {
  SimulatedLab lab;
  lab.compliance = exampleCompliance();
  const identification::Identification found = identification::identify(fullDay(lab, pulledForce), quick());
  EXPECT_TRUE(found.frames.sag_removed);
  for (const identification::Method method : identification::kMethods) {
    ASSERT_TRUE(found.of(method).available) << reports::words(found.of(method).reason);
    EXPECT_LT(worstError(found.of(method).estimate.compliance, lab.compliance), 3e-4) << static_cast<int>(method);
  }
}

TEST(Identify, AnArmWithGeometryErrorsGivesItsSpringsBack) {
  SimulatedLab lab = springyLab();
  Noise noise(32);
  const ChainArm disturbed = lab.nominal.disturbed(noise, 1e-3, 1e-3);
  for (std::size_t j = 0; j < 4; ++j) lab.actual.to_joint[j] = disturbed.to_joint[j];  // the wrist's axes still meet
  const identification::Identification found = identification::identify(fullDay(lab, pulledForce, 14), quick());
  for (const identification::Method method : identification::kMethods) {
    ASSERT_TRUE(found.of(method).available) << reports::words(found.of(method).reason);
    EXPECT_LT(worstError(found.of(method).estimate.compliance, lab.compliance), 2e-4) << static_cast<int>(method);
  }
}

TEST(Identify, AWristWhoseAxesMissEachOtherRefusesTheDecoupled) {
  SimulatedLab lab = springyLab();
  lab.actual.to_joint[5].translation().z() += 0.03;  // axis 6 passes axis 5 by 30 mm
  const identification::Identification found = identification::identify(fullDay(lab, pulledForce), quick());
  EXPECT_TRUE(found.of(identification::Method::partial_pose).available);
  const identification::MethodResult& decoupled = found.of(identification::Method::decoupled_partial_pose);
  EXPECT_FALSE(decoupled.available);
  EXPECT_FALSE(decoupled.reason.empty());
  // And one that misses by a hundredth of a millimetre does not.
  lab.actual.to_joint[5].translation().z() = 1e-5;
  EXPECT_TRUE(identification::identify(fullDay(lab, pulledForce), quick())
                  .of(identification::Method::decoupled_partial_pose)
                  .available);
}

TEST(Identify, AHangingLoadSaysNothingOfJointOne) {
  const SimulatedLab lab = springyLab();
  const identification::Identification found = identification::identify(fullDay(lab, hangingForce), quick());
  EXPECT_TRUE(found.identifiability.load_hangs);
  EXPECT_FALSE(found.identifiability.joints[0].identifiable);
  EXPECT_TRUE(found.identifiability.joints[0].reason.is(identification::RemarkId::load_hangs));
  for (const identification::Method method : identification::kMethods) {
    ASSERT_TRUE(found.of(method).available) << reports::words(found.of(method).reason);
    EXPECT_EQ(found.of(method).estimate.compliance[0], 0.0);
    EXPECT_LT(worstError(found.of(method).estimate.compliance, lab.compliance, kWithoutFirst), 1e-4);
  }
}

TEST(Identify, ALoadCellTwoDegreesAskewGivesNoFirstJointEither) {
  // The readings are of a cell turned by 2 degrees about an oblique axis; the campaign does not know.
  for (const int axis : {0, 1, 2}) {
    SimulatedLab lab = springyLab();
    const Eigen::Isometry3d declared = lab.flange_from_cell;
    lab.flange_from_cell.rotate(Eigen::AngleAxisd(radians(2.0), Eigen::Vector3d::Unit(axis)));
    campaign::Campaign campaign = fullDay(lab, hangingForce, 19);
    campaign.load_cell->parent_from_cell = declared;
    const identification::Identification found = identification::identify(campaign, quick());
    EXPECT_TRUE(found.identifiability.load_hangs);
    EXPECT_FALSE(found.identifiability.joints[0].identifiable) << axis;
    EXPECT_EQ(found.of(identification::Method::partial_pose).estimate.compliance[0], 0.0);
  }
}

TEST(Identify, APulledLoadShowsJointOne) {
  EXPECT_TRUE(
      identification::identify(fullDay(springyLab(), pulledForce), quick()).identifiability.joints[0].identifiable);
}

TEST(Identify, WithoutWristSweepTheDecoupledSaysWhatToMeasure) {
  const SimulatedLab lab = springyLab();
  campaign::Campaign campaign = fullDay(lab, pulledForce);
  campaign.wrist_sweep.reset();
  const identification::Identification found = identification::identify(campaign, quick());
  EXPECT_TRUE(found.of(identification::Method::complete_pose).available);
  EXPECT_TRUE(found.of(identification::Method::partial_pose).available);
  EXPECT_FALSE(found.of(identification::Method::decoupled_partial_pose).available);
  EXPECT_NE(reports::words(found.of(identification::Method::decoupled_partial_pose).reason).find("wrist sweep"),
            std::string::npos);
  EXPECT_FALSE(found.of(identification::Method::partial_pose).at_wrist);
}

TEST(Identify, WithoutAnySweepPartialPoseCalibratesItsBaseFromThePostures) {
  const SimulatedLab lab = springyLab();
  campaign::Campaign campaign = lab.empty();
  lab.addLoading(campaign, 16, pulledForce);
  const identification::Identification found = identification::identify(campaign, quick());
  ASSERT_TRUE(found.of(identification::Method::partial_pose).available)
      << reports::words(found.of(identification::Method::partial_pose).reason);
  EXPECT_LT(worstError(found.of(identification::Method::partial_pose).estimate.compliance, lab.compliance), 2e-4);
  EXPECT_FALSE(found.of(identification::Method::complete_pose).available);
  EXPECT_NE(reports::words(found.of(identification::Method::complete_pose).reason).find("circle sweeps"),
            std::string::npos);
}

TEST(Identify, WithoutAnySweepTheOwnWeightIsTakenIntoAccountToo) {
  // The sag of millimetres must not be taken for geometry: springs and calibration are found in turns.
  SimulatedLab lab;
  lab.compliance = exampleCompliance();
  campaign::Campaign campaign = lab.empty();
  lab.addLoading(campaign, 25, pulledForce);
  const identification::Identification found = identification::identify(campaign, quick());
  ASSERT_TRUE(found.of(identification::Method::partial_pose).available)
      << reports::words(found.of(identification::Method::partial_pose).reason);
  EXPECT_LT(found.calibration.rms_after, 1e-6);
  EXPECT_LT(worstError(found.of(identification::Method::partial_pose).estimate.compliance, lab.compliance), 3e-4);
}

TEST(Identify, DisplacementsInTheRobotsAxes) {
  // One point of known place, displacements only, no sweep: Partial Pose alone, and says of the others why
  // not. The wrench is read in axes that turn with the flange by some milliradians, which only the model
  // knows.
  SimulatedLab lab = springyLab();
  campaign::Campaign campaign = lab.empty();
  lab.addLoading(campaign, 16, pulledForce);
  campaign.targets.resize(1);
  campaign.targets[0].position_in_flange = lab.targets_in_flange[0];
  campaign.displacements = campaign::Displacements{"displacements.csv", campaign::PointFrame::base_link, {}};
  for (std::size_t row = 0; row + 1 < campaign.loading->rows.size(); row += 2) {
    const campaign::LoadingReading &before = campaign.loading->rows[row], &after = campaign.loading->rows[row + 1];
    if (before.target != 0) continue;
    campaign.displacements->rows.push_back(
        {before.pose, 1, 0, lab.tracker_from_base.linear().transpose() * (after.point - before.point)});
  }
  campaign.loading.reset();
  const identification::Identification found = identification::identify(campaign, quick());
  ASSERT_TRUE(found.of(identification::Method::partial_pose).available)
      << reports::words(found.of(identification::Method::partial_pose).reason);
  EXPECT_LT(worstError(found.of(identification::Method::partial_pose).estimate.compliance, lab.compliance), 1e-4);
  EXPECT_FALSE(found.of(identification::Method::complete_pose).available);
  EXPECT_FALSE(found.of(identification::Method::decoupled_partial_pose).available);
  EXPECT_FALSE(found.noise);
}

TEST(Identify, DisplacementsInTheTrackersAxesNeedSweeps) {
  SimulatedLab lab = springyLab();
  campaign::Campaign campaign = lab.empty();
  lab.addLoading(campaign, 16, pulledForce);
  campaign.displacements = campaign::Displacements{"displacements.csv", campaign::PointFrame::tracker, {}};
  for (std::size_t k = 0; k < 3; ++k) campaign.targets[k].position_in_flange = lab.targets_in_flange[k];
  for (std::size_t row = 0; row + 1 < campaign.loading->rows.size(); row += 2) {
    const campaign::LoadingReading &before = campaign.loading->rows[row], &after = campaign.loading->rows[row + 1];
    campaign.displacements->rows.push_back({before.pose, 1, before.target, after.point - before.point});
  }
  campaign.loading.reset();
  const identification::Identification lost = identification::identify(campaign, quick());
  EXPECT_FALSE(lost.of(identification::Method::partial_pose).available);
  EXPECT_FALSE(lost.of(identification::Method::partial_pose).reason.empty());
  lab.addCircleSweeps(campaign);
  const identification::Identification found = identification::identify(campaign, quick());
  ASSERT_TRUE(found.of(identification::Method::partial_pose).available)
      << reports::words(found.of(identification::Method::partial_pose).reason);
  EXPECT_LT(worstError(found.of(identification::Method::partial_pose).estimate.compliance, lab.compliance), 1e-4);
}

TEST(Identify, AReflectorMissingInSomePostures) {
  // Complete Pose and Decoupled need three; Partial Pose takes what is there.
  const SimulatedLab lab = springyLab();
  campaign::Campaign campaign = fullDay(lab, pulledForce);
  std::erase_if(campaign.loading->rows,
                [](const campaign::LoadingReading& row) { return row.pose == 3 && row.target == 1; });
  const identification::Identification found = identification::identify(campaign, quick());
  ASSERT_TRUE(found.of(identification::Method::partial_pose).available)
      << reports::words(found.of(identification::Method::partial_pose).reason);
  EXPECT_LT(worstError(found.of(identification::Method::partial_pose).estimate.compliance, lab.compliance), 1e-4);
  for (const identification::Method method :
       {identification::Method::complete_pose, identification::Method::decoupled_partial_pose}) {
    if (found.of(method).available) {
      EXPECT_LT(worstError(found.of(method).estimate.compliance, lab.compliance), 1e-3);
    } else {
      EXPECT_NE(reports::words(found.of(method).reason).find("every posture"), std::string::npos)
          << reports::words(found.of(method).reason);
    }
  }
}

TEST(Identify, FiveReflectors) {
  SimulatedLab lab = springyLab();
  lab.targets_in_flange.push_back({0.1, 0.2, 0.3});
  lab.targets_in_flange.push_back({-0.2, -0.1, 0.0});
  const identification::Identification found = identification::identify(fullDay(lab, pulledForce), quick());
  for (const identification::Method method : identification::kMethods) {
    ASSERT_TRUE(found.of(method).available) << reports::words(found.of(method).reason);
    EXPECT_LT(worstError(found.of(method).estimate.compliance, lab.compliance), 1e-4);
  }
}

TEST(Identify, OnePostureOnly) {
  // Never a crash, never a number that is none, and no confident answer.
  const SimulatedLab lab = springyLab();
  const identification::Identification found = identification::identify(fullDay(lab, pulledForce, 1), quick());
  for (const identification::Method method : identification::kMethods) {
    const identification::MethodResult& result = found.of(method);
    if (!result.available) {
      EXPECT_FALSE(result.reason.empty());
      continue;
    }
    EXPECT_TRUE(result.estimate.compliance.allFinite());
    EXPECT_TRUE(result.estimate.covariance.array().isNaN().all());  // one posture has no scatter: nothing is stated
    EXPECT_TRUE(result.subsets.compliances.empty());
  }
}

TEST(Identify, ThrowsWhereThereAreNoLoadStates) {
  const SimulatedLab lab = springyLab();
  campaign::Campaign campaign = lab.empty();
  lab.addCircleSweeps(campaign);
  EXPECT_THROW(identification::identify(campaign, quick()), io::InputError);
  campaign = fullDay(lab, pulledForce, 3);
  identification::IdentifyOptions options = quick();
  options.step = 7;
  try {
    identification::identify(campaign, options);
    FAIL() << "step 7 was taken";
  } catch (const io::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'7': not a load step of this campaign, which has 1"), std::string::npos)
        << error.what();
  }
}

TEST(Identify, SweepsAloneGiveFramesAndSayWhatIsMissing) {
  const SimulatedLab lab = springyLab();
  campaign::Campaign campaign = lab.empty();
  lab.addCircleSweeps(campaign);
  const identification::Identification result = identification::framesAlone(campaign);
  EXPECT_TRUE(result.frames.arm.points_placed);
  EXPECT_TRUE(result.cases.empty());
  for (const identification::MethodResult& method : result.methods) {
    EXPECT_FALSE(method.available);
    EXPECT_TRUE(method.reason.is(identification::RemarkId::no_states)) << reports::words(method.reason);
  }
}

TEST(WristLeak, OnlyWhatJointsFourToSixPutThere) {
  // P_wrist moves by 2 mm; joint 5 turns by 1 mrad, and P_wrist stands on its axis, or 0.1 m off it.
  identification::LoadedArm arm;
  arm.geometry.arm = exampleArm();
  identification::LoadCase load_case;
  load_case.q = load_case.q_sagged = JointVector::Zero(6);
  load_case.axes = robot::axesAt(arm.geometry.arm, robot::postureAt(arm.geometry.arm, load_case.q));
  arm.cases = {load_case};
  arm.wrist = {{Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 0, 2e-3)}};
  arm.torques = {JointVector::Constant(6, 1000.0)};
  const metrology::Line& axis = arm.geometry.arm.axes_in_base_at_zero[4];
  Eigen::Vector3d across, other;
  metrology::basisAcross(axis.direction, across, other);
  JointVector compliance = JointVector::Constant(6, 1e-6);
  compliance[3] = compliance[5] = 0.0;  // joint 5 alone: 1e-6 rad/Nm times 1000 Nm turns it by 1 mrad
  EXPECT_NEAR(identification::wristLeak(arm, axis.point, compliance), 0.0, 1e-12);  // on the axis: rounding
  // 1 mrad over 0.1 m is 0.1 mm of 2 mm.
  EXPECT_NEAR(identification::wristLeak(arm, axis.point + 0.1 * across, compliance), 0.05, 1e-9);
}

TEST(JudgeJoints, AJointSeenOnlyInCombination) {
  // Joint 5 straight in every posture: axes 4 and 6 fall together, and so do their columns.
  LinearMachine machine(0, 1.0);
  Noise noise(4);
  for (int i = 0; i < 10; ++i) {
    JointVector q = somePosture(noise);
    q[4] = 0.0;
    machine.add(q, 1000.0 * noise.normal3(), 200.0 * noise.normal3());
  }
  const campaign::LoadCell cell{"tool0", Eigen::Isometry3d::Identity(), {}, 1.0, 0.3};
  const identification::Identifiability found =
      identification::evaluateIdentifiability(machine.geometry, machine.cases, cell, machine.reflectorEquations());
  EXPECT_EQ(found.mask(), (robot::JointMask{true, true, true, false, true, false}));
  for (const std::size_t joint : {3u, 5u}) {
    EXPECT_NE(reports::words(found.joints[joint].reason).find("combination of joints 4, 6"), std::string::npos)
        << reports::words(found.joints[joint].reason);
    // One axis for both: what the load turns is their sum.
    EXPECT_NE(reports::words(found.joints[joint].reason).find("only 1/k4 + 1/k6 is determined"), std::string::npos)
        << reports::words(found.joints[joint].reason);
  }
}

TEST(JudgeJoints, PointsOnAnAxisDoNotShowIt) {
  // One reflector on axis 6, or a tenth of a millimetre beside it, which is less than the axis is known to:
  // the load turns joint 6 well, but nothing that is measured moves by it.
  const campaign::LoadCell cell{"tool0", Eigen::Isometry3d::Identity(), {}, 1.0, 0.3};
  for (const double beside : {0.0, 1e-4}) {
    LinearMachine machine(0, 1.0);
    machine.targets_in_flange = {{beside, 0.0, 0.2}};
    Noise noise(4);
    for (int i = 0; i < 10; ++i) machine.add(somePosture(noise), 1000.0 * noise.normal3(), 200.0 * noise.normal3());
    const identification::Identifiability found =
        identification::evaluateIdentifiability(machine.geometry, machine.cases, cell, machine.reflectorEquations());
    EXPECT_EQ(found.mask(), (robot::JointMask{true, true, true, true, true, false})) << beside;
    EXPECT_TRUE(found.joints[5].reason.is(identification::RemarkId::points_on_axis))
        << reports::words(found.joints[5].reason);
  }
}

TEST(JudgeJoints, ATorqueBelowItsUncertaintyDoesNotCount) {
  LinearMachine machine(10, 1.0);
  const campaign::LoadCell vague{"tool0", Eigen::Isometry3d::Identity(), {}, 0.0, 1e5};  // a moment known to 1e5 Nm
  const identification::Identifiability found =
      identification::evaluateIdentifiability(machine.geometry, machine.cases, vague, machine.reflectorEquations());
  EXPECT_EQ(found.mask(), robot::JointMask(6, false));
  EXPECT_TRUE(found.joints[2].reason.is(identification::RemarkId::load_turns_too_little));
}

}  // namespace identify_test
}  // namespace stiffscope
