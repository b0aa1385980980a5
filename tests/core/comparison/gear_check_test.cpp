#include <gtest/gtest.h>

#include <cmath>
#include "core/comparison/compare.h"
#include "core/identification/identify.h"
#include "core/identification/motor_side.h"
#include "core/simulation/measure.h"
#include "core/simulation/read_spec.h"

namespace stiffscope {
namespace gear_check_test {

constexpr double kGear = 5e6;  // of joints 2 and 3, Nm/rad

/// A day of the samples' machine, with a gear on joints 2 and 3 and no bearings that tilt.
campaign::Campaign day(campaign::DoubleEncoder encoder, std::uint64_t measurement) {
  simulation::SimulationSpec spec = simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
  spec.measurement = measurement;
  spec.double_encoder = encoder;
  for (auto& joint : spec.machine.joints) joint.bearing.reset();
  for (const std::size_t j : {std::size_t{1}, std::size_t{2}}) {
    spec.machine.joints[j].gear = simulation::JointGear{kGear, 0.0, 3e-6, 1e-4};
  }
  return identification::referredToMotors(simulation::simulate(spec));
}

TEST(GearCheck, WhatEncodersTakeAwayAgreesWithTheGearsOwnMeasurement) {
  identification::IdentifyOptions options;
  options.subsets.most_all = options.subsets.sample = 1;
  const campaign::Campaign inactive = day(campaign::DoubleEncoder::inactive, 1);
  const campaign::Campaign active = day(campaign::DoubleEncoder::active, 2);
  const identification::Identification before = identification::identify(inactive, options);
  const identification::Identification after = identification::identify(active, options);
  const comparison::Comparison both = comparison::compareCampaigns(inactive, before, active, after);
  const comparison::StiffnessChange& change = both.of(identification::Method::decoupled_partial_pose);
  ASSERT_TRUE(change.available);
  for (const std::size_t j : {std::size_t{1}, std::size_t{2}}) {
    ASSERT_TRUE(change.joints[j].gear.has_value()) << j;
    const comparison::GearCheck& gear = *change.joints[j].gear;
    EXPECT_NEAR(gear.compliance.value * kGear, 1.0, 0.02) << j;
    EXPECT_GT(gear.p_value, 0.001) << j << ": " << change.joints[j].difference.value;
  }
  EXPECT_FALSE(change.joints[3].gear.has_value());

  // A gear measured twice as soft is not what the encoders take away.
  identification::Identification wrong = before;
  wrong.transmission->estimate.compliance *= 2.0;
  wrong.transmission->estimate.covariance *= 1e-2;  // the better of the two
  const comparison::Comparison differ = comparison::compareCampaigns(inactive, wrong, active, after);
  EXPECT_LT(differ.of(identification::Method::decoupled_partial_pose).joints[1].gear->p_value, 1e-3);

  // In the other order, or of two days in one state, there is nothing to hold against it.
  EXPECT_FALSE(comparison::compareCampaigns(active, after, inactive, before)
                   .of(identification::Method::decoupled_partial_pose)
                   .joints[1]
                   .gear.has_value());
}

/// What is stated of the agreement follows from what is stated of both: the difference of two models, too, where the
/// postures are others.
TEST(GearCheck, IsOfTheDifferenceThatIsStated) {
  identification::IdentifyOptions options;
  options.subsets.most_all = options.subsets.sample = 1;
  // Every second posture of the one day, the rest of the other.
  const auto half = [](campaign::Campaign campaign, int odd) {
    std::erase_if(campaign.states->rows, [&](const campaign::State& row) { return row.pose % 2 != odd; });
    std::erase_if(campaign.loading->rows, [&](const campaign::LoadingReading& row) { return row.pose % 2 != odd; });
    return campaign;
  };
  const campaign::Campaign inactive = half(day(campaign::DoubleEncoder::inactive, 1), 0);
  const campaign::Campaign active = half(day(campaign::DoubleEncoder::active, 2), 1);
  const auto before = identification::identify(inactive, options);
  const auto after = identification::identify(active, options);
  constexpr auto kMethod = identification::Method::partial_pose;
  comparison::SupportedModels models;
  models.before = &before, models.after = &after;
  const comparison::StiffnessChange change = comparison::compareStiffness(
      inactive, before, active, after, kMethod, comparison::matchPostures(inactive, before, active, after), models);
  ASSERT_TRUE(change.available);
  ASSERT_TRUE(change.by_models);
  for (const std::size_t j : {std::size_t{1}, std::size_t{2}}) {
    const comparison::JointChange& one = change.joints[j];
    ASSERT_TRUE(one.gear.has_value()) << j;
    const double t = std::abs(one.difference.value + one.gear->compliance.value) /
                     std::hypot(one.difference.sd, one.gear->compliance.sd);
    EXPECT_NEAR(one.gear->p_value, std::erfc(t / std::sqrt(2.0)), 0.05) << j;  // Student's t is a little wider
  }
}

}  // namespace gear_check_test
}  // namespace stiffscope
