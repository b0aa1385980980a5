#include <gtest/gtest.h>

#include <algorithm>

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
  const extended_model::ExtendedModel model =
      extended_model::supportedModel(prepared, prepared.campaign, fewSubsets(2));
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

}  // namespace one_decision_test
}  // namespace stiffscope
