#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/audit/checks.h"
#include "core/audit/redundancies.h"
#include "reports/words/remark_words.h"

// Tools with many reflectors: whose name is whose is told without trying every order of them.

namespace stiffscope {
namespace rigid_tool_test {

/// A tool of so many reflectors in thirty postures of two states each, without load and with it, read with a noise of
/// 5 um. No turn takes it into itself.
class ManyReflectors {
 public:
  explicit ManyReflectors(int count) {
    campaign.tracker.emplace();
    campaign.tracker->range_fixed = campaign.tracker->angle_fixed = 5e-6;
    campaign.tracker->station = {4.0, -2.0, 1.0};
    campaign.loading.emplace();
    campaign.loading->file = "loading.csv";
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    std::vector<Eigen::Vector3d> tool;
    for (int k = 0; k < count; ++k) {
      campaign.targets.push_back({"T" + std::to_string(k + 1), {}});
      const double angle = 2.4 * k;  // of the golden section: evenly round, and nowhere the same
      tool.emplace_back(0.26 * std::cos(angle) + 0.005 * k, 0.24 * std::sin(angle) - 0.003 * k, 0.013 * (k * k % 7));
    }
    for (int pose = 0; pose < 30; ++pose) {
      campaign.pose_ids.push_back(std::to_string(pose + 1));
      const Eigen::AngleAxisd turn(0.1 * pose, Eigen::Vector3d(1.0, 2.0, 0.5 * pose).normalized());
      const Eigen::Vector3d place(1.5 + 0.02 * pose, 0.3 - 0.02 * pose, 1.2);
      for (const int step : {0, 1}) {
        for (int k = 0; k < count; ++k) {
          campaign::LoadingReading row;
          row.pose = pose;
          row.step = step;
          row.repeat = 1;
          row.target = k;
          row.point = place + turn * tool[static_cast<std::size_t>(k)];
          for (double& x : row.point) x += 5e-6 * normal(random);
          row.line = campaign.loading->rows.size() + 2;
          campaign.loading->rows.push_back(row);
        }
      }
    }
  }

  preparation::AuditCheck check() const {
    audit::AuditInput input{campaign};
    input.noise = preparation::declaredNoise(campaign);
    input.states = campaign::statePoints(campaign);
    return audit::checkRigidTool(input).front();
  }

  campaign::Campaign campaign;
};

std::string found(const preparation::AuditCheck& check) { return reports::words(check.message); }

TEST(RigidTool, ManyReflectorsThatStayAreRigid) {
  const preparation::AuditCheck check = ManyReflectors(12).check();
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::pass) << found(check);
}

// Twelve reflectors have 479 001 600 orders, and thirty states ask for one.
TEST(RigidTool, OneOfManyReflectorsThatMovesUnderLoadIsNamed) {
  ManyReflectors day(12);
  for (campaign::LoadingReading& row : day.campaign.loading->rows) {
    if (row.target == 11 && row.step == 1) row.point.z() += 0.5e-3;
  }
  const preparation::AuditCheck check = day.check();
  EXPECT_NE(found(check).find("reflector T12 moves"), std::string::npos) << found(check);
  EXPECT_EQ(found(check).find("exchanged"), std::string::npos) << found(check);
}

TEST(RigidTool, NamesAmongManyReflectorsAreSortedOut) {
  ManyReflectors day(12);
  for (campaign::LoadingReading& row : day.campaign.loading->rows) {
    if (row.pose < 20) continue;
    // Three in a ring and two with each other.
    const std::vector<int> named{0, 3, 2, 8, 4, 10, 6, 7, 1, 9, 5, 11};
    row.target = named[static_cast<std::size_t>(row.target)];
  }
  const preparation::AuditCheck check = day.check();
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  for (const char* pair : {"T4 is T2", "T9 is T4", "T2 is T9", "T11 is T6", "T6 is T11"})
    EXPECT_NE(found(check).find(pair), std::string::npos) << pair << ": " << found(check);
  EXPECT_EQ(found(check).find("T1 is"), std::string::npos) << found(check);
}

}  // namespace rigid_tool_test
}  // namespace stiffscope
