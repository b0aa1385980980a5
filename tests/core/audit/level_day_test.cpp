// A day whose postures cannot place the base: the audit says so in identify's own words, and what would serve.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include "core/audit/audit.h"
#include "core/identification/identify.h"
#include "core/preparation/prepare.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/level_flange.h"

namespace stiffscope {
namespace level_day_test {

/// Each posture a second time under a force, a millimetre lower.
campaign::Campaign loadedDay(bool turning) {
  campaign::Campaign day = LevelFlange().unloaded(12, turning);
  day.load_cell.emplace();
  day.load_cell->parent = "tool";
  const std::vector<campaign::State> unloaded = day.states->rows;
  for (campaign::State row : unloaded) {
    row.step = 1;
    row.wrench_in_cell << 0, 0, -1000, 0, 0, 0;
    day.states->rows.push_back(row);
  }
  const std::vector<campaign::LoadingReading> readings = day.loading->rows;
  for (campaign::LoadingReading row : readings) {
    row.step = 1;
    row.point.z() -= 1e-3;
    day.loading->rows.push_back(row);
  }
  return day;
}

TEST(LevelDay, AuditAndIdentifySayTheSame) {
  const campaign::Campaign day = loadedDay(false);
  const audit::AuditReport report = audit::audit(day);
  const auto check = std::find_if(report.checks.begin(), report.checks.end(),
                                  [](const preparation::AuditCheck& one) { return one.id == "posture_set"; });
  ASSERT_NE(check, report.checks.end());
  EXPECT_EQ(check->verdict, preparation::AuditVerdict::fail);
  const std::string message = reports::words(check->message);
  EXPECT_NE(message.find("turn the flange about different axes, or about one while it goes to places"),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("a table `displacements` with frame=\"base_link\""), std::string::npos) << message;
  const identification::Identification found = identification::identify(day, {});
  EXPECT_EQ(reports::words(found.of(identification::Method::partial_pose).reason), message);
}

TEST(LevelDay, OneThatTurnsIsIdentifiedFrom) {
  const campaign::Campaign day = loadedDay(true);
  EXPECT_TRUE(identification::identify(day, {}).of(identification::Method::partial_pose).available);
  for (const preparation::AuditCheck& check : audit::audit(day).checks) {
    if (check.id == "posture_set")
      EXPECT_TRUE(check.verdict == preparation::AuditVerdict::pass || check.verdict == preparation::AuditVerdict::warn);
  }
}

}  // namespace level_day_test
}  // namespace stiffscope
