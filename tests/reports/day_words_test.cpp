#include "reports/words/day_words.h"
#include "reports/words/audit_plain.h"

#include <gtest/gtest.h>

namespace stiffscope::reports {
namespace {

audit::AuditReport auditOf(preparation::AuditVerdict verdict, const std::vector<std::string>& ids) {
  audit::AuditReport audit;
  audit.verdict = verdict;
  preparation::AuditCheck passed;
  passed.id = "completeness";
  audit.checks.push_back(passed);
  for (const std::string& id : ids) {
    preparation::AuditCheck check;
    check.id = id;
    check.verdict = verdict;
    audit.checks.push_back(check);
  }
  return audit;
}

TEST(DayWords, TheAuditsSentenceSaysWhetherTheReadingsServeAndWhatSpoilsThem) {
  using preparation::AuditVerdict;
  EXPECT_EQ(
      auditMeaning(auditOf(AuditVerdict::warn, {"repeat_outliers", "repeat_outliers", "lost_beam"}), DayKind::loaded),
      "The readings are good enough to identify stiffnesses from; the audit warns of 2 things (see @{Audit}).");
  EXPECT_EQ(
      auditMeaning(auditOf(AuditVerdict::fail, {"time_order"}), DayKind::unloaded),
      "The audit fails: load steps do not follow each other in time. As they were read, the readings are not fit to "
      "calibrate from.");
  EXPECT_EQ(auditMeaning(auditOf(AuditVerdict::fail,
                                 {"lost_beam", "time_order", "nest_outliers", "repeat_outliers", "completeness"}),
                         DayKind::loaded),
            "The audit fails by 5 checks. As they were read, the readings are not fit to identify stiffnesses from.");
}

TEST(DayWords, WhatUIsOfIsThatOfTheModel) {
  // Scales that the campaign declares are in the intervals of the default model, not in those of springs alone.
  const std::string springs = scopeWords(DayKind::loaded).front(),
                    model = scopeWords(DayKind::loaded, false, true).front();
  EXPECT_NE(springs.find("scales of load cell and tracker, of which no reading tells, are not in it"),
            std::string::npos);
  EXPECT_NE(model.find("the scales of load cell, tracker and masses where it declares them"), std::string::npos);
  EXPECT_NE(model.find("what effects in the model or beside it could still do"), std::string::npos);
}

// Acceptance limits are guarded by U: beside them it must not stand that uncertainty moves no limit.
TEST(DayWords, WithAcceptanceLimitsTheDecisionRuleDoesNotContradictTheirs) {
  for (const DayKind kind : {DayKind::loaded, DayKind::unloaded, DayKind::sweeps}) {
    constexpr bool kLimits = true;
    for (const std::string& item : scopeWords(kind, kLimits)) {
      EXPECT_EQ(item.find("not used to move a limit"), std::string::npos) << item;
      EXPECT_EQ(item.find("no statement of conformity"), std::string::npos) << item;
    }
  }
  EXPECT_NE(scopeWords(DayKind::loaded).back().find("not used to move a limit"), std::string::npos);
}

TEST(DayWords, EveryCheckHasPlainWordsThatAreNotItsName) {
  for (const preparation::AuditCheckId& check : preparation::kAuditCheckIds) {
    const std::string id(check.id), words = amissWords(id);
    EXPECT_GT(words.size(), 15u) << id;
    EXPECT_EQ(words.find('_'), std::string::npos) << id;
    EXPECT_NE(words.back(), '.') << id;  // a clause: sentences are made of it
  }
  EXPECT_NO_THROW(amissWords(std::string(preparation::kStationsAgree)));
  EXPECT_THROW(amissWords("nothing"), std::logic_error);
}

}  // namespace
}  // namespace stiffscope::reports
