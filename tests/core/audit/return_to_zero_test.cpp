#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include "core/audit/audit.h"
#include "core/audit/remarks.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/clean_day.h"

// Reflectors that come back, as far as the load cell says that the load is off: its noise is a share of the load, and
// moves the reflectors of a soft arm by more than the tracker's noise.

namespace stiffscope {
namespace return_to_zero_test {

const preparation::AuditCheck& returnOf(const audit::AuditReport& report) {
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.id == "return_to_zero") return check;
  }
  throw std::out_of_range("return_to_zero");
}

/// A clean day whose cell scatters by as much as moves the reflectors by twice the tracker's noise, and says so.
campaign::Campaign dayOfNoisyCell(std::uint64_t seed) {
  campaign::Campaign campaign = simulation::simulate(cleanDay(seed, 1.0));
  constexpr double kSigma = 20.0;  // N, of some 1.5 kN that move reflectors by a millimetre or two
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, kSigma);
  for (campaign::State& row : campaign.states->rows)
    for (int k = 0; k < 3; ++k) row.wrench_in_cell[k] += noise(random);
  campaign.load_cell->force_sigma = std::hypot(campaign.load_cell->force_sigma, kSigma);
  return campaign;
}

TEST(ReturnToZero, TheCellsNoiseIsNoFriction) {
  double squares = 0.0;
  const int days = daysOr(5);
  for (int day = 0; day < days; ++day) {
    const audit::AuditReport report = audit::audit(dayOfNoisyCell(301 + static_cast<std::uint64_t>(day)));
    const preparation::AuditCheck& check = returnOf(report);
    EXPECT_EQ(check.verdict, preparation::AuditVerdict::pass) << reports::words(check.message);
    squares += *check.value * *check.value / days;
  }
  EXPECT_NEAR(squares, 1.0, 0.15);  // 171 degrees of freedom a day: a standard deviation of 0.05
}

TEST(ReturnToZero, FrictionStandsOutOfTheCellsNoise) {
  campaign::Campaign campaign = dayOfNoisyCell(301);
  for (campaign::LoadingReading& row : campaign.loading->rows) {
    if (row.pose == 4 && row.step == 4) row.point.z() -= 0.2e-3;  // ten times what the cell's noise moves them by
  }
  const preparation::AuditCheck check = returnOf(audit::audit(campaign));
  EXPECT_NE(check.verdict, preparation::AuditVerdict::pass);
  EXPECT_NE(reports::words(check.message).find("1 of 19 postures do not come back: 5 by"), std::string::npos)
      << reports::words(check.message);
}

// The cell shows more than the twentieth of the load by which an unloaded step is told, in step 0 as well.
TEST(ReturnToZero, StepsWithoutLoadAreKnownOfACellThatIsNotTared) {
  campaign::Campaign campaign = simulation::simulate(cleanDay(7, 1.0));
  const Eigen::Vector3d shown(90.0, -60.0, 150.0);  // N
  for (campaign::State& row : campaign.states->rows) row.wrench_in_cell.head<3>() += shown;
  const preparation::AuditCheck check = returnOf(audit::audit(campaign));
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::pass) << reports::words(check.message);
}

}  // namespace return_to_zero_test
}  // namespace stiffscope
