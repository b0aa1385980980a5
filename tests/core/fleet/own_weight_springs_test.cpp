#include "core/fleet/own_weight_springs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/calibration/calibrate.h"
#include "core/fleet/fleet.h"
#include "tests/fixtures/unloaded_day.h"

namespace stiffscope::fleet {
namespace own_weight_springs_test {

/// Of the example's arm; joints 1 and 6 hardly carry the arm's weight.
const JointVector kCompliance = (JointVector(6) << 2e-7, 3e-7, 4e-7, 2e-6, 2e-6, 5e-6).finished();

/// Joints give under the weight of the machine as built, by the chain's own statics, beside a gear that is uneven once
/// a turn, as the torque of a horizontal arm is.
std::function<JointVector(const JointVector&)> sagging(const ChainArm& built, const JointVector& compliance,
                                                       double uneven) {
  return [=](const JointVector& q) {
    JointVector errors = JointVector::Zero(6);
    errors[1] = uneven * std::sin(q[1]);
    const JointVector gear = errors;
    for (int turn = 0; turn < 6; ++turn) errors = gear + compliance.cwiseProduct(built.weightTorque(q + errors));
    return errors;
  };
}

struct MadeDays {
  Noise noise;
  UnloadedSpec spec;
  campaign::Campaign first;

  explicit MadeDays(std::uint64_t seed, double uneven = 0.0) : noise(seed), spec(builtOtherwise(noise)) {
    spec.joint_errors = sagging(spec.built, kCompliance, uneven);
    first = unloadedCampaign(spec, noise);
  }

  /// The same postures with compliances times `factors`, the tracker set up anew.
  campaign::Campaign again(const JointVector& factors, double uneven = 0.0) {
    UnloadedSpec then = spec;
    then.joint_errors = sagging(spec.built, kCompliance.cwiseProduct(factors), uneven);
    then.tracker_from_base = spec.tracker_from_base * Eigen::Translation3d(0.3 * noise.normal(), 0.2, 0.0) *
                             Eigen::AngleAxisd(0.1 * noise.normal(), Eigen::Vector3d::UnitZ());
    return measuredAgain(first, then, noise);
  }
};

/// What a fleet keeps of a day.
CampaignResult keptOf(const campaign::Campaign& day) {
  CampaignResult result(6);
  result.kind = DayKind::unloaded;
  const calibration::Calibration calibration = calibration::calibrate(day, {});
  result.own_weight = ownWeightSprings(calibration);
  for (const calibration::Posture& posture : calibration.day.postures) {
    result.loaded_postures.push_back(
        {calibration.day.pose_ids[static_cast<std::size_t>(posture.pose)], posture.q, Eigen::Vector3d::Zero()});
  }
  return result;
}

double sdOf(const SpringsOfDay& springs, int joint) {
  double variance = 0.0;
  for (const JointVector& one : springs.influences) variance += one[joint] * one[joint];
  return std::sqrt(variance);
}

TEST(OwnWeightSprings, AreTheMachinesWithinTheirUncertainty) {
  MadeDays days(3);
  const SpringsOfDay springs = keptOf(days.first).own_weight;
  ASSERT_TRUE(springs.available);
  ASSERT_EQ(springs.influences.size(), 60u);
  EXPECT_FALSE(springs.identifiable[0]);  // vertical: the weight does not turn it
  for (const int joint : {1, 2}) {
    EXPECT_TRUE(springs.identifiable[static_cast<std::size_t>(joint)]);
    EXPECT_NEAR(springs.compliance[joint], kCompliance[joint], 4.0 * sdOf(springs, joint)) << joint;
    EXPECT_LT(sdOf(springs, joint), 0.1 * kCompliance[joint]);
    EXPECT_GT(springs.dof[joint], 10.0);
    EXPECT_LT(springs.dof[joint], 60.0);
  }
}

// The scatter of sixty postures is that of the estimate over days of other noise: chi-square over 23 degrees of
// freedom, 0.46 to 1.83 for all but two of a thousand runs, widened by what the scatters themselves scatter.
TEST(OwnWeightSprings, ScatterIsWhatTheNoiseDoes) {
  MadeDays days(5);
  std::vector<SpringsOfDay> all;
  for (int day = 0; day < 24; ++day) all.push_back(keptOf(days.again(JointVector::Ones(6))).own_weight);
  for (const int joint : {1, 2}) {
    double mean = 0.0, squares = 0.0, stated = 0.0;
    for (const SpringsOfDay& one : all) mean += one.compliance[joint] / 24.0;
    for (const SpringsOfDay& one : all) {
      squares += std::pow(one.compliance[joint] - mean, 2) / 23.0;
      stated += std::pow(sdOf(one, joint), 2) / 24.0;
    }
    EXPECT_GT(squares / stated, 0.42) << joint;
    EXPECT_LT(squares / stated, 2.0) << joint;
  }
}

// An uneven gear looks like a softer joint on both days, and by as much: it cancels in their difference, and so does
// what it adds to the scatter.
TEST(OwnWeightSprings, ASofterJointIsSeenBesideWhatBothDaysMiss) {
  constexpr double kUneven = 200e-6;
  MadeDays days(7, kUneven);
  JointVector factors = JointVector::Ones(6);
  factors[1] = 1.08;
  const CampaignResult before = keptOf(days.first), after = keptOf(days.again(factors, kUneven));
  const double apart = before.own_weight.compliance[1] - kCompliance[1];
  const ComplianceSeries series({&before, &after}, std::nullopt);
  EXPECT_TRUE(series.samePostures());
  const comparison::Uncertain difference = series.contrast(1, Eigen::Vector2d(-1.0, 1.0), {0, 1});
  EXPECT_GT(std::abs(apart), 5.0 * difference.sd);  // the gear is there
  EXPECT_NEAR(difference.value, 0.08 * kCompliance[1], 4.0 * difference.sd);
  EXPECT_LT(difference.sd, 0.02 * kCompliance[1]);
  EXPECT_LT(series.pOfNothing(difference), 1e-6);
  const comparison::Uncertain other = series.contrast(2, Eigen::Vector2d(-1.0, 1.0), {0, 1});
  EXPECT_GT(series.pOfNothing(other), 1e-3);
}

TEST(OwnWeightSprings, WithoutMassesThereAreNone) {
  Noise noise(9);
  UnloadedSpec spec = builtOtherwise(noise);
  spec.nominal.mass.assign(spec.nominal.mass.size(), 0.0);
  EXPECT_FALSE(ownWeightSprings(calibration::calibrate(unloadedCampaign(spec, noise), {})).available);
}

}  // namespace own_weight_springs_test
}  // namespace stiffscope::fleet
