#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/audit/audit.h"
#include "core/io/units.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/clean_day.h"

// Joint angles that the reflectors contradict, and what only looks like them.

namespace stiffscope {
namespace stale_angles_test {

/// A machine whose joint 3 is stiffer the more it is loaded, by `cubic` (Nm/rad^3), and whose first posture has the
/// forearm hang back behind joint 3, so that the own weight turns it the other way than in all others.
campaign::Campaign dayWithHardSpring(std::uint64_t seed, double cubic) {
  simulation::SimulationSpec spec = cleanDay(seed, 1.0);
  spec.machine.joints[2].torsion = 1e6;
  spec.machine.joints[2].cubic = cubic;
  spec.postures.insert(spec.postures.begin(), {io::kDegree * JointVector{{10.0, 0.0, -114.0, 30.0, 60.0, 20.0}}, {}});
  return simulation::simulate(spec);
}

preparation::AuditCheck readBack(const campaign::Campaign& campaign) {
  const audit::AuditReport report = audit::audit(campaign);
  return *std::find_if(report.checks.begin(), report.checks.end(),
                       [](const preparation::AuditCheck& one) { return one.id == "joint_read_back"; });
}

TEST(StaleAngles, ASpringThatIsNotStraightIsNone) {
  for (const std::uint64_t seed : {771u, 772u}) {
    const preparation::AuditCheck check = readBack(dayWithHardSpring(seed, 1e10));
    EXPECT_EQ(check.verdict, preparation::AuditVerdict::pass) << seed << ": " << reports::words(check.message);
  }
}

TEST(StaleAngles, OfThatMachineAreNamedAllTheSame) {
  for (const int joint : {1, 2, 4}) {
    campaign::Campaign campaign = dayWithHardSpring(771, 1e10);
    for (campaign::State& row : campaign.states->rows) {
      if (row.pose == 9) row.q[joint] += 0.1 * io::kDegree;
    }
    const preparation::AuditCheck check = readBack(campaign);
    EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail) << joint;
    const std::string words = reports::words(check.message);
    EXPECT_NE(words.find("(pose " + campaign.pose_ids[9] + ": joint " + std::to_string(joint + 1) + " stands -"),
              std::string::npos)
        << words;
  }
}

}  // namespace stale_angles_test
}  // namespace stiffscope
