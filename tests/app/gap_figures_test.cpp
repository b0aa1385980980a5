// The pictures of the diagnosis, from a diagnosis made by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include "app/figures/arm_scenes.h"
#include "app/figures/figures.h"
#include "core/campaign/read_campaign.h"
#include "core/diagnosis/diagnose.h"
#include "core/effects/remarks.h"
#include "reports/words/effect_words.h"
#include "reports/words/numbers.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace gap_figures_test {

/// bearing_tilt of joints 2 and 3 is present and can look like link_compliance; hysteresis is not testable.
diagnosis::Diagnosis byHand() {
  diagnosis::Diagnosis diagnosis(6);
  diagnosis.usable = true;
  diagnosis.verdict.entries = {{{effects::Effect::bearing_tilt}, "joint 2, joint 3"}};
  diagnosis.aliases = {{effects::Effect::link_compliance, effects::Effect::bearing_tilt}};
  for (std::size_t e = 0; e < effects::kEffectCount; ++e)
    diagnosis.detectable.push_back({static_cast<effects::Effect>(e), 1e-6 * static_cast<double>(e + 1)});
  diagnosis.detectable[static_cast<std::size_t>(effects::Effect::hysteresis)].size.reset();
  diagnosis.not_testable = {{effects::Effect::hysteresis, Remark(effects::RemarkId::hysteresis_needs_return_to_zero)}};
  diagnosis.size_limit = 5e-6;
  for (int pose = 0; pose < 3; ++pose) {
    for (int target = 0; target < 3; ++target)
      diagnosis.at_points.push_back(
          {pose, target, {}, Eigen::Vector3d(0, 1e-4 * (pose + 1), 0), Eigen::Vector3d(0, 0, 1e-5)});
  }
  for (const char* pose : {"A", "B", "C"}) {
    if (diagnosis.where.empty()) diagnosis.where = diagnosis.where_after = {{"posture", {}}};
    diagnosis.where[0].rows.push_back({pose, 1e-4, 1e-5});
    diagnosis.where_after[0].rows.push_back({pose, 1.1e-5, 1e-5});
  }
  return diagnosis;
}

struct Shown {
  SmallResult small;
  diagnosis::Diagnosis diagnosis = byHand();
  reports::ReportCampaign one{small.campaign, small.identification, nullptr, nullptr, nullptr, &diagnosis};
};

TEST(EffectClasses, ARowAnEffectAndALineAClass) {
  const Shown shown;
  const auto chart = app::effectClasses(shown.one);
  ASSERT_TRUE(chart.has_value());
  ASSERT_EQ(chart->rows.size(), effects::kEffectCount);
  EXPECT_EQ(chart->rows[1].name, "bearing tilt");
  EXPECT_TRUE(chart->rows[1].marked);
  EXPECT_NEAR(chart->rows[1].size, 2.0, 1e-12);
  EXPECT_EQ(chart->groups, (std::vector<std::vector<std::size_t>>{{0, 1}}));
  const render::DotRow& hysteresis = chart->rows[static_cast<std::size_t>(effects::Effect::hysteresis)];
  EXPECT_TRUE(std::isnan(hysteresis.size));
  EXPECT_EQ(hysteresis.words, "not testable: no return to zero");
  EXPECT_NEAR(chart->reference, 5.0, 1e-12);
  const std::string caption = app::describeEffectClasses(shown.one).caption;
  EXPECT_NE(caption.find("link compliance or bearing tilt"), std::string::npos) << caption;
  EXPECT_NE(caption.find("1 of 17"), std::string::npos) << caption;
}

TEST(GapScene, BeforeAndAfterToOneScaleSeenAlike) {
  const Shown shown;
  const auto scenes = app::gapScenes(shown.one);
  ASSERT_TRUE(scenes.has_value());
  ASSERT_EQ(scenes->before.poses.size(), 3u);
  EXPECT_EQ(scenes->before.magnification, scenes->after.magnification);
  EXPECT_NEAR(scenes->before.poses[2].targets[0].residual->y(), 3e-4, 1e-15);
  EXPECT_NEAR(scenes->after.poses[2].targets[0].residual->z(), 1e-5, 1e-15);
  EXPECT_NE(app::describeGapBefore(shown.one, *scenes).caption.find("300\u00a0µm, of P_{10} in posture C"),
            std::string::npos)
      << app::describeGapBefore(shown.one, *scenes).caption;
  EXPECT_NE(scenes->after.subtitle.find("bearing tilt (joints 2 and 3)"), std::string::npos) << scenes->after.subtitle;
}

TEST(GapScene, OfALongDayNoMoreArrowsThanPartEachOther) {
  // 1,000 postures, of which every tenth took part in the diagnosis: 300 arrows.
  Shown shown;
  std::vector<identification::LoadCase>& cases = shown.small.identification.cases;
  const std::vector<identification::LoadCase> three = cases;
  cases.clear();
  for (int pose = 0; pose < 1000; ++pose) {
    cases.push_back(three.front());
    cases.back().pose = pose;
    shown.small.campaign.pose_ids.push_back("");
  }
  shown.diagnosis.at_points.clear();
  for (int pose = 0; pose < 1000; pose += 10) {
    for (int target = 0; target < 3; ++target) {
      shown.diagnosis.at_points.push_back({pose, target, {}, {0, 1e-4, 0}, {0, 0, 1e-5}});
    }
  }
  const auto scenes = app::gapScenes(shown.one);
  ASSERT_TRUE(scenes.has_value());
  EXPECT_EQ(scenes->before.poses.size(), 25u);  // every fourth: 75 arrows, where 90 are the most

  // Two that are not among these are named by captions: they are drawn, too.
  shown.diagnosis.at_points[3 * 33].before = {0, 5e-4, 0};
  shown.diagnosis.at_points[3 * 34].after = {0, 0, 5e-5};
  const auto with_longest = app::gapScenes(shown.one);
  ASSERT_TRUE(with_longest.has_value());
  EXPECT_EQ(with_longest->before.poses.size(), 27u);
  EXPECT_NE(app::describeGapBefore(shown.one, *with_longest).caption.find("The picture has 27 of 1000 postures"),
            std::string::npos)
      << app::describeGapBefore(shown.one, *with_longest).caption;
}

TEST(GapScene, NothingToShowWhereNothingWasFound) {
  Shown shown;
  shown.diagnosis.verdict.entries.clear();
  EXPECT_FALSE(app::gapScenes(shown.one).has_value());
  EXPECT_EQ(app::gapBars(shown.one)->series.size(), 2u);  // stiffnesses alone and noise
}

TEST(GapBars, WhatTheStationMovedIsPartOfTheGapBefore) {
  Shown shown;
  EXPECT_DOUBLE_EQ(app::gapBars(shown.one)->series[0].values[1], 100.0);
  for (const char* pose : {"A", "B", "C"}) shown.diagnosis.as_measured.rows.push_back({pose, 5e-4, 1e-5});
  EXPECT_DOUBLE_EQ(app::gapBars(shown.one)->series[0].values[1], 500.0);
  EXPECT_NE(app::describeGapBars(shown.one).caption.find("readings as they were"), std::string::npos);
}

TEST(GapAtPoints, OfATrackerThatMovedTheGapBeforeIsOfTheReadingsAsTheyWere) {
  const std::filesystem::path folder = STIFFSCOPE_SHARED_DIR "/practice/13";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the practice campaigns are not here";
  const campaign::Campaign campaign = campaign::readCampaign(folder).campaign;
  diagnosis::DiagnoseOptions options;
  options.resamples = options.chance_draws = 20;  // neither is looked at
  const diagnosis::Diagnosis found = diagnosis::diagnose(campaign, options);
  ASSERT_EQ(found.as_measured.rows.size(), static_cast<std::size_t>(found.postures));
  double squares = 0.0;
  for (const diagnosis::WhereRow& row : found.as_measured.rows) squares += row.rms * row.rms;
  // Every posture has all its readings, so that the whole is the mean of the parts.
  EXPECT_NEAR(std::sqrt(squares / found.postures), found.gap.before, 1e-9);
  ASSERT_EQ(found.at_points.size(), 3u * static_cast<std::size_t>(found.postures));
  double before = 0.0, after = 0.0;
  for (const diagnosis::PointGap& gap : found.at_points)
    before += gap.before.squaredNorm(), after += gap.after.squaredNorm();
  // The state of each posture that leaves the most leaves more than all of its states in the mean.
  EXPECT_GT(std::sqrt(before / 3.0 / static_cast<double>(found.at_points.size())), found.gap.before);
  EXPECT_LT(after, 0.1 * before);  // the nests take the station's motion off
}

TEST(EffectWords, EveryEffectHasAMeaningAndARemedy) {
  for (std::size_t e = 0; e < effects::kEffectCount; ++e) {
    const auto effect = static_cast<effects::Effect>(e);
    EXPECT_GT(reports::effectMeaning(effect).size(), 10u) << e;
    EXPECT_GT(reports::effectRemedy(effect).size(), 10u) << e;
    EXPECT_GT(reports::effectUse(effect).size(), 10u) << e;
    EXPECT_EQ(reports::effectName(effect).find('_'), std::string::npos);
  }
}

TEST(EffectWords, JointsInShort) {
  EXPECT_EQ(reports::shortDetail("joint 1, joint 2, joint 3"), "joints 1 to 3");
  EXPECT_EQ(reports::shortDetail("joint 1, joint 2, joint 4"), "joints 1, 2 and 4");
  EXPECT_EQ(reports::shortDetail("joint 4 or joint 3"), "joint 4 or joint 3");
  EXPECT_EQ(reports::shortDetail("joint 4"), "joint 4");
  EXPECT_EQ(reports::shortDetail("P12"), "P12");
  diagnosis::Verdict verdict;
  EXPECT_EQ(reports::presentWords(verdict), "nothing");
  verdict.entries = {{{}, ""}};
  EXPECT_EQ(reports::presentWords(verdict), "something that no known effect explains");
  EXPECT_TRUE(reports::namedWords(verdict).empty());
}

TEST(WithMicro, WholeWordsOnly) {
  EXPECT_EQ(reports::withMicro("by 31 um and 3 urad, 0.3 +- 0.1 um/min"), "by 31 µm and 3 µrad, 0.3 ± 0.1 µm/min");
  EXPECT_EQ(reports::withMicro("maximum sum of drum_1"), "maximum sum of drum_1");
}

}  // namespace gap_figures_test
}  // namespace stiffscope
