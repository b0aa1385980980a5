#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/campaign/read_campaign.h"
#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/gap_study.h"
#include "core/extended_model/extend_model.h"
#include "core/identification/estimate.h"
#include "core/identification/outliers.h"
#include "core/identification/remarks.h"
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

// Frames alone are found by one method, and their distance to springs alone by the postures that the diagnosis has.
TEST(OneDecision, FramesOfALongDayAreThoseThatStandBesideItsStiffnesses) {
  simulation::SimulationSpec spec = springsAlone(12);
  spec.machine.joints[2].rate_wave = simulation::JointWave{0.35, 3.0, 0.4};
  spec.posture_draw->count = 110;
  spec.posture_draw->candidates = 1;
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(spec));
  ASSERT_TRUE(diagnosis::isLong(prepared.campaign));
  const extended_model::ExtendedModel whole =
      extended_model::supportedModel(prepared, prepared.campaign, fewSubsets(2));
  const extended_model::ExtendedModel quick =
      extended_model::supportedModel(prepared, prepared.campaign, identification::estimatesOnly({}));
  EXPECT_TRUE(whole.hidden->unexplained);
  const frames::Frames &one = whole.with.frames, &other = quick.with.frames;
  EXPECT_LT(frames::framesDifference(one, other).norm(), 1e-14);
  EXPECT_GT(one.covariance.hidden.norm(), 0.0);
  EXPECT_EQ(one.covariance.hidden, other.covariance.hidden);
  EXPECT_EQ(one.covariance.sag, other.covariance.sag);
  EXPECT_FALSE(quick.with.of(identification::Method::complete_pose).available);
  EXPECT_TRUE(quick.with.of(identification::Method::decoupled_partial_pose).available);
}

/// Each posture's displacements off by a factor of its own, which no effect does.
campaign::Campaign scatteredByPosture(campaign::Campaign campaign, double sd) {
  std::map<std::pair<int, int>, std::pair<Eigen::Vector3d, int>> unloaded;  // by pose and target: sum and count
  for (const campaign::LoadingReading& row : campaign.loading->rows) {
    if (row.step != 0) continue;
    auto& [sum, count] = unloaded.try_emplace({row.pose, row.target}, Eigen::Vector3d::Zero(), 0).first->second;
    sum += row.point, ++count;
  }
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> factors(campaign.pose_ids.size());
  for (double& factor : factors) factor = 1.0 + sd * normal(random);
  for (campaign::LoadingReading& row : campaign.loading->rows) {
    if (row.step == 0) continue;
    const auto& [sum, count] = unloaded.at({row.pose, row.target});
    const Eigen::Vector3d before = sum / count;
    row.point = before + factors[static_cast<std::size_t>(row.pose)] * (row.point - before);
  }
  return campaign;
}

// The gap that a bearing makes is named; what the scatter leaves of it is the same share for both, and is not hidden by
// being in the noise of a chi-square.
TEST(OneDecision, TheShareThatNoEffectExplainsIsTheDiagnosis) {
  simulation::SimulationSpec spec = springsAlone(5);
  spec.machine.joints[4].bearing = 6e5;
  const preparation::PreparedCampaign prepared =
      preparation::prepareCampaign(scatteredByPosture(simulation::simulate(spec), 0.04));
  const extended_model::ExtendedModel model = extended_model::supportedModel(prepared, prepared.campaign, fewSubsets(2),
                                                                             extended_model::Followed::by_diagnosis);
  diagnosis::DiagnoseOptions quick;
  quick.resamples = quick.chance_draws = 0;
  const diagnosis::Diagnosis diagnosis = diagnosis::diagnose(prepared, *model.study, quick);
  ASSERT_TRUE(saidBy(diagnosis).unknown);
  ASSERT_FALSE(model.effects.added.empty());
  EXPECT_GT(model.hidden->unexplained_share, 0.15);
  EXPECT_NEAR(model.hidden->unexplained_share, diagnosis.gap.shareLeft(), 1e-9);
  EXPECT_TRUE(model.hidden->unexplained);
}

// A posture that is left out is in nothing that the others are stated by: as on the day without it.
TEST(OneDecision, APostureLeftOutIsInNoInterval) {
  campaign::Campaign spoilt = simulation::simulate(springsAlone(45));
  std::vector<bool> seventh(spoilt.pose_ids.size(), false);
  seventh[7] = true;
  campaign::Campaign others = spoilt;
  identification::dropPostures(seventh, others);
  for (campaign::LoadingReading& row : spoilt.loading->rows) {
    if (row.pose == 7 && row.step == 3) row.point.z() += 1e-3;
  }
  const auto modelOf = [](const campaign::Campaign& day, bool robust) {
    identification::IdentifyOptions options = fewSubsets(2);
    options.robust = robust;
    return extended_model::withoutOutlying(
        preparation::prepareCampaign(day), options,
        [](const preparation::PreparedCampaign& prepared, const identification::IdentifyOptions& how) {
          return extended_model::supportedModel(prepared, prepared.campaign, how);
        });
  };
  const extended_model::ExtendedModel robust = modelOf(spoilt, true), without = modelOf(others, false);
  ASSERT_EQ(robust.with.outlying.size(), 1u);
  EXPECT_TRUE(robust.with.robust);
  EXPECT_TRUE(std::any_of(robust.with.left_out.begin(), robust.with.left_out.end(), [&](const auto& one) {
    return one.pose == spoilt.pose_ids[7] && one.reason.is(identification::RemarkId::disagrees);
  }));
  const auto& a = robust.with.of(identification::Method::partial_pose).estimate;
  const auto& b = without.with.of(identification::Method::partial_pose).estimate;
  for (int j = 0; j < a.joints(); ++j) {
    if (!b.identifiable[static_cast<std::size_t>(j)]) continue;
    EXPECT_NEAR(a.compliance[j], b.compliance[j], 1e-9 * b.compliance[j]) << j;
    // Its repeats still tell the noise, and of other numbers the draws are others. With it U is three times as large.
    EXPECT_NEAR(identification::expandedUncertainty(a, j) / identification::expandedUncertainty(b, j), 1.0, 0.2) << j;
  }
}

// With three postures none can be held out: that is said, and refutes no effect.
TEST(OneDecision, ThreePosturesRefuteNoEffect) {
  simulation::SimulationSpec spec = springsAlone(5);
  spec.machine.joints[4].bearing = 6e5;
  campaign::Campaign day = simulation::simulate(spec);
  std::vector<bool> dropped(day.pose_ids.size(), true);
  for (const std::size_t kept : {1u, 6u, 12u}) dropped[kept] = false;
  identification::dropPostures(dropped, day);
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(day);
  const extended_model::ExtendedModel model = extended_model::supportedModel(prepared, prepared.campaign, fewSubsets(2),
                                                                             extended_model::Followed::by_diagnosis);
  const diagnosis::Diagnosis diagnosis = diagnosis::diagnose(prepared, *model.study, {});
  EXPECT_FALSE(diagnosis.shrink_together.judged());
  ASSERT_FALSE(diagnosis.classes.empty());
  EXPECT_FALSE(diagnosis.classes.front().shrink.judged());
  ASSERT_FALSE(model.effects.added.empty());
  EXPECT_FALSE(model.effects.shrink.judged());
}

// The machine with nothing more hidden in it is one that may be: its interval is in the stated one.
TEST(OneDecision, TheStatedIntervalHoldsThatOfTheFit) {
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(simulation::simulate(springsAlone(52)));
  const extended_model::ExtendedModel model =
      extended_model::supportedModel(prepared, prepared.campaign, fewSubsets(2));
  for (const identification::Method which : identification::kMethods) {
    identification::StiffnessEstimate own = model.with.of(which).estimate;
    const std::vector<identification::CoverageInterval> stated = own.stated;
    own.parts.effects.setZero();
    own.covariance = own.parts.total();
    for (std::size_t j = 0; j < stated.size(); ++j) {
      if (!own.identifiable[j]) continue;
      const int joint = static_cast<int>(j);
      const double half = identification::kNormalFactor * identification::coveringSd(own, joint);
      EXPECT_LE(stated[j].low, own.compliance[joint] - 0.999 * half) << j;
      EXPECT_GE(stated[j].high, own.compliance[joint] + 0.999 * half) << j;
    }
  }
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
