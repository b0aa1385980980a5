#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <string>
#include "core/campaign/read_campaign.h"
#include "core/diagnosis/diagnose.h"
#include "core/numerics/distributions.h"
#include "core/simulation/measure.h"
#include "tests/fixtures/extended_day.h"

// What a verdict may name, and how its tables say where the gap lies.

namespace stiffscope {
namespace candidates_test {

diagnosis::DiagnoseOptions quick() {
  diagnosis::DiagnoseOptions options;
  options.resamples = options.chance_draws = 0;
  return options;
}

bool says(const diagnosis::Diagnosis& diagnosis, diagnosis::RemarkId id) {
  return std::any_of(diagnosis.verdict.reasons.begin(), diagnosis.verdict.reasons.end(),
                     [&](const Remark& reason) { return reason.is(id); });
}

bool names(const diagnosis::Diagnosis& diagnosis, effects::Effect effect) {
  return std::any_of(diagnosis.verdict.entries.begin(), diagnosis.verdict.entries.end(),
                     [&](const diagnosis::VerdictEntry& entry) {
                       return std::find(entry.effects.begin(), entry.effects.end(), effect) != entry.effects.end();
                     });
}

// A machine whose deflection comes late, a fifth of it with a time constant of 15 s: friction looks like it from step
// to step, and repeats under the standing load say that it is not.
TEST(Candidates, FrictionIsNotNamedWhereReadingsMoveOnUnderAStandingLoad) {
  simulation::SimulationSpec spec = springsAlone(5);
  spec.machine.creep = simulation::Creep{0.2, 15.0};
  const diagnosis::Diagnosis found = diagnosis::diagnose(simulation::simulate(spec), quick());
  ASSERT_TRUE(found.usable);
  EXPECT_FALSE(names(found, effects::Effect::hysteresis));
  EXPECT_FALSE(names(found, effects::Effect::joint_hardening));
  ASSERT_FALSE(found.verdict.entries.empty());
  EXPECT_TRUE(found.verdict.entries.back().effects.empty());  // unknown
  EXPECT_TRUE(says(found, diagnosis::RemarkId::moves_while_load_stands));
}

// The same machine whose joint 2 has friction instead: it keeps its name.
TEST(Candidates, FrictionIsNamedWhereTheyStand) {
  simulation::SimulationSpec spec = springsAlone(5);
  simulation::JointFriction friction;
  friction.torque = 300.0;
  friction.rate = *spec.machine.joints[1].torsion;
  spec.machine.joints[1].friction = friction;
  const diagnosis::Diagnosis found = diagnosis::diagnose(simulation::simulate(spec), quick());
  ASSERT_TRUE(found.usable);
  EXPECT_TRUE(names(found, effects::Effect::hysteresis));
  EXPECT_FALSE(says(found, diagnosis::RemarkId::moves_while_load_stands));
}

// Six angles of a body are all that a rigid flange can do: together no more than the whole, each part its share.
TEST(WhereByJoint, PartsAddUpToWhatAllJointsExplain) {
  const campaign::Campaign sample =
      campaign::readCampaign(std::string(STIFFSCOPE_SOURCE_DIR) + "/samples/active").campaign;
  const diagnosis::Diagnosis found = diagnosis::diagnose(sample, quick());
  ASSERT_TRUE(found.usable);
  const auto table = std::find_if(found.where.begin(), found.where.end(), [](const auto& one) { return one.overlaps; });
  ASSERT_NE(table, found.where.end());
  EXPECT_EQ(table->by, "joint");
  ASSERT_EQ(table->rows.size(), 6u);
  double sum = 0.0;
  for (const diagnosis::WhereRow& row : table->rows) {
    EXPECT_GE(row.share, 0.0);
    EXPECT_LE(std::abs(row.significance), numerics::kLargestDeviate);
    sum += row.share;
  }
  EXPECT_NEAR(sum, table->explained, 1e-12);
  EXPECT_GT(table->explained, 0.0);
  EXPECT_LE(table->explained, 1.0 + 1e-9);
}

}  // namespace candidates_test
}  // namespace stiffscope
