#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "core/campaign/read_campaign.h"
#include "core/diagnosis/diagnose.h"
#include "core/extended_model/extend_model.h"
#include "core/preparation/prepare.h"
#include "core/simulation/measure.h"
#include "tests/fixtures/extended_day.h"

// Identification and diagnosis of one day say the same of what is left.

namespace stiffscope {
namespace one_decision_test {

struct Said {
  bool unknown = false, significant = false;  ///< by the diagnosis
};

Said saidBy(const diagnosis::Diagnosis& diagnosis) {
  const auto& entries = diagnosis.verdict.entries;
  const auto says = [&](diagnosis::RemarkId id) {
    const auto& reasons = diagnosis.verdict.reasons;
    return std::any_of(reasons.begin(), reasons.end(), [&](const Remark& reason) { return reason.is(id); });
  };
  return {std::any_of(entries.begin(), entries.end(), [](const auto& entry) { return entry.effects.empty(); }),
          says(diagnosis::RemarkId::chi_square_significant)};
}

void expectOneWord(const simulation::SimulationSpec& spec, bool unknown) {
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(spec));
  const extended_model::ExtendedModel model = extended_model::supportedModel(prepared, prepared.campaign, fewSubsets(2),
                                                                             extended_model::Followed::by_diagnosis);
  diagnosis::DiagnoseOptions quick;
  quick.resamples = quick.chance_draws = 0;
  const Said said = saidBy(diagnosis::diagnose(prepared, *model.study, quick));
  EXPECT_EQ(said.unknown, unknown) << spec.seed;
  EXPECT_EQ(model.hidden->unexplained, said.unknown) << spec.seed;
  EXPECT_EQ(model.residualIsNoise(), !said.significant && !said.unknown) << spec.seed;
}

// Springs and nothing else. The second day leaves 1.18 times the noise's chi-square, of which chance makes up to 1.24.
TEST(OneDecision, NearNoiseNeitherSaysThatSomethingIsLeft) {
  for (const std::uint64_t seed : {45, 52}) expectOneWord(springsAlone(seed), false);
}

// A machine whose joint 3 ripples with its angle, which no effect is.
TEST(OneDecision, WhatNoEffectExplainsBothSay) {
  simulation::SimulationSpec spec = springsAlone(11);
  spec.machine.joints[2].rate_wave = simulation::JointWave{0.35, 3.0, 0.4};
  expectOneWord(spec, true);
}

// What is stated of stiffnesses needs the study's equations no more; a diagnosis does, and says so.
TEST(OneDecision, AStudyWithoutEquationsServesTheModelAlone) {
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(springsAlone(45)));
  const auto modelFor = [&](extended_model::Followed followed) {
    return extended_model::supportedModel(prepared, prepared.campaign, fewSubsets(2), followed);
  };
  const extended_model::ExtendedModel kept = modelFor(extended_model::Followed::by_diagnosis);
  const extended_model::ExtendedModel alone = modelFor(extended_model::Followed::by_nothing);
  ASSERT_TRUE(kept.study->hasEquations());
  ASSERT_FALSE(alone.study->hasEquations());
  for (const identification::Method which : identification::kMethods) {
    EXPECT_EQ(kept.with.of(which).estimate.compliance, alone.with.of(which).estimate.compliance);
    EXPECT_EQ(kept.with.of(which).estimate.covariance, alone.with.of(which).estimate.covariance);
  }
  EXPECT_THROW(diagnosis::diagnose(prepared, *alone.study, {}), std::logic_error);
}

/// Where the fit has a negative stiffness another one is stated: what it leaves must be what is said to be left.
TEST(OneDecision, StatedStiffnessesLeaveWhatIsSaidToBeLeft) {
  const std::filesystem::path day = std::filesystem::path(STIFFSCOPE_SHARED_DIR) / "real" / "fanuc-r2000ic-cable";
  if (!std::filesystem::exists(day)) GTEST_SKIP() << day << " is not there";
  const preparation::PreparedCampaign prepared =
      preparation::prepareCampaign(campaign::readCampaign(day.string()).campaign);
  const extended_model::ExtendedModel model =
      extended_model::supportedModel(prepared, prepared.campaign, fewSubsets(2), extended_model::Followed::by_nothing);
  const identification::MethodResult& method = model.with.of(identification::Method::partial_pose);
  ASSERT_TRUE(method.available);
  double stated = 0.0, said = 0.0;
  for (std::size_t i = 0; i < method.target_rows.size(); ++i) {  // one reflector
    const identification::CaseEquations& one = method.target_rows[i];
    stated += (one.right - one.matrix * method.estimate.compliance).squaredNorm();
    said += method.target_residual[i] * method.target_residual[i];
  }
  EXPECT_NEAR(stated / said, 1.0, 0.02);
}

}  // namespace one_decision_test
}  // namespace stiffscope
