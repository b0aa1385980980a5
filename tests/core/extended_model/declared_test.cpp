#include "core/extended_model/hidden_effects.h"

#include <gtest/gtest.h>

#include "tests/fixtures/simulated_lab.h"

namespace stiffscope {
namespace declared_test {

/// A day on which only displacements were recorded, of an arm without masses.
campaign::Campaign displacementDay(int postures = 20) {
  SimulatedLab lab;
  lab.withoutMasses();
  lab.compliance = exampleCompliance();
  campaign::Campaign campaign = lab.empty();
  lab.addLoading(campaign, postures, pulledForce);
  campaign.displacements = campaign::Displacements{"displacements.csv", campaign::PointFrame::tracker, {}};
  for (std::size_t k = 0; k < campaign.targets.size(); ++k)
    campaign.targets[k].position_in_flange = lab.targets_in_flange[k];
  const std::vector<campaign::LoadingReading>& rows = campaign.loading->rows;
  for (const campaign::LoadingReading& loaded : rows) {
    if (loaded.step == 0) continue;
    for (const campaign::LoadingReading& before : rows) {
      if (before.step != 0 || before.pose != loaded.pose || before.target != loaded.target) continue;
      const Eigen::Vector3d in_base = lab.tracker_from_base.linear().transpose() * (loaded.point - before.point);
      campaign.displacements->rows.push_back({loaded.pose, loaded.step, loaded.target, in_base, 0});
    }
  }
  campaign.displacements->frame = campaign::PointFrame::base_link;
  campaign.loading.reset();
  campaign.tracker = campaign::Tracker{"", 1e-5, 0.0, 1e-5, 0.0};
  return campaign;
}

TEST(Declared, NothingIsIdentifiedForWhatIsNotDeclared) {
  const campaign::Campaign campaign = displacementDay();
  const extended_model::Declared declared =
      extended_model::declaredOf(campaign, identification::identify(campaign), {});
  EXPECT_TRUE(declared.columns.empty());
  EXPECT_EQ(declared.gain_sd + declared.cell_angle_sd + declared.cell_point_sd, 0.0);
}

// By hand: with the geometry of the URDF a displacement read 0.1 % too large makes every compliance 0.1 % larger, but
// for K_c, which is a hundredth of that.
TEST(Declared, ATrackersScaleIsThatOfTheCompliances) {
  campaign::Campaign campaign = displacementDay();
  campaign.tracker->scale_sigma = 1e-3;
  const identification::Identification at = identification::identify(campaign);
  const extended_model::Declared declared = extended_model::declaredOf(campaign, at, {});
  ASSERT_EQ(declared.columns.size(), 1u);
  EXPECT_EQ(declared.columns[0].source, extended_model::BudgetSource::tracker_scale);
  const auto method = identification::Method::partial_pose;
  ASSERT_TRUE(at.of(method).available);
  for (int j = 0; j < 6; ++j) {
    const double c = at.of(method).estimate.compliance[j];
    EXPECT_NEAR(declared.columns[0].compliance[static_cast<std::size_t>(method)][j], 1e-3 * c, 2e-5 * c) << j;
  }
}

// By the same hand, of a day of which a thousand postures take part; nothing where estimates alone are asked for.
TEST(Declared, OfALongDayAThousandPosturesTellIt) {
  campaign::Campaign campaign = displacementDay(1010);
  campaign.tracker->scale_sigma = 1e-3;
  const identification::IdentifyOptions quick = identification::estimatesOnly({});
  const identification::Identification at = identification::identify(campaign, quick);
  EXPECT_TRUE(extended_model::declaredOf(campaign, at, quick).columns.empty());
  const extended_model::Declared declared = extended_model::declaredOf(campaign, at, {});
  ASSERT_EQ(declared.columns.size(), 1u);
  const auto method = identification::Method::partial_pose;
  for (int j = 0; j < 6; ++j) {
    const double c = at.of(method).estimate.compliance[j];
    EXPECT_NEAR(declared.columns[0].compliance[static_cast<std::size_t>(method)][j], 1e-3 * c, 2e-5 * c) << j;
  }
}

TEST(Declared, MassesOfAnArmThatHasNoneMoveNothing) {
  campaign::Campaign campaign = displacementDay();
  campaign.mass_sigma = 0.1;
  const extended_model::Declared declared =
      extended_model::declaredOf(campaign, identification::identify(campaign), {});
  ASSERT_EQ(declared.columns.size(), 1u);
  for (const JointVector& change : declared.columns[0].compliance) EXPECT_TRUE(change.isZero(1e-18));
}

}  // namespace declared_test
}  // namespace stiffscope
