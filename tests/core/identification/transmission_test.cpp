#include "core/identification/transmission.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include "core/frames/frames.h"
#include "core/identification/identify.h"
#include "core/identification/motor_side.h"
#include "core/identification/remarks.h"
#include "core/simulation/measure.h"
#include "core/simulation/read_spec.h"
#include "tests/fixtures/chain_arm.h"
#include "tests/fixtures/example_arm.h"

namespace stiffscope {
namespace transmission_test {

using identification::RemarkId;

constexpr double kDeg = std::numbers::pi / 180.0;

/// No state yet: the robot, its tool's load cell at the flange with axes of base_link, and nothing that was read.
campaign::Campaign dayOf(const robot::Robot& arm) {
  campaign::Campaign campaign;
  campaign.robot = arm;
  campaign.base_link = "base_link", campaign.flange_link = "tool0";
  campaign.load_cell.emplace();
  campaign.load_cell->parent = "tool0";
  campaign.load_cell->axes_link = "base_link";
  campaign.states.emplace();
  return campaign;
}

identification::Transmission measured(const campaign::Campaign& campaign) {
  const frames::Frames frames = frames::measureFrames(campaign);
  const JointVector rigid = JointVector::Zero(6);
  return identification::measureTransmission(campaign, frames::sweptGeometry(campaign, frames, rigid), rigid);
}

campaign::State stateOf(int pose, int step, const JointVector& q, const Eigen::Vector3d& force) {
  campaign::State state(6);
  state.pose = pose, state.step = step, state.q = q;
  state.wrench_in_cell.head<3>() = force;
  return state;
}

TEST(Transmission, ByHandAtAllJointsZero) {
  // exampleArm, weightless. Axis 2: +y through (0.41, 0, 0.94); axis 3: -y through (0.41, 0, 2.06); the force acts at
  // the flange, (1.995, 0, 2.31). F down: y . (r x F) = 1.585 F about axis 2 and -1.585 F about axis 3. F along -x adds
  // y . (r x F) = -1.37 F and, about axis 3, +0.25 F.
  robot::Robot arm = exampleArm();
  for (robot::BodyMass& body : arm.bodies) body.mass_kg = 0.0;
  campaign::Campaign campaign = dayOf(arm);
  const double c2 = 1.0 / 4e6, c3 = 1.0 / 5e6;
  for (int pose = 0; pose < 4; ++pose) {
    campaign.pose_ids.push_back(std::to_string(pose));
    for (int step = 0; step < 3; ++step) {
      const double down = 500.0 * step, back = 100.0 * pose * step;
      campaign::State state = stateOf(pose, step, JointVector::Zero(6), {-back, 0, -down});
      const double tau2 = 1.585 * down - 1.37 * back, tau3 = -1.585 * down + 0.25 * back;
      state.extras().motor_side[1] = -c2 * tau2 - 1e-4;
      state.extras().motor_side[2] = -c3 * tau3 + 2e-4;
      campaign.states->rows.push_back(state);
    }
  }
  const identification::Transmission found = measured(campaign);
  ASSERT_TRUE(found.joints[1].measured && found.joints[2].measured);
  EXPECT_NEAR(found.estimate.stiffness(1), 4e6, 1.0);
  EXPECT_NEAR(found.estimate.stiffness(2), 5e6, 1.0);
  EXPECT_EQ(found.joints[1].held, identification::HeldSide::link);
  EXPECT_NEAR(found.joints[1].offset, 1e-4, 1e-10);
  EXPECT_NEAR(found.joints[2].offset, -2e-4, 1e-10);
  EXPECT_EQ(found.joints[1].states, 12);
  EXPECT_EQ(found.joints[1].postures, 4);
  EXPECT_TRUE(found.joints[0].reason.is(RemarkId::no_second_encoder));
  ASSERT_EQ(found.points.size(), 24u);
  EXPECT_NEAR(found.points[1].torque, 1.585 * 500.0, 1e-9);
}

/// A day of ChainArm, whose statics are its own: two encoders on joints 2 to 6, the link side held or the motor's.
struct ChainDay {
  ChainArm arm = exampleChain();
  JointVector gear = (Vector6d() << 0.0, 2e-7, 1.6e-7, 2e-6, 3e-6, 1.2e-5).finished();
  JointVector offset = (Vector6d() << 0, 1e-3, -2e-3, 3e-3, 1e-4, 0).finished();
  double lost_motion = 0.0;  ///< of joint 3
  bool link_held = true;

  campaign::Campaign campaign(double noise = 0.0, std::uint64_t seed = 1) const {
    campaign::Campaign day = dayOf(arm.robot());
    const Eigen::Vector3d hook(0.1, 0.06, 0.2);  // beside axis 6, or the load would not turn it
    day.load_cell->parent_from_cell.translation() = hook;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int pose = 0; pose < 24; ++pose) {
      day.pose_ids.push_back(fmt::format("P{}", pose));
      JointVector q(6);
      for (int j = 0; j < 6; ++j) q[j] = (j < 3 ? 0.6 : 1.2) * uniform(random);
      const Eigen::Vector3d pull = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
      for (int step = 0; step < 4; ++step) {
        // Up to 8 kN: the load turns joint 3 round against its own weight in some of the postures.
        const Eigen::Vector3d force = (step == 3 ? 0.0 : 4000.0 * step) * pull;
        const Eigen::Vector3d point = arm.flangeAt(q) * hook;
        const JointVector load = arm.torqueOf(q, 6, point, force, Eigen::Vector3d::Zero());
        const JointVector whole = load + arm.weightTorque(q);
        JointVector ahead = gear.cwiseProduct(whole);
        if (lost_motion > 0.0) ahead[2] += std::copysign(0.5 * lost_motion, whole[2]);
        const JointVector rest = gear.cwiseProduct(arm.weightTorque(q));
        campaign::State state = stateOf(pose, step, q, force);
        if (!link_held) state.q += ahead - rest;
        for (int j = 1; j < 6; ++j)
          state.extras().motor_side[j] = state.q[j] - ahead[j] - offset[j] + noise * normal(random);
        day.states->rows.push_back(state);
      }
    }
    return day;
  }
};

TEST(Transmission, GivesBackCompliancesAndZerosOfAHeavyArm) {
  const ChainDay day;
  const identification::Transmission found = measured(day.campaign());
  for (int j = 1; j < 6; ++j) {
    const auto at = static_cast<std::size_t>(j);
    ASSERT_TRUE(found.joints[at].measured) << j;
    EXPECT_NEAR(found.estimate.compliance[j] / day.gear[j], 1.0, 1e-8) << j;
    EXPECT_NEAR(found.joints[at].offset, day.offset[j], 1e-9) << j;
    EXPECT_FALSE(found.joints[at].offset_holds_weight);
    EXPECT_EQ(found.joints[at].held, identification::HeldSide::link);
    EXPECT_EQ(found.joints[at].left_out, 0);
  }
}

TEST(Transmission, SeesWhichSideIsHeldWhateverIsDeclared) {
  ChainDay day;
  day.link_held = false;
  campaign::Campaign campaign = day.campaign();
  campaign.double_encoder = campaign::DoubleEncoder::active;
  const identification::Transmission found = measured(campaign);
  for (int j = 1; j < 6; ++j) {
    const identification::GearTorsion& joint = found.joints[static_cast<std::size_t>(j)];
    EXPECT_EQ(joint.held, identification::HeldSide::motor) << j;
    EXPECT_TRUE(joint.caution.is(RemarkId::loop_not_as_declared)) << j;
    // The angles that the torques are taken at move by the wind-up, a thousandth.
    EXPECT_NEAR(found.estimate.compliance[j] / day.gear[j], 1.0, 5e-3) << j;
    EXPECT_NEAR(joint.link_turn / day.gear[j], 1.0, 5e-3) << j;
  }
  campaign.double_encoder = campaign::DoubleEncoder::inactive;
  EXPECT_TRUE(measured(campaign).joints[2].caution.empty());
}

TEST(Transmission, ReferredToTheMotorsAnglesStandStillAndTheGearsStay) {
  ChainDay day;
  day.link_held = false;
  const campaign::Campaign read = day.campaign();
  const campaign::Campaign referred = identification::referredToMotors(read);
  for (const campaign::State& row : referred.states->rows) {
    const campaign::State& first = read.states->rows[static_cast<std::size_t>(4 * row.pose)];
    // The motor stands behind the unloaded link by what the own weight winds up, by the arm's own statics; the
    // encoders' zero is known as well as the gears, 5e-3 of some milliradians.
    const JointVector motor = first.q - day.gear.cwiseProduct(day.arm.weightTorque(first.q));
    EXPECT_LT((row.q - motor).cwiseAbs().maxCoeff(), 6e-5);
    EXPECT_EQ(row.extras().link_side[2], read.states->rows[static_cast<std::size_t>(4 * row.pose + row.step)].q[2]);
    EXPECT_TRUE(std::isnan(row.extras().link_side[0]));
  }
  const identification::Transmission before = measured(read), after = measured(referred);
  for (int j = 1; j < 6; ++j) {
    EXPECT_EQ(after.joints[static_cast<std::size_t>(j)].held, identification::HeldSide::motor);
    EXPECT_NEAR(after.estimate.compliance[j] / before.estimate.compliance[j], 1.0, 1e-2) << j;
  }
  // A day whose link side is held stays as it is.
  day.link_held = true;
  const campaign::Campaign held = day.campaign();
  const campaign::Campaign same = identification::referredToMotors(held);
  for (std::size_t i = 0; i < held.states->rows.size(); ++i) {
    EXPECT_EQ(same.states->rows[i].q, held.states->rows[i].q);
    EXPECT_TRUE(same.states->rows[i].extras().link_side.array().isNaN().all());
  }
}

/// Each gear is a line of its own: three postures give each an interval, however many gears there are.
TEST(Transmission, FewPosturesGiveEveryGearItsInterval) {
  const ChainDay day;
  campaign::Campaign few = day.campaign(2e-6);
  few.pose_ids.resize(3);
  std::erase_if(few.states->rows, [](const campaign::State& row) { return row.pose >= 3; });
  const identification::Transmission found = measured(few);
  for (int j = 1; j < 6; ++j) {
    ASSERT_TRUE(found.joints[static_cast<std::size_t>(j)].measured) << j;
    EXPECT_GT(found.estimate.covariance(j, j), 0.0) << j;
    const identification::CoverageInterval interval = identification::complianceInterval(found.estimate, j);
    EXPECT_TRUE(std::isfinite(interval.low) && std::isfinite(interval.high)) << j;
  }
}

/// A motor that was held during a sweep stood, though the URDF's masses leave some of its wind-up; one that moved by
/// more than that did not.
TEST(Transmission, HeldMotorsStandInASweepWhateverTheMassesSay) {
  ChainDay day;
  day.link_held = false;
  campaign::Campaign read = day.campaign();
  read.circle_sweeps = campaign::CircleSweeps{"circle_sweeps.csv", campaign::PointFrame::tracker, {}};
  for (int axis = 1; axis < 6; ++axis) {
    for (int stop = 0; stop < 7; ++stop) {
      JointVector motor = (Vector6d() << 0.0, 0.1, 0.2, 0.1, -0.2, 0.1).finished();
      motor[axis] += 0.3 * (stop - 3);
      JointVector q = motor;
      for (int round = 0; round < 5; ++round) q = motor + day.gear.cwiseProduct(day.arm.weightTorque(q));
      read.circle_sweeps->rows.push_back({axis, std::to_string(stop), 0, q, campaign::kNotGiven, {}});
    }
  }
  const auto moved = [](const campaign::Campaign& campaign) {
    double most = 0.0;
    for (const campaign::CircleReading& row : campaign.circle_sweeps->rows) {
      const campaign::CircleReading& first =
          *std::find_if(campaign.circle_sweeps->rows.begin(), campaign.circle_sweeps->rows.end(),
                        [&](const campaign::CircleReading& one) { return one.axis == row.axis; });
      for (int j = 0; j < 6; ++j) {
        if (j != row.axis) most = std::max(most, std::abs(row.q[j] - first.q[j]));
      }
    }
    return most;
  };
  constexpr double kSeen = 1e-4;  // of which the controllers' resolution is a tenth
  ASSERT_GT(moved(read), kSeen);
  campaign::Campaign heavier = read;
  for (robot::BodyMass& body : heavier.robot.bodies) body.mass_kg *= 1.1;
  EXPECT_LT(moved(identification::referredToMotors(heavier)), frames::kStandsStill);
  campaign::Campaign drifted = heavier;
  drifted.circle_sweeps->rows[3].q[2] += 1e-3;  // of axis 2's sweep
  EXPECT_GT(moved(identification::referredToMotors(drifted)), 0.9e-3);
}

TEST(Transmission, LostMotionStandsApartFromTheCompliance) {
  ChainDay day;
  day.lost_motion = 3e-4;
  const identification::Transmission found = measured(day.campaign());
  ASSERT_TRUE(found.joints[2].lost_motion.has_value());
  EXPECT_NEAR(found.joints[2].lost_motion->width, 3e-4, 1e-9);
  EXPECT_NEAR(found.estimate.compliance[2] / day.gear[2], 1.0, 1e-6);
  EXPECT_EQ(found.joints[2].left_out, 0);
}

TEST(Transmission, WrongReadingsAreLeftOutAndCounted) {
  const ChainDay day;
  constexpr double kNoise = 2e-6;
  campaign::Campaign campaign = day.campaign(kNoise);
  const identification::Transmission clean = measured(campaign);
  campaign.states->rows[6].extras().motor_side[3] += 0.3 * kDeg;
  campaign.states->rows[13].extras().motor_side[3] -= 0.1 * kDeg;
  const identification::Transmission found = measured(campaign);
  EXPECT_EQ(clean.joints[3].left_out, 0);
  EXPECT_EQ(found.joints[3].left_out, 2);
  EXPECT_EQ(found.joints[4].left_out, 0);
  const double sd = std::sqrt(clean.estimate.covariance(3, 3));
  EXPECT_NEAR(found.estimate.compliance[3], clean.estimate.compliance[3], 1.5 * sd);
}

TEST(Transmission, SaysWhyAJointIsNotMeasured) {
  const ChainDay day;
  campaign::Campaign campaign = day.campaign();
  for (campaign::State& state : campaign.states->rows) {
    state.extras().motor_side[1] = state.q[1];                               // a copy
    state.extras().motor_side[2] = -state.q[2] - 0.2;                        // the other sense
    if (state.pose > 1) state.extras().motor_side[3] = campaign::kNotGiven;  // blank but for two postures
  }
  const identification::Transmission found = measured(campaign);
  EXPECT_TRUE(found.joints[1].reason.is(RemarkId::no_second_encoder));
  EXPECT_TRUE(found.joints[2].reason.is(RemarkId::encoders_apart));
  EXPECT_TRUE(found.joints[3].reason.is(RemarkId::too_few_encoder_postures));
  EXPECT_TRUE(found.joints[4].measured && found.joints[5].measured);
  for (campaign::State& state : campaign.states->rows) state.wrench_in_cell.setZero();
  EXPECT_TRUE(measured(campaign).joints[4].reason.is(RemarkId::no_loaded_state));
  for (campaign::State& state : campaign.states->rows) state.extras().motor_side.setConstant(campaign::kNotGiven);
  EXPECT_FALSE(identification::hasSecondEncoders(campaign));
}

TEST(Transmission, StructureIsTheDifferenceWhereBothAreInSeries) {
  identification::Transmission gears;
  gears.joints.resize(6);
  gears.estimate = identification::StiffnessEstimate(6);
  gears.estimate.compliance[1] = 2e-7;
  gears.estimate.covariance(1, 1) = 9e-18;  // u 3e-9
  gears.estimate.scatter_dof[1] = 1e6;
  gears.estimate.identifiable[1] = gears.joints[1].measured = true;
  identification::StiffnessEstimate tracker(6);
  tracker.compliance[1] = 3e-7;
  tracker.covariance(1, 1) = 16e-18;  // u 4e-9
  tracker.scatter_dof[1] = 1e6;
  tracker.identifiable[1] = true;

  EXPECT_FALSE(identification::gearAndStructure(gears, tracker, 1).has_value());  // nobody knows what is held
  gears.joints[1].held = identification::HeldSide::motor;
  auto apart = identification::gearAndStructure(gears, tracker, 1);
  ASSERT_TRUE(apart.has_value());
  EXPECT_NEAR(apart->structure, 1e-7, 1e-20);
  EXPECT_NEAR(apart->sd, 5e-9, 1e-20);
  EXPECT_NEAR(apart->interval.low, 1e-7 - 1.96 * 5e-9, 1e-11);
  EXPECT_NEAR(apart->gear_share, 2.0 / 3.0, 1e-12);
  EXPECT_EQ(apart->agreement, identification::GearAgreement::structure_seen);
  tracker.compliance[1] = 2.05e-7;
  EXPECT_EQ(identification::gearAndStructure(gears, tracker, 1)->agreement, identification::GearAgreement::gear_alone);
  tracker.compliance[1] = 1.5e-7;
  EXPECT_EQ(identification::gearAndStructure(gears, tracker, 1)->agreement, identification::GearAgreement::contradicts);
  gears.joints[1].held = identification::HeldSide::link;
  apart = identification::gearAndStructure(gears, tracker, 1);
  EXPECT_EQ(apart->structure, 1.5e-7);
  EXPECT_FALSE(apart->in_series);
  EXPECT_EQ(apart->agreement, identification::GearAgreement::apart);
}

/// The samples' machine with a gear on joints 2 to 6 beside what the tracker sees of it with active encoders.
constexpr std::array<double, 6> kGear{0.0, 4.1e6, 4.4e6, 0.6e6, 0.5e6, 0.2e6};

simulation::SimulationSpec gearedDay(std::uint64_t seed, campaign::DoubleEncoder encoder) {
  simulation::SimulationSpec spec = simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
  spec.seed = seed;
  spec.double_encoder = encoder;
  for (std::size_t j = 0; j < 6; ++j) {
    spec.machine.joints[j].bearing.reset();
    if (kGear[j] > 0.0) spec.machine.joints[j].gear = simulation::JointGear{kGear[j], 0.0, 2e-4 * kDeg, 0.01 * kDeg};
  }
  return spec;
}

/// Without tracker: nominal geometry, and of the load states the encoders and the load cell alone.
simulation::SimulationSpec encodersAlone(std::uint64_t seed, campaign::DoubleEncoder encoder) {
  simulation::SimulationSpec spec = gearedDay(seed, encoder);
  spec.machine.geometry = {};
  spec.circle_sweeps.clear();
  spec.wrist_sweep.reset();
  spec.nests.clear();
  spec.loading->repeats = 1;
  spec.posture_draw->count = 10;
  spec.posture_draw->candidates = 2;
  return spec;
}

/// Share of days on which the 95 % interval holds the simulated gear, all joints together.
double coverage(int days, campaign::DoubleEncoder encoder) {
  int held = 0, stated = 0;
  for (int day = 0; day < days; ++day) {
    const simulation::SimulationSpec spec = encodersAlone(1000 + static_cast<std::uint64_t>(day), encoder);
    const campaign::Campaign campaign = identification::referredToMotors(simulation::simulate(spec));
    // What the tracker would give: the machine's true compliances, for K_c.
    JointVector compliance(6);
    for (int j = 0; j < 6; ++j) {
      const simulation::JointStiffness& joint = spec.machine.joints[static_cast<std::size_t>(j)];
      const bool series = joint.gear && encoder == campaign::DoubleEncoder::inactive;
      compliance[j] = 1.0 / *joint.torsion + (series ? 1.0 / joint.gear->stiffness : 0.0);
    }
    const frames::Frames frames = frames::measureFrames(campaign);
    const identification::Transmission found =
        identification::measureTransmission(campaign, frames::sweptGeometry(campaign, frames, compliance), compliance);
    EXPECT_FALSE(found.joints[0].measured);
    for (std::size_t j = 1; j < 6; ++j) {
      if (!found.joints[j].measured) continue;
      ++stated;
      held += identification::stiffnessInterval(found.estimate, static_cast<int>(j)).holds(kGear[j]);
      EXPECT_EQ(found.joints[j].held, encoder == campaign::DoubleEncoder::active ? identification::HeldSide::link
                                                                                 : identification::HeldSide::motor);
    }
  }
  EXPECT_GT(stated, 9 * days / 2);
  return static_cast<double>(held) / stated;
}

TEST(Transmission, IntervalsHoldTheSimulatedGears) {
  constexpr int kDays = 200;
  const double active = coverage(kDays, campaign::DoubleEncoder::active);
  const double inactive = coverage(kDays, campaign::DoubleEncoder::inactive);
  fmt::print("active {:.3f}, inactive {:.3f}\n", active, inactive);
  for (const double share : {active, inactive}) {
    EXPECT_GE(share, 0.93);
    EXPECT_LE(share, 0.98);
  }
}

TEST(Transmission, ADayWithoutTrackerReadingsGivesTheGears) {
  campaign::Campaign campaign = simulation::simulate(encodersAlone(5, campaign::DoubleEncoder::active));
  campaign.loading.reset();
  const identification::Identification found = identification::framesAlone(campaign);
  ASSERT_TRUE(found.transmission.has_value());
  for (int j = 1; j < 6; ++j) {
    // Without the tracker K_c is not known: some thousandths.
    const double at = kGear[static_cast<std::size_t>(j)];
    EXPECT_NEAR(found.transmission->estimate.stiffness(j) / at, 1.0, 0.01) << j;
  }
}

TEST(Transmission, GearAndStructureApartOnAWholeDay) {
  identification::IdentifyOptions options;
  options.subsets.most_all = options.subsets.sample = 1;
  int held = 0, stated = 0;
  for (const auto encoder : {campaign::DoubleEncoder::active, campaign::DoubleEncoder::inactive}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const simulation::SimulationSpec spec = gearedDay(seed, encoder);
      const identification::Identification found =
          identification::identify(identification::referredToMotors(simulation::simulate(spec)), options);
      ASSERT_TRUE(found.transmission.has_value());
      const identification::MethodResult& dpp = found.of(identification::Method::decoupled_partial_pose);
      ASSERT_TRUE(dpp.available);
      for (int j = 1; j < 6; ++j) {
        const double truth = 1.0 / *spec.machine.joints[static_cast<std::size_t>(j)].torsion;
        const double gear = 1.0 / kGear[static_cast<std::size_t>(j)];
        EXPECT_NEAR(found.transmission->estimate.compliance[j] / gear, 1.0, 0.03) << seed << ' ' << j;
        const auto apart = identification::gearAndStructure(*found.transmission, dpp.estimate, j);
        ASSERT_TRUE(apart.has_value());
        EXPECT_EQ(apart->in_series, encoder == campaign::DoubleEncoder::inactive);
        EXPECT_NE(apart->agreement, identification::GearAgreement::contradicts) << seed << ' ' << j;
        ++stated;
        held += apart->interval.holds(truth);
      }
    }
  }
  // 60 intervals at 95 %: fewer than 51 come by chance once in a thousand.
  EXPECT_GE(held, 51) << "of " << stated;
}

}  // namespace transmission_test
}  // namespace stiffscope
