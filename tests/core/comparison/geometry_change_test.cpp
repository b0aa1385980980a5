#include "core/comparison/geometry_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "reports/words/remark_words.h"
#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace geometry_change_test {

using comparison::ChangeCause;
using comparison::GeometryChange;

/// Two days of other postures and another station; `change` is what happens to the machine between them.
template <class Change>
GeometryChange comparedApart(std::uint64_t seed, const Change& change) {
  Noise noise(seed);
  UnloadedSpec spec = builtOtherwise(noise);
  const campaign::Campaign before = unloadedCampaign(spec, noise);
  change(spec);
  spec.tracker_from_base =
      spec.tracker_from_base * Eigen::Translation3d(0.3, 0.2, 0.0) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ());
  return comparison::compareGeometry(before, unloadedCampaign(spec, noise));
}

/// The same postures twice by a machine with something that no geometry is.
template <class Change>
GeometryChange comparedOnTheSame(std::uint64_t seed, const Change& change) {
  Noise noise(seed);
  UnloadedSpec spec = builtOtherwise(noise);
  spec.joint_errors = [](const JointVector& q) {
    JointVector errors = JointVector::Zero(6);
    for (Eigen::Index j = 0; j < 6; ++j)
      errors[j] = 100e-6 * std::sin((3.3 + static_cast<double>(j)) * q[j]) * std::cos(2.1 * q[(j + 1) % 6]);
    return errors;
  };
  const campaign::Campaign before = unloadedCampaign(spec, noise);
  change(spec);
  return comparison::compareGeometry(before, measuredAgain(before, spec, noise));
}

void nothing(UnloadedSpec&) {}

// Of 30 pairs at 1 % three or more are said to have changed in 0.3 % of all runs.
TEST(GeometryChange, OfAnUnchangedMachineNothingIsSaid) {
  int apart = 0, same = 0;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    const GeometryChange other = comparedApart(seed, nothing), paired = comparedOnTheSame(100 + seed, nothing);
    ASSERT_TRUE(other.reason.empty()) << reports::words(other.reason);
    ASSERT_TRUE(paired.reason.empty()) << reports::words(paired.reason);
    EXPECT_FALSE(other.same_postures);
    EXPECT_TRUE(paired.same_postures);
    EXPECT_EQ(other.numbers.size(), 18u);
    apart += other.machine_changed || other.reflectors_moved;
    same += paired.machine_changed || paired.reflectors_moved;
    EXPECT_GT(paired.left_before, 2.0 * std::sqrt(3.0) * 20e-6);  // the misfit is there, and cancels
  }
  EXPECT_LE(apart + same, 2) << apart << " apart, " << same << " on the same postures";
}

// Effects that each day chooses for itself are the same machine in both.
TEST(GeometryChange, EffectsOfTheMachineAreNoChange) {
  int changed = 0;
  for (std::uint64_t seed = 6020; seed < 6032; ++seed) {
    Noise noise(seed);
    UnloadedSpec spec = builtOtherwise(noise);
    spec.joint_errors = [](const JointVector& q) {
      JointVector errors = JointVector::Zero(6);
      errors[1] = 60e-6 * std::sin(2.0 * q[1]) + 50e-6 * std::cos(17.0 * q[1]);
      errors[2] = 80e-6 * std::sin(q[2]);
      errors[4] = 2e-4 * q[4];
      return errors;
    };
    const campaign::Campaign before = unloadedCampaign(spec, noise);
    const GeometryChange found = comparison::compareGeometry(before, unloadedCampaign(spec, noise));
    EXPECT_FALSE(found.effects.empty());
    changed += found.machine_changed;
  }
  EXPECT_LE(changed, 1);
}

TEST(GeometryChange, OneJointsZeroIsFoundAndNamed) {
  int not_explained = 0;
  for (const std::size_t joint : {1u, 2u, 3u, 4u}) {
    const double moved = 0.2e-3;
    const auto change = [&](UnloadedSpec& spec) {
      spec.built.to_joint[joint].rotate(Eigen::AngleAxisd(moved, spec.built.axis[joint]));
    };
    for (const GeometryChange& found : {comparedApart(20 + joint, change), comparedOnTheSame(30 + joint, change)}) {
      EXPECT_TRUE(found.machine_changed);
      ASSERT_FALSE(found.causes.empty());
      const comparison::CauseEvidence& best = found.causes.front();
      EXPECT_EQ(best.cause, ChangeCause::joint_zero) << joint;
      EXPECT_EQ(best.axis, static_cast<int>(joint) + 1);
      ASSERT_TRUE(best.size);
      EXPECT_NEAR(std::abs(best.size->value), moved, 4.0 * best.size->sd) << joint;
      EXPECT_LT(best.size->sd, 0.1 * moved);
      not_explained += !found.explained();
      EXPECT_FALSE(found.reflectors_moved);
      for (const comparison::NumberChange& one : found.numbers) {
        if (one.number.kind == comparison::NumberKind::joint_zero && one.number.axis == best.axis) {
          EXPECT_LT(one.p_holm, 0.01);
        }
      }
    }
  }
  EXPECT_LE(not_explained, 1);  // two of eight by chance at 1 %: 0.3 %
}

// What joints give by own weight is no geometry: a softer joint is said to be another effect, whatever else both days
// miss.
TEST(GeometryChange, ASofterJointIsNoGeometry) {
  int changed = 0;
  for (std::uint64_t seed = 51; seed < 56; ++seed) {
    Noise noise(seed);
    UnloadedSpec spec = builtOtherwise(noise);
    const ChainArm built = spec.built;
    const auto sag = [built](double softer) {
      return [=](const JointVector& q) {
        JointVector errors = JointVector::Zero(6);
        errors[1] = 3e-7 * softer * built.weightTorque(q)[1];
        errors[2] = 60e-6 * std::sin(5.3 * q[2]);
        return errors;
      };
    };
    spec.joint_errors = sag(1.0);
    const campaign::Campaign before = unloadedCampaign(spec, noise);
    spec.joint_errors = sag(1.3);
    const GeometryChange found = comparison::compareGeometry(before, measuredAgain(before, spec, noise));
    EXPECT_TRUE(found.effects_changed) << seed;
    EXPECT_EQ(found.effects, std::vector<std::string>{"joint_compliance"});
    changed += found.machine_changed;
  }
  EXPECT_LE(changed, 1);  // two of five by chance at half a per cent: 0.02 %
}

TEST(GeometryChange, ATiltedAxisIsABentLink) {
  const auto change = [](UnloadedSpec& spec) {
    spec.built.to_joint[3].rotate(Eigen::AngleAxisd(0.3e-3, Eigen::Vector3d::UnitZ()));  // axis 4 is along x
  };
  const GeometryChange found = comparedApart(41, change);
  EXPECT_TRUE(found.machine_changed);
  ASSERT_FALSE(found.causes.empty());
  EXPECT_EQ(found.causes.front().cause, ChangeCause::link);
  EXPECT_EQ(found.causes.front().axis, 3);
  EXPECT_GT(found.at_targets, 5.0 * found.at_targets_sd);
}

TEST(GeometryChange, WarmUpIsGrowthOfAllLengths) {
  const double growth = 60e-6;  // five kelvin of steel
  const auto change = [&](UnloadedSpec& spec) {
    for (Eigen::Isometry3d& link : spec.built.to_joint) link.translation() *= 1.0 + growth;
  };
  for (const GeometryChange& found : {comparedApart(51, change), comparedOnTheSame(52, change)}) {
    EXPECT_TRUE(found.machine_changed);
    ASSERT_FALSE(found.causes.empty());
    EXPECT_EQ(found.causes.front().cause, ChangeCause::growth);
    ASSERT_TRUE(found.causes.front().size);
    EXPECT_NEAR(found.causes.front().size->value, growth, 4.0 * found.causes.front().size->sd);
  }
}

TEST(GeometryChange, ReflectorsSetAgainAreNoChangeOfTheMachine) {
  const auto change = [](UnloadedSpec& spec) {
    spec.on_flange[0] += Eigen::Vector3d(0.1e-3, 0.0, -0.05e-3);
    spec.on_flange[2] += Eigen::Vector3d(-0.06e-3, 0.12e-3, 0.0);
  };
  const GeometryChange found = comparedApart(61, change);
  EXPECT_FALSE(found.machine_changed);
  EXPECT_TRUE(found.reflectors_moved);
  ASSERT_FALSE(found.causes.empty());
  EXPECT_EQ(found.causes.front().cause, ChangeCause::reflectors);
  ASSERT_EQ(found.reflectors.size(), 3u);
  EXPECT_NEAR(found.reflectors[0].shift.x(), 0.1e-3, 4.0 * found.reflectors[0].sd.x());
  EXPECT_LT(found.reflectors[0].p_holm, 0.01);
  EXPECT_LT(found.reflectors[2].p_holm, 0.01);
  EXPECT_GT(found.reflectors[1].p_holm, 0.001);
}

TEST(GeometryChange, JointSixIsSaidWithTheReflectors) {
  const auto change = [](UnloadedSpec& spec) {
    spec.built.to_joint[5].rotate(Eigen::AngleAxisd(0.5e-3, spec.built.axis[5]));
  };
  const GeometryChange found = comparedApart(71, change);
  EXPECT_FALSE(found.machine_changed);
  EXPECT_TRUE(found.reflectors_moved);
  ASSERT_FALSE(found.causes.empty());
  EXPECT_EQ(found.causes.front().cause, ChangeCause::turn_about_last);
  ASSERT_TRUE(found.causes.front().size);
  EXPECT_NEAR(found.causes.front().size->value, 0.5e-3, 4.0 * found.causes.front().size->sd);
}

/// The example's arm with rods that keep the forearm's direction when joint 2 turns: axis 3, on one line with joint
/// 3's, turns back by as much. Seven axes, six joints.
ChainArm withRods() {
  ChainArm arm = exampleChain();
  const auto second = [](auto& list, const auto& one) { list.insert(list.begin() + 2, one); };
  second(arm.to_joint, Eigen::Isometry3d(arm.to_joint[2]));
  second(arm.axis, Eigen::Vector3d(0, 1, 0));
  second(arm.mass, 20.0);
  second(arm.centre, Eigen::Vector3d(0, 0, 0));
  arm.to_joint[3] = Eigen::Isometry3d::Identity();
  return arm;
}

JointMatrix turnsOfRods() {
  JointMatrix turns = JointMatrix::Zero(7, 6);
  turns(2, 1) = -1.0;
  for (const auto& [axis, joint] : {std::pair(0, 0), {1, 1}, {3, 2}, {4, 3}, {5, 4}, {6, 5}}) turns(axis, joint) = 1.0;
  return turns;
}

robot::Robot robotWithRods() {
  robot::Robot robot = withRods().robot();
  robot.axes_in_base_at_zero.couplings = std::make_shared<const robot::Couplings>(
      robot::Couplings{turnsOfRods(), {0, 1, 3, 4, 5, 6}, {0, 1, -1, 2, 3, 4, 5}});
  robot.axis_names = robot.joint_names, robot.axis_limits = robot.limits;
  robot.joint_names.pop_back(), robot.limits.pop_back();
  return robot;
}

/// The states of `day` as an arm with rods reaches them, its joints at `beyond` more than they say.
campaign::Campaign measuredWithRods(campaign::Campaign day, const ChainArm& built, const JointVector& beyond,
                                    const UnloadedSpec& spec, Noise& noise) {
  day.robot = robotWithRods();
  for (campaign::LoadingReading& reading : day.loading->rows) {
    const JointVector& q = day.states->rows[static_cast<std::size_t>(reading.pose)].q;
    const JointVector angles = turnsOfRods() * (q + beyond);
    reading.point =
        spec.tracker_from_base * (built.flangeAt(angles) * spec.on_flange[static_cast<std::size_t>(reading.target)]) +
        spec.noise * noise.normal3();
  }
  return day;
}

TEST(GeometryChange, ZerosOfCoupledJointsHaveTheirJointsNumbers) {
  Noise noise(91);
  const UnloadedSpec spec;
  const campaign::Campaign day = unloadedCampaign(spec, noise);
  const ChainArm built = withRods().disturbed(noise, 0.3e-3, 0.2e-3);
  const campaign::Campaign before = measuredWithRods(day, built, JointVector::Zero(6), spec, noise);
  for (const int joint : {2, 3, 4, 5, 6}) {
    const double moved = 0.3e-3;
    JointVector beyond = JointVector::Zero(6);
    beyond[joint - 1] = moved;
    const GeometryChange found = comparison::compareGeometry(before, measuredWithRods(day, built, beyond, spec, noise));
    ASSERT_TRUE(found.reason.empty()) << reports::words(found.reason);
    EXPECT_EQ(found.machine_changed, joint != 6);
    EXPECT_EQ(found.reflectors_moved, joint == 6);
    ASSERT_FALSE(found.causes.empty());
    const comparison::CauseEvidence& best = found.causes.front();
    EXPECT_EQ(best.cause, joint == 6 ? ChangeCause::turn_about_last : ChangeCause::joint_zero) << joint;
    EXPECT_EQ(best.joint, joint);
    EXPECT_EQ(best.axis, joint < 3 ? joint : joint + 1);
    EXPECT_EQ(best.same_line, joint == 3 ? 3 : 0);  // rods of another length turn the forearm, too
    ASSERT_TRUE(best.size);
    EXPECT_NEAR(best.size->value, moved, 4.0 * best.size->sd) << joint;
    EXPECT_LT(best.size->sd, 0.1 * moved);
  }
}

TEST(GeometryChange, TheLastLinkOfCoupledJointsIsACause) {
  Noise noise(92);
  const UnloadedSpec spec;
  const campaign::Campaign day = unloadedCampaign(spec, noise);
  const ChainArm built = withRods().disturbed(noise, 0.3e-3, 0.2e-3);
  ChainArm bent = built;  // axis 7 off axis 6, and turned
  bent.to_joint[6].translate(Eigen::Vector3d(0.0, 0.1e-3, 0.3e-3));
  bent.to_joint[6].rotate(Eigen::AngleAxisd(0.4e-3, Eigen::Vector3d::UnitY()));
  const JointVector none = JointVector::Zero(6);
  const GeometryChange found = comparison::compareGeometry(measuredWithRods(day, built, none, spec, noise),
                                                           measuredWithRods(day, bent, none, spec, noise));
  EXPECT_TRUE(found.machine_changed);
  ASSERT_FALSE(found.causes.empty());
  EXPECT_EQ(found.causes.front().cause, ChangeCause::link);
  EXPECT_EQ(found.causes.front().axis, 6);
}

// Two days of an unchanged machine whose joints stand anew in each posture, by 0.2 mrad.
TEST(GeometryChange, JointsThatScatterMoveNoReflectors) {
  for (std::uint64_t seed = 95; seed < 98; ++seed) {
    Noise noise(seed);
    UnloadedSpec spec = builtOtherwise(noise);
    spec.joint_errors = [&noise](const JointVector& q) {
      JointVector errors(q.size());
      for (double& one : errors) one = 200e-6 * noise.normal();
      return errors;
    };
    const campaign::Campaign before = unloadedCampaign(spec, noise);
    const GeometryChange found = comparison::compareGeometry(before, unloadedCampaign(spec, noise));
    EXPECT_FALSE(found.reflectors_moved) << seed << ": p " << found.reflectors_p;
    EXPECT_FALSE(found.machine_changed) << seed << ": p " << found.machine_p;
  }
}

TEST(GeometryChange, RefusesAnotherMachineAndADayWithoutReadings) {
  Noise noise(81);
  const UnloadedSpec spec;
  const campaign::Campaign day = unloadedCampaign(spec, noise);
  campaign::Campaign other = day, empty = day;
  other.robot.axes_in_base_at_zero[2].point.x() += 0.05;
  EXPECT_TRUE(comparison::compareGeometry(day, other).reason.is(comparison::RemarkId::axis_elsewhere));
  empty.loading->rows.clear();
  const Remark reason = comparison::compareGeometry(day, empty).reason;
  EXPECT_TRUE(reason.is(comparison::RemarkId::of_one_campaign));
  EXPECT_EQ(reports::words(reason).rfind("after: ", 0), 0u) << reports::words(reason);
}

}  // namespace geometry_change_test
}  // namespace stiffscope
