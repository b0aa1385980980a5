#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include "core/campaign/read_campaign.h"
#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/effect_distance.h"
#include "core/preparation/subsample.h"
#include "reports/words/effect_words.h"
#include "reports/words/remark_words.h"

// The practice campaigns kept beside the checkout: made by another simulator, their causes in answers.csv.

namespace stiffscope {
namespace practice_test {

std::filesystem::path shared(const std::string& folder) {
  return std::filesystem::path(STIFFSCOPE_SHARED_DIR) / folder;
}

struct Answer {
  std::string campaign, detail;
  std::set<std::string> effects;  ///< empty: none
};

std::vector<Answer> answers() {
  std::vector<Answer> all;
  std::ifstream file(shared("practice/answers.csv"));
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::stringstream cells(line);
    Answer answer;
    std::string effects, effect;
    std::getline(cells, answer.campaign, ',');
    std::getline(cells, effects, ',');
    std::getline(cells, answer.detail, ',');
    std::stringstream list(effects);
    while (std::getline(list, effect, '+')) {
      if (effect != "none") answer.effects.insert(effect);
    }
    all.push_back(answer);
  }
  return all;
}

/// Few resamples: verdicts do not depend on them, intervals are tested elsewhere.
diagnosis::DiagnoseOptions quick() {
  diagnosis::DiagnoseOptions options;
  options.resamples = 4;
  options.chance_draws = 20;
  return options;
}

class Practice : public testing::TestWithParam<Answer> {};

TEST_P(Practice, VerdictIsTheAnswer) {
  const Answer& answer = GetParam();
  const diagnosis::Diagnosis diagnosis =
      diagnosis::diagnose(campaign::readCampaign(shared("practice/" + answer.campaign)).campaign, quick());
  ASSERT_TRUE(diagnosis.usable) << reports::words(diagnosis.unusable_reason);
  // Springs explain most of every deflection, also of one that is judged as it was read, by a tracker that moved.
  EXPECT_LT(diagnosis.gap.before, 0.5 * diagnosis.gap.deflection);
  std::set<std::string> found;
  bool detail = answer.detail.empty();
  for (const diagnosis::VerdictEntry& entry : diagnosis.verdict.entries) {
    ASSERT_LE(entry.effects.size(), 3u) << "a class that names everything says nothing";
    found.insert(entry.effects.empty() ? "unknown" : std::string(effects::idOf(entry.effects.front())));
    detail |= entry.detail == answer.detail;
  }
  EXPECT_EQ(found, answer.effects) << reports::reasonWords(diagnosis.verdict);
  EXPECT_TRUE(detail) << "expected to name " << answer.detail;
  if (!answer.effects.empty() && !diagnosis.classes.empty()) {
    EXPECT_TRUE(diagnosis.classes.front().in_verdict);
  }
}

INSTANTIATE_TEST_SUITE_P(Campaigns, Practice, testing::ValuesIn(answers()),
                         [](const testing::TestParamInfo<Answer>& info) { return "c" + info.param.campaign; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Practice);

TEST(RealCable, ClaimsNoMoreThanATiltOrABendAndSaysThatMostIsUnknown) {
  if (!std::filesystem::exists(shared("real/fanuc-r2000ic-cable")))
    GTEST_SKIP() << "the real campaigns are not beside the checkout";
  const diagnosis::Diagnosis diagnosis =
      diagnosis::diagnose(campaign::readCampaign(shared("real/fanuc-r2000ic-cable")).campaign, quick());
  ASSERT_TRUE(diagnosis.usable);
  // Six stiffnesses leave 0.220 mm per coordinate, fitted plainly; whitened ones a little more.
  EXPECT_NEAR(diagnosis.gap.before, 0.22e-3, 0.02e-3);
  bool unknown = false;
  for (const diagnosis::VerdictEntry& entry : diagnosis.verdict.entries) {
    if (entry.effects.empty()) {
      unknown = true;
      continue;
    }
    const std::set<effects::Effect> effects(entry.effects.begin(), entry.effects.end());
    EXPECT_EQ(effects, (std::set<effects::Effect>{effects::Effect::bearing_tilt, effects::Effect::link_compliance}));
  }
  EXPECT_TRUE(unknown);
  ASSERT_FALSE(diagnosis.classes.empty());
  EXPECT_GT(diagnosis.classes.front().shrink.value, 0.1);  // about a fifth on postures held out
  EXPECT_LT(diagnosis.classes.front().shrink.value, 0.35);
  // One point, one load step, displacements only.
  std::set<effects::Effect> not_testable;
  for (const diagnosis::NotTestable& one : diagnosis.not_testable) not_testable.insert(one.effect);
  for (const effects::Effect effect :
       {effects::Effect::joint_hardening, effects::Effect::hysteresis, effects::Effect::target_motion,
        effects::Effect::frame_error, effects::Effect::kinematic_error, effects::Effect::tracker_drift}) {
    EXPECT_TRUE(not_testable.count(effect)) << effects::idOf(effect);
  }
}

// 03 is one effect of the vocabulary, within a noise of what that effect's equations can do; 20 is two, hysteresis and
// a bias, and no one of the sixteen reaches it.
TEST(PracticeDistance, OneEffectIsNearAndTwoAreFar) {
  if (!std::filesystem::exists(shared("practice")))
    GTEST_SKIP() << "the practice campaigns are not beside the checkout";
  const auto few = [](const char* name) {
    return preparation::evenlySpread(campaign::readCampaign(shared(std::string("practice/") + name)).campaign, 8);
  };
  diagnosis::DiagnoseOptions tilt;
  tilt.resamples = tilt.chance_draws = 0;
  tilt.only = effects::Effect::bearing_tilt;
  const diagnosis::Diagnosis near = diagnosis::diagnose(few("03"), tilt);
  EXPECT_LT(near.gap.after, 1.4 * near.gap.noise);
  EXPECT_LT(near.positions.after, 1.4 * near.positions.noise);
  tilt.only = effects::Effect::hysteresis;
  const diagnosis::Diagnosis far = diagnosis::diagnose(few("03"), tilt);
  EXPECT_GT(far.gap.after, 2.3 * far.gap.noise);
  EXPECT_GT(diagnosis::distanceFromVocabulary(few("20")), 2.0);
}

}  // namespace practice_test
}  // namespace stiffscope
