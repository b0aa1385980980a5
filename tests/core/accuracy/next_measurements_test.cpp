#include "core/accuracy/where_next.h"

#include <gtest/gtest.h>

namespace stiffscope {
namespace next_measurements_test {

using accuracy::AccuracyDiagnosis;
using accuracy::AccuracyEntry;
using accuracy::RemarkId;
using calibration::UnloadedEffect;

Remark asked(RemarkId what, std::vector<std::string> ids) { return Remark(what, std::move(ids)); }

TEST(NextMeasurements, AVerdictOfOneEffectAsksForNothing) {
  AccuracyDiagnosis diagnosis;
  diagnosis.verdict.push_back({{UnloadedEffect::tracker_drift}, ""});
  EXPECT_TRUE(accuracy::nextMeasurements(diagnosis).empty());
}

// Own weight turns joints and bends links alike: one measurement under load tells both from a gear, which shows in more
// shapes of the arm.
TEST(NextMeasurements, EffectsThatAreNotToldApartShareTheMeasurementThatTellsThem) {
  AccuracyDiagnosis diagnosis;
  diagnosis.verdict.push_back(
      {{UnloadedEffect::joint_compliance, UnloadedEffect::transmission_error, UnloadedEffect::link_compliance}, ""});
  diagnosis.verdict.push_back({{UnloadedEffect::link_compliance, UnloadedEffect::bearing_tilt}, ""});
  const std::vector<Remark> next = accuracy::nextMeasurements(diagnosis);
  ASSERT_EQ(next.size(), 2u);
  EXPECT_EQ(next[0], asked(RemarkId::measure_under_load, {"joint_compliance", "link_compliance", "bearing_tilt"}));
  EXPECT_EQ(next[1], asked(RemarkId::measure_more_postures, {"transmission_error"}));
}

TEST(NextMeasurements, CandidatesAndWhatIsNotTestableAreAskedFor) {
  AccuracyDiagnosis diagnosis;
  accuracy::AccuracyClass candidate, named;
  candidate.effects = {UnloadedEffect::backlash, UnloadedEffect::scale_error};
  named.effects = {UnloadedEffect::target_motion};
  named.in_verdict = true;
  diagnosis.classes = {named, candidate};
  diagnosis.not_testable.push_back({UnloadedEffect::thermal_growth, Remark()});
  const std::vector<Remark> next = accuracy::nextMeasurements(diagnosis);
  ASSERT_EQ(next.size(), 2u);
  EXPECT_EQ(next[0], asked(RemarkId::measure_moves, {"backlash"}));
  EXPECT_EQ(next[1], asked(RemarkId::measure_temperature, {"thermal_growth"}));
}

TEST(NextMeasurements, AnUnknownCauseIsSoughtByRepeatsAndShapes) {
  AccuracyDiagnosis diagnosis;
  diagnosis.verdict.push_back({{}, ""});
  diagnosis.not_testable.push_back({UnloadedEffect::kinematic_error, Remark()});
  const std::vector<Remark> next = accuracy::nextMeasurements(diagnosis);
  ASSERT_EQ(next.size(), 2u);
  EXPECT_EQ(next[0], asked(RemarkId::measure_more_postures, {"kinematic_error", "unknown"}));
  EXPECT_EQ(next[1], asked(RemarkId::measure_repeats, {"unknown"}));
}

TEST(NextMeasurements, WhatWasNotAskedForTakesMorePostures) {
  AccuracyDiagnosis diagnosis;
  diagnosis.effects_asked = false;
  diagnosis.verdict.push_back({{}, ""});
  EXPECT_EQ(accuracy::nextMeasurements(diagnosis), std::vector{Remark(RemarkId::measure_enough, 20)});
}

}  // namespace next_measurements_test
}  // namespace stiffscope
