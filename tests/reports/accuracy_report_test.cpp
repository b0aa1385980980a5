// JSON and text of the diagnosis of a day without a load.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/accuracy/diagnose_accuracy.h"
#include "reports/json/json.h"
#include "reports/text/text.h"
#include "reports/words/accuracy_words.h"
#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace accuracy_report_test {

/// A day whose joint 5 has a wave twice a turn.
struct DiagnosedDay {
  campaign::Campaign campaign;
  accuracy::AccuracyDiagnosis accuracy;

  explicit DiagnosedDay(double wave = 0.5e-3) {
    Noise noise(51);
    UnloadedSpec spec;
    spec.built = spec.nominal.disturbed(noise, 0.2e-3, 0.1e-3);
    spec.postures = 80;
    spec.joint_errors = [wave](const JointVector& q) {
      return JointVector(wave * std::sin(2.0 * q[4]) * JointVector::Unit(6, 4));
    };
    campaign = unloadedCampaign(spec, noise);
    accuracy = accuracy::diagnoseAccuracy(campaign);
  }

  reports::Json json() const { return reports::accuracyJson(campaign, accuracy); }
  std::string text() const { return reports::accuracyText(campaign, accuracy); }
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(AccuracyJson, HasWhatOtherProgramsRead) {
  const reports::Json json = DiagnosedDay().json();
  EXPECT_EQ(json["usable"], true);
  EXPECT_EQ(json["verdict"], reports::Json::parse(R"([["transmission_error"]])"));
  EXPECT_EQ(json["verdict_details"], reports::Json::parse(R"(["joint 5"])"));
  for (const char* key : {"reason", "classes", "gap", "detectable_um", "not_testable", "where", "next"})
    EXPECT_TRUE(json.contains(key)) << key;
  ASSERT_FALSE(json["classes"].empty());
  const reports::Json& one = json["classes"][0];
  for (const char* key : {"effects", "detail", "score", "size_um", "shrink", "explained", "in_verdict", "parameters"})
    EXPECT_TRUE(one.contains(key)) << key;
  for (const char* key : {"value", "low", "high"}) EXPECT_TRUE(one["shrink"][key].is_number()) << key;
  for (const char* key : {"nominal_um", "before_um", "noise_um", "after_um"})
    EXPECT_GT(json["gap"][key].get<double>(), 0.0) << key;
  EXPECT_TRUE(json["where"].contains("reflector"));
  EXPECT_TRUE(json["where"]["joint"].is_array());
  EXPECT_GT(json["detectable_um"]["target_motion"].get<double>(), 0.0);
}

TEST(AccuracyJson, TermsHaveSizesAndUnits) {
  const reports::Json json = DiagnosedDay().json();
  const reports::Json& part = json["classes"][0]["parameters"][0];
  EXPECT_EQ(part["detail"], "joint 5");
  EXPECT_TRUE(part["order"].is_number());
  ASSERT_EQ(part["terms"].size(), 2u);
  for (const reports::Json& term : part["terms"]) {
    EXPECT_EQ(term["unit"], "rad");
    EXPECT_GT(term["sd"].get<double>(), 0.0);
  }
}

/// A link bends by weights that somebody states; joints also by products of weight and compliance.
TEST(AccuracyJson, WhatCannotBeTestedHasItsReason) {
  DiagnosedDay day;
  for (robot::BodyMass& body : day.campaign.robot.bodies) body = {};
  day.accuracy = accuracy::diagnoseAccuracy(day.campaign);
  const reports::Json json = day.json();
  EXPECT_FALSE(json["detectable_um"].contains("link_compliance"));
  ASSERT_TRUE(json["not_testable"].contains("link_compliance"));
  EXPECT_TRUE(has(json["not_testable"]["link_compliance"].get<std::string>(), "masses"));
  EXPECT_TRUE(json["detectable_um"].contains("joint_compliance"));
}

TEST(AccuracyJson, ACleanDaySaysNoneAndADayThatIsNoneSaysWhy) {
  DiagnosedDay day(0.0);
  EXPECT_EQ(day.json()["verdict"], reports::Json::parse(R"([["none"]])"));
  day.campaign.loading.reset();
  day.accuracy = accuracy::diagnoseAccuracy(day.campaign);
  const reports::Json json = day.json();
  EXPECT_EQ(json["usable"], false);
  EXPECT_FALSE(json["reason"].get<std::string>().empty());
  EXPECT_FALSE(json.contains("verdict"));
}

TEST(AccuracyText, AnswersWhichHowFarAndWhere) {
  const std::string text = DiagnosedDay().text();
  for (const char* words :
       {"Verdict: transmission error (joint 5)", "How far: gap of the positions", "geometry calibrated",
        "noise of the readings", "Which: candidates", "Where the gap lies", "Smallest size that would have been seen"})
    EXPECT_TRUE(has(text, words)) << words;
  EXPECT_FALSE(has(text, "nan"));
}

TEST(AccuracyText, WhatStandsBehindPlusMinusIsU) {
  const DiagnosedDay day;
  const accuracy::AccuracyClass& named = day.accuracy.classes.front();
  ASSERT_FALSE(named.sds.empty());
  EXPECT_TRUE(has(day.text(), "on postures held out; +- U, 95 %"));
  EXPECT_TRUE(has(day.text(), fmt::format("{:.4g} +- {:.2g} ", named.sizes[0], 1.96 * named.sds[0]))) << day.text();
}

TEST(AccuracyText, ACleanDayHasNoCandidates) {
  const std::string text = DiagnosedDay(0.0).text();
  EXPECT_TRUE(has(text, "Verdict: none"));
  EXPECT_TRUE(has(text, "gap of the positions"));
  EXPECT_FALSE(has(text, "Which: candidates"));
}

/// Of fewer than twenty postures no effect was asked for: nothing says that the vocabulary has none.
TEST(AccuracyText, EffectsThatWereNotAskedForAreNotDenied) {
  DiagnosedDay day;
  day.accuracy = accuracy::AccuracyDiagnosis();
  day.accuracy.usable = true;
  day.accuracy.effects_asked = false;
  day.accuracy.postures = 12;
  day.accuracy.verdict = {{{calibration::UnloadedEffect::kinematic_error}, ""}, {{}, ""}};
  day.accuracy.reasons = {Remark(accuracy::RemarkId::effects_not_asked, 12, 20)};
  day.accuracy.next = {Remark(accuracy::RemarkId::measure_enough, 20)};
  const std::string text = day.text();
  for (const char* words :
       {"unknown (effects were not asked for: 12 postures", "Effects were not asked for: 12 postures",
        "seen: none, no effect was asked for", "Measure at least 20 postures"})
    EXPECT_TRUE(has(text, words)) << words << text;
  const std::string finding = reports::accuracyFinding(day.accuracy);
  EXPECT_TRUE(has(finding, "whose cause was not asked for: 12 postures, which takes 20")) << finding;
  EXPECT_FALSE(has(finding, "no known effect")) << finding;
  const std::vector<std::string> actions = reports::accuracyActions(day.accuracy);
  ASSERT_EQ(actions.size(), 2u);  // the geometry's, and more postures
  EXPECT_TRUE(actions.back().starts_with("Measure at least 20 postures"));
}

/// What is left with all effects is not what is left with the verdict's where that names fewer.
TEST(AccuracyText, SaysWhichEffectsTheRestIsStatedWith) {
  DiagnosedDay day;
  EXPECT_TRUE(has(reports::accuracyFigures(day.accuracy), "With the verdict's effects in the model"));
  EXPECT_FALSE(has(day.text(), "effects in the model, also those"));
  day.accuracy.verdict.clear();
  day.accuracy.verdict.push_back({{}, ""});
  const std::string figures = reports::accuracyFigures(day.accuracy);
  EXPECT_TRUE(has(figures,
                  "With all fitted effects in the model, also those that the verdict does not name "
                  "(transmission error),"))
      << figures;
  EXPECT_FALSE(has(figures, "the verdict's effects"));
  EXPECT_TRUE(has(day.text(), "effects in the model, also those that the verdict does not name: transmission error"));
}

TEST(AccuracyWords, StiffnessesOfACandidateAreDoubted) {
  accuracy::AccuracyDiagnosis accuracy;
  accuracy.usable = true;
  accuracy::AccuracyClass one;
  one.effects = {calibration::UnloadedEffect::joint_compliance};
  one.parts.push_back({calibration::UnloadedEffect::joint_compliance, "joint 2"});
  one.in_verdict = true;
  accuracy.classes = {one};
  EXPECT_EQ(reports::stiffnessDoubt(accuracy), "");
  accuracy.classes[0].in_verdict = false;
  EXPECT_TRUE(has(reports::stiffnessDoubt(accuracy), "joint compliance is a candidate only"));
  accuracy.classes[0].effects.push_back(calibration::UnloadedEffect::base_compliance);
  EXPECT_TRUE(has(reports::stiffnessDoubt(accuracy), "base compliance would explain the same"));
}

TEST(AccuracyWords, WhatToDoRefersToWhatIsOnThePage) {
  DiagnosedDay day;
  day.accuracy.verdict.push_back({{}, ""});
  for (const std::string& action : reports::accuracyActions(day.accuracy))
    EXPECT_FALSE(has(action, "figures above") || has(action, "the named joint")) << action;
}

}  // namespace accuracy_report_test
}  // namespace stiffscope
