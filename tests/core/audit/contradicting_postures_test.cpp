#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "core/audit/audit.h"
#include "core/identification/identify.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/clean_day.h"

// Postures of which the loads are not those of the day: too little in a day's whole to contradict the model.

namespace stiffscope {
namespace contradicting_postures_test {

const preparation::AuditCheck& checkNamed(const audit::AuditReport& report, const std::string& id) {
  return *std::find_if(report.checks.begin(), report.checks.end(),
                       [&](const preparation::AuditCheck& one) { return one.id == id; });
}

campaign::Campaign dayWithWrenches(double factor, const std::set<int>& postures) {
  campaign::Campaign campaign = simulation::simulate(cleanDay(83, 1.0));
  for (campaign::State& row : campaign.states->rows) {
    if (postures.contains(row.pose)) row.wrench_in_cell *= factor;
  }
  return campaign;
}

TEST(ContradictingPostures, AreNamedByTheLoadModel) {
  const std::set<int> wrong{2, 7, 11, 15};
  const campaign::Campaign day = dayWithWrenches(0.7, wrong);
  const audit::AuditReport report = audit::audit(day);
  const preparation::AuditCheck& check = checkNamed(report, "load_model");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::warn);
  EXPECT_LT(*check.value, *check.limit);
  const std::string words = reports::words(check.message);
  EXPECT_NE(words.find("outlying postures: "), std::string::npos) << words;
  for (std::size_t p = 0; p < day.pose_ids.size(); ++p) {
    const bool named = words.find(" " + day.pose_ids[p] + " (") != std::string::npos;
    EXPECT_EQ(named, wrong.contains(static_cast<int>(p))) << day.pose_ids[p] << ": " << words;
  }
  EXPECT_NE(report.verdict, preparation::AuditVerdict::pass);

  identification::IdentifyOptions robust = identification::valuesOnly();
  robust.robust = true;
  const identification::Identification rest = identification::identify(day, robust);
  EXPECT_EQ(rest.outlying.size(), wrong.size());
  EXPECT_EQ(rest.cases.size(), day.pose_ids.size() - wrong.size());
}

TEST(ContradictingPostures, AreNoneOfACleanDay) {
  const audit::AuditReport report = audit::audit(dayWithWrenches(1.0, {}));
  EXPECT_EQ(checkNamed(report, "load_model").verdict, preparation::AuditVerdict::pass);
}

// A posture that was loaded a step fewer comes back to zero in the step from which the others identify.
TEST(ContradictingPostures, AReturnThatComesEarlyIsNoDirectionOfTheLoad) {
  campaign::Campaign day = simulation::simulate(cleanDay(83, 1.0));
  const auto renumber = [](auto& rows) {
    std::erase_if(rows, [](const auto& row) { return row.pose == 6 && row.step == 3; });
    for (auto& row : rows) {
      if (row.pose == 6 && row.step == 4) row.step = 3;
    }
  };
  renumber(day.states->rows);
  renumber(day.loading->rows);
  const audit::AuditReport report = audit::audit(day);
  EXPECT_EQ(checkNamed(report, "gravity_direction").verdict, preparation::AuditVerdict::pass);
  const std::string words = reports::words(checkNamed(report, "posture_set").message);
  EXPECT_NE(words.find("18 postures"), std::string::npos) << words;
}

}  // namespace contradicting_postures_test
}  // namespace stiffscope
