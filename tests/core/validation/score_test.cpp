#include "core/validation/score.h"
#include <gtest/gtest.h>
#include "core/io/input_error.h"

namespace stiffscope {

namespace score_test {

validation::Label single(const std::string& name, const std::string& effect, double size,
                         const std::string& detail = "") {
  validation::Label label;
  label.name = name;
  label.kind = validation::CaseKind::single;
  label.effects = {{effect, detail, "deflection", size, size, 0.0}};
  label.shrink = 0.9;
  label.shrink_seen = 0.5;
  return label;
}

validation::Answer says(const std::string& name, std::vector<std::vector<std::string>> entries,
                        const std::string& detail = "") {
  validation::Answer answer;
  answer.name = name;
  for (auto& effects : entries) answer.entries.push_back({std::move(effects), detail});
  return answer;
}

// 0 of 10: 1 - 0.025^(1/10). 5 of 10: 18.71 % to 81.29 %, and 81 of 263: 25.27 % to 36.76 % (A. Agresti and
// B. A. Coull, The American Statistician 52, 1998, give the former; the latter is that of the 1934 paper's
// method as R's binom.test prints it).
TEST(BlindInterval, tableValues) {
  const numerics::Rate none = numerics::binomialRate(0, 10);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 0.3084971, 1e-7);
  const numerics::Rate half = numerics::binomialRate(5, 10);
  EXPECT_NEAR(half.low, 0.1870860, 1e-7);
  EXPECT_NEAR(half.high, 0.8129140, 1e-7);
  const numerics::Rate all = numerics::binomialRate(10, 10);
  EXPECT_NEAR(all.low, 1 - 0.3084971, 1e-7);
  EXPECT_EQ(all.high, 1.0);
  EXPECT_EQ(numerics::binomialRate(0, 0).high, 1.0);
  EXPECT_THROW(numerics::binomialRate(3, 2), std::invalid_argument);
}

// The interval holds the truth at least 95 times in a hundred, whatever the truth: P over all outcomes.
TEST(BlindInterval, holdsTheTruthOftenEnough) {
  const int trials = 25;
  for (const double share : {0.03, 0.2, 0.5, 0.91}) {
    double held = 0.0, probability = std::pow(1 - share, trials);
    for (int hits = 0; hits <= trials; ++hits) {
      const numerics::Rate rate = numerics::binomialRate(hits, trials);
      if (rate.low <= share && share <= rate.high) held += probability;
      probability *= share / (1 - share) * (trials - hits) / (hits + 1);
    }
    EXPECT_GE(held, 0.95) << share;
  }
}

TEST(BlindScore, singlesByHand) {
  const std::vector<validation::Label> labels{single("1", "hysteresis", 0.7), single("2", "hysteresis", 3.0),
                                              single("3", "bearing_tilt", 6.0), single("4", "backlash", 6.0),
                                              single("5", "joint_coupling", 8.0, "joints 2 and 3")};
  const std::vector<validation::Answer> answers{says("1", {}), says("2", {{"hysteresis"}, {"base_compliance"}}),
                                                says("3", {{"link_compliance", "bearing_tilt"}}), says("4", {{}}),
                                                says("5", {{"joint_coupling"}}, "joints 2 and 3")};
  const validation::Score result = validation::score(labels, answers);
  EXPECT_EQ(result.rate("singles").hits, 2);
  EXPECT_EQ(result.rate("singles").trials, 5);
  EXPECT_EQ(result.rate("singles_from_2").trials, 4);
  EXPECT_EQ(result.rate("singles_from_5").hits, 2);
  EXPECT_EQ(result.rate("singles_from_5").trials, 3);
  EXPECT_EQ(result.rate("singles_found_from_2").hits, 3);  // the one with something beside it too
  EXPECT_EQ(result.rate("detail").hits, 1);
  const auto& confusion = result.confusion;
  const auto at = [&](const std::string& truth, const std::string& said) {
    const auto row = std::find(confusion.truths.begin(), confusion.truths.end(), truth);
    const auto column = std::find(confusion.answers.begin(), confusion.answers.end(), said);
    return confusion.counts.at(static_cast<std::size_t>(row - confusion.truths.begin()))
        .at(static_cast<std::size_t>(column - confusion.answers.begin()));
  };
  EXPECT_EQ(at("hysteresis", "none"), 1);
  EXPECT_EQ(at("hysteresis", "several"), 1);
  EXPECT_EQ(at("bearing_tilt", "bearing_tilt"), 1);  // its class
  EXPECT_EQ(at("backlash", "unknown"), 1);
  const auto of = [&](const std::string& effect) {
    return *std::find_if(result.effects.begin(), result.effects.end(),
                         [&](const auto& one) { return one.id == effect; });
  };
  EXPECT_EQ(of("bearing_tilt").mean_class_size, 2.0);
  EXPECT_EQ(of("hysteresis").answered_none, 1);
  EXPECT_EQ(result.by_size[0].rate.trials, 1);
  EXPECT_EQ(result.by_size[3].rate.hits, 2);
}

TEST(BlindScore, cleanUnknownAndDoublesByHand) {
  std::vector<validation::Label> labels(6);
  for (std::size_t i = 0; i < labels.size(); ++i) labels[i].name = std::to_string(i);
  labels[1].noise_factor = 1.2;
  labels[2].kind = labels[3].kind = validation::CaseKind::outside;
  labels[2].effects = {{"creep", "creep", "deflection", 4.0, 4.0, 0.0}};
  labels[3].effects = {{"refraction", "refraction", "nests", 4.0, 0.0, 4.0}};
  labels[4].kind = labels[5].kind = validation::CaseKind::pair;
  labels[4].effects = labels[5].effects = {{"hysteresis", "", "deflection", 4.0, 4.0, 0.0},
                                           {"load_cell_bias", "", "deflection", 4.0, 4.0, 0.0}};
  const std::vector<validation::Answer> answers{says("0", {}),
                                                says("1", {{"backlash"}}),
                                                says("2", {{"backlash"}, {}}),
                                                says("3", {{"tracker_drift"}}),
                                                says("4", {{"load_cell_bias", "backlash"}, {"hysteresis"}}),
                                                says("5", {{"hysteresis"}})};
  const validation::Score result = validation::score(labels, answers, {{"2", 2.5}, {"3", 0.4}});
  EXPECT_EQ(result.rate("unknown_apart").trials, 1);  // the other one is what a drift can do
  EXPECT_EQ(result.rate("unknown_apart").hits, 0);    // a wrong name stands beside it
  EXPECT_EQ(result.rate("false_alarms").hits, 1);
  EXPECT_EQ(result.rate("false_alarms_noise_right").hits, 0);
  EXPECT_EQ(result.rate("false_alarms_noise_right").trials, 1);
  EXPECT_EQ(result.rate("false_alarms_noise_wrong").hits, 1);
  EXPECT_EQ(result.rate("unknown").hits, 0);
  EXPECT_EQ(result.rate("unknown").trials, 2);
  EXPECT_FALSE(result.cases[2].found);  // unknown was said, and a wrong name
  EXPECT_FALSE(result.cases[2].right);
  EXPECT_EQ(result.rate("outside_wrong_name").hits, 2);
  EXPECT_EQ(result.rate("outside_unknown_beside").hits, 1);
  EXPECT_EQ(result.rate("doubles_both_found").hits, 1);
  EXPECT_EQ(result.rate("doubles").hits, 1);
  EXPECT_EQ(result.rate("doubles_one_found").hits, 2);
}

// Unknown alone is the answer to what the vocabulary does not have.
TEST(BlindScore, unknownAloneIsRight) {
  std::vector<validation::Label> labels(1);
  labels[0].name = "1";
  labels[0].kind = validation::CaseKind::outside;
  labels[0].effects = {{"creep", "creep", "deflection", 4.0, 4.0, 0.0}};
  const validation::Score result = validation::score(labels, {says("1", {{}})});
  EXPECT_TRUE(result.cases[0].right);
  EXPECT_EQ(result.rate("unknown").hits, 1);
  EXPECT_EQ(result.rate("outside_wrong_name").hits, 0);
}

// Both in one class, and something beside it that is not there: as many entries as effects, and yet wrong.
TEST(BlindScore, aDoubleWithAWrongNameOrUnknownIsWrong) {
  validation::Label label;
  label.kind = validation::CaseKind::pair;
  label.effects = {{"hysteresis", "", "deflection", 4.0, 4.0, 0.0}, {"backlash", "", "deflection", 4.0, 4.0, 0.0}};
  std::vector<validation::Label> labels(3, label);
  for (std::size_t i = 0; i < labels.size(); ++i) labels[i].name = std::to_string(i);
  const std::vector<validation::Answer> answers{says("0", {{"hysteresis", "backlash"}}),
                                                says("1", {{"hysteresis", "backlash"}, {"frame_error"}}),
                                                says("2", {{"hysteresis", "backlash"}, {}})};
  const validation::Score result = validation::score(labels, answers);
  EXPECT_TRUE(result.cases[0].right);
  EXPECT_FALSE(result.cases[1].right);
  EXPECT_FALSE(result.cases[2].right);
  EXPECT_EQ(result.rate("doubles_both_found").hits, 3);
}

TEST(BlindScore, machinesAsTheyAreByHand) {
  validation::Label label;
  label.kind = validation::CaseKind::as_is;
  label.effects = {{"bearing_tilt", "joints 1 to 6", "deflection", 6.0, 6.0, 0.0},
                   {"link_compliance", "", "deflection", 1.0, 1.0, 0.0}};
  std::vector<validation::Label> labels(6, label);
  for (std::size_t i = 0; i < labels.size(); ++i) labels[i].name = std::to_string(i);
  const std::vector<validation::Answer> answers{
      says("0", {{"bearing_tilt"}}),                           // the one that can be seen
      says("1", {{"bearing_tilt"}, {"link_compliance"}}),      // both
      says("2", {{"joint_coupling", "link_compliance"}, {}}),  // in a class, and that more is left
      says("3", {{"bearing_tilt"}, {"frame_error"}}),          // and one that is not there
      says("4", {{"joint_coupling"}, {}}),                     // unknown beside a wrong name
      says("5", {})};
  const validation::Score result = validation::score(labels, answers);
  const std::vector<bool> right{true, true, true, false, false, false};
  for (std::size_t i = 0; i < right.size(); ++i) EXPECT_EQ(result.cases[i].right, right[i]) << i;
  EXPECT_EQ(result.rate("as_is").hits, 3);
  EXPECT_EQ(result.rate("as_is").trials, 6);
  EXPECT_EQ(result.rate("as_is_wrong_name").hits, 2);
  EXPECT_EQ(result.rate("as_is_unknown").hits, 2);
  EXPECT_EQ(result.rate("as_is_none").hits, 1);
  EXPECT_EQ(result.rate("as_is_effects").hits, 5);  // bearings thrice, links twice
  EXPECT_EQ(result.rate("as_is_effects").trials, 12);
  EXPECT_EQ(result.rate("as_is_effects_from_2").hits, 3);
  EXPECT_EQ(result.rate("as_is_effects_from_2").trials, 6);
  ASSERT_EQ(result.as_is.size(), 2u);
  EXPECT_EQ(result.as_is[0].id, "link_compliance");
  EXPECT_EQ(result.as_is[0].mean_class_size, 1.5);
  EXPECT_EQ(result.as_is[1].all.hits, 3);
  EXPECT_EQ(result.rate("singles").trials, 0);
}

TEST(BlindScore, shrinkIsHeldAgainstWhatCanBeSeen) {
  const std::vector<validation::Label> labels{single("1", "hysteresis", 3.0), single("2", "hysteresis", 3.0)};
  std::vector<validation::Answer> answers{says("1", {{"hysteresis"}}), says("2", {{"hysteresis"}})};
  answers[0].promises = {{{"backlash"}, 0.1, 0.0, 0.2, 0.1}, {{"hysteresis"}, 0.48, 0.4, 0.55, 0.9}};
  answers[1].promises = {{{"hysteresis"}, 0.85, 0.8, 0.95, 0.9}};
  const validation::Score result = validation::score(labels, answers);
  EXPECT_EQ(result.rate("shrink_covered").hits, 1);
  EXPECT_EQ(result.rate("shrink_covered").trials, 2);
  EXPECT_EQ(result.shrinks[0].promised, 0.48);
}

TEST(BlindScore, anAnswerThatFailedIsWrongEverywhere) {
  std::vector<validation::Label> labels{single("1", "hysteresis", 3.0)};
  std::vector<validation::Answer> answers{says("1", {})};
  answers[0].failure = "no states";
  const validation::Score result = validation::score(labels, answers);
  EXPECT_EQ(result.rate("failed").hits, 1);
  EXPECT_EQ(result.rate("singles").hits, 0);
  EXPECT_THROW(validation::score({single("2", "hysteresis", 1.0)}, answers), std::invalid_argument);
}

TEST(BlindTables, labelsAndAnswersSurviveWriting) {
  std::vector<validation::Label> labels{single("0001", "joint_coupling", 3.25, "joints 2 and 3"), {}};
  labels[0].noise_factor = 0.875;
  labels[0].arm = "m20ia";
  labels[0].stiffness = {2491720.5, 2e6, 1.5e6, 1e5, 9e4, 8e3};
  labels[1].name = "0002";
  labels[1].stiffness.assign(6, 0.0);
  const std::vector<validation::Label> read = validation::readLabels("labels.csv", validation::labelsCsv(labels));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].effects.at(0).detail, "joints 2 and 3");
  EXPECT_EQ(read[0].effects[0].size, 3.25);
  EXPECT_EQ(read[0].noise_factor, 0.875);
  EXPECT_EQ(read[0].stiffness, labels[0].stiffness);
  EXPECT_EQ(read[1].kind, validation::CaseKind::none);
  EXPECT_TRUE(read[1].effects.empty());

  diagnosis::Verdict verdict;
  verdict.entries = {{{effects::Effect::hysteresis, effects::Effect::backlash}, "joint 2, the way + back"}, {{}, ""}};
  diagnosis::EffectClass best;
  best.effects = {effects::Effect::hysteresis, effects::Effect::backlash};
  best.shrink = {0.5, 0.25, 0.75};
  const std::vector<diagnosis::EffectClass> classes{best};
  std::vector<validation::Answer> given{validation::answerOf(verdict, classes), {}};
  given[0].name = "0001";
  given[1].name = "0002";
  const std::vector<validation::Answer> frozen = validation::readAnswers("answers.csv", validation::answersCsv(given));
  ASSERT_EQ(frozen.size(), 2u);
  EXPECT_EQ(frozen[0].entries.at(0).effects, (std::vector<std::string>{"hysteresis", "backlash"}));
  EXPECT_EQ(frozen[0].entries[0].detail, "joint 2  the way   back");  // what separates is taken out
  EXPECT_TRUE(frozen[0].entries.at(1).effects.empty());
  EXPECT_EQ(frozen[0].promises.at(0).high, 0.75);
  EXPECT_TRUE(frozen[1].entries.empty());
}

TEST(BlindTables, refusesWhatIsNoLabel) {
  const std::string header = validation::labelsCsv({});
  const auto complaint = [&](const std::string& bytes) -> std::string {
    try {
      validation::readLabels("labels.csv", bytes);
    } catch (const io::InputError& error) {
      return error.what();
    }
    return "no complaint";
  };
  EXPECT_EQ(complaint(header + "1,nothing,,,,,,,0,0,1,0,a,b,1+2+3+4+5+6\n"),
            "labels.csv:2: kind: 'nothing': expected none, single, double, outside or as_is");
  EXPECT_EQ(complaint(header + "1,single,backlash,,deflection,,,,0,0,1,0,a,b,1+2+3+4+5+6\n"),
            "labels.csv:2: effects: 'backlash': expected as many effects as sizes");
  EXPECT_EQ(complaint(header + "1,none,,,,,,,0,0,1,0,a,b,1+2\n"),
            "labels.csv:2: stiffness_nm_per_rad: '1+2': expected 4 to 8 numbers joined by '+'");
  EXPECT_NE(complaint("case,kind\n").find("expected the header case,kind,effects"), std::string::npos);
}

}  // namespace score_test

}  // namespace stiffscope
