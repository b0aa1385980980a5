#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/audit/audit.h"
#include "core/io/units.h"
#include "core/robot/kinematics.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/clean_day.h"

// What moves between two postures of the loading, on a simulated day without floor nests.

namespace stiffscope {
namespace moved_meanwhile_test {

const simulation::SimulationSpec& spec() {
  static const simulation::SimulationSpec one = cleanDay(77, 1.0);
  return one;
}

const campaign::Campaign& day() {
  static const campaign::Campaign campaign = [] {
    campaign::Campaign one = simulation::simulate(spec());
    one.nests.reset();
    return one;
  }();
  return campaign;
}

audit::AuditReport auditAfter(const std::function<void(campaign::Campaign&)>& spoil) {
  campaign::Campaign campaign = day();
  spoil(campaign);
  return audit::audit(campaign);
}

const preparation::AuditCheck& check(const audit::AuditReport& report, const std::string& id) {
  return *std::find_if(report.checks.begin(), report.checks.end(),
                       [&](const preparation::AuditCheck& one) { return one.id == id; });
}

bool says(const preparation::AuditCheck& one, const std::string& part) {
  return reports::words(one.message).find(part) != std::string::npos;
}

/// The postures in the order of their readings.
std::vector<int> posesInOrder(const campaign::Campaign& campaign) {
  std::vector<int> order;
  for (const campaign::LoadingReading& row : campaign.loading->rows) {
    if (std::find(order.begin(), order.end(), row.pose) == order.end()) order.push_back(row.pose);
  }
  return order;
}

std::size_t placeOf(const std::vector<int>& order, int pose) {
  return static_cast<std::size_t>(std::find(order.begin(), order.end(), pose) - order.begin());
}

std::string nameOf(const campaign::Campaign& campaign, int pose) {
  return campaign.pose_ids[static_cast<std::size_t>(pose)];
}

/// A tripod that is knocked: the instrument turns about its foot and slips.
Eigen::Isometry3d knocked(double slip, double turn) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d(0.6, 0.0, 0.8)).toRotationMatrix();
  motion.translation() = slip * Eigen::Vector3d(0.48, -0.64, 0.6);
  return motion;
}

TEST(MovedMeanwhile, AKnockedTripodIsNamedWithThePostureAfterIt) {
  for (const std::size_t first : {std::size_t{4}, day().pose_ids.size() / 2, day().pose_ids.size() - 4}) {
    const std::vector<int> order = posesInOrder(day());
    const Eigen::Isometry3d motion = knocked(0.25e-3, 20e-6);
    std::size_t line = 0;
    double moved_by = 0.0;
    int moved = 0;
    const audit::AuditReport report = auditAfter([&](campaign::Campaign& campaign) {
      for (campaign::LoadingReading& row : campaign.loading->rows) {
        if (placeOf(order, row.pose) < first) continue;
        if (line == 0) line = row.line;
        const Eigen::Vector3d there = motion * row.point;
        moved_by += (there - row.point).norm(), ++moved;
        row.point = there;
      }
    });
    const preparation::AuditCheck& found = check(report, "frame_moved");
    EXPECT_EQ(found.verdict, preparation::AuditVerdict::warn);
    EXPECT_TRUE(says(found, "from posture " + nameOf(day(), order[first]) + " on readings stand"))
        << reports::words(found.message);
    EXPECT_EQ(reports::words(found.where), "loading.csv:" + std::to_string(line));
    EXPECT_NEAR(*found.value, moved_by / moved, 0.03e-3);
    EXPECT_LT(*found.limit, 0.25 * *found.value);
    EXPECT_EQ(check(report, "joint_read_back").verdict, preparation::AuditVerdict::pass);
    EXPECT_EQ(check(report, "unloaded_positions").verdict, preparation::AuditVerdict::pass);
  }
}

TEST(MovedMeanwhile, BeyondTwiceTheTrustedPlaceItFails) {
  const std::vector<int> order = posesInOrder(day());
  const audit::AuditReport report = auditAfter([&](campaign::Campaign& campaign) {
    for (campaign::LoadingReading& row : campaign.loading->rows) {
      if (placeOf(order, row.pose) >= 9) row.point.y() += 0.6e-3;
    }
  });
  EXPECT_EQ(check(report, "frame_moved").verdict, preparation::AuditVerdict::fail);
  EXPECT_EQ(report.verdict, preparation::AuditVerdict::fail);
}

TEST(MovedMeanwhile, OrderIsThatOfTimesAndNotOfRows) {
  const std::vector<int> order = posesInOrder(day());
  const audit::AuditReport report = auditAfter([&](campaign::Campaign& campaign) {
    for (campaign::LoadingReading& row : campaign.loading->rows) {
      if (placeOf(order, row.pose) >= 7) row.point.x() -= 0.3e-3;
    }
    std::stable_sort(campaign.loading->rows.begin(), campaign.loading->rows.end(),
                     [](const auto& a, const auto& b) { return a.pose % 5 < b.pose % 5; });
  });
  EXPECT_TRUE(says(check(report, "frame_moved"), "from posture " + nameOf(day(), order[7]) + " on"))
      << reports::words(check(report, "frame_moved").message);
}

TEST(MovedMeanwhile, TwoKnocksAreBothNamed) {
  const std::vector<int> order = posesInOrder(day());
  const audit::AuditReport report = auditAfter([&](campaign::Campaign& campaign) {
    for (campaign::LoadingReading& row : campaign.loading->rows) {
      const std::size_t at = placeOf(order, row.pose);
      if (at >= 5) row.point.x() += 0.3e-3;
      if (at >= 12) row.point.z() -= 0.35e-3;
    }
  });
  const preparation::AuditCheck& found = check(report, "frame_moved");
  EXPECT_TRUE(says(found, "from posture " + nameOf(day(), order[5]) + " on")) << reports::words(found.message);
  EXPECT_TRUE(says(found, "from posture " + nameOf(day(), order[12]) + " on")) << reports::words(found.message);
  EXPECT_NEAR(*found.value, 0.35e-3, 0.04e-3);
  EXPECT_EQ(check(report, "joint_read_back").verdict, preparation::AuditVerdict::pass);
}

TEST(MovedMeanwhile, ADriftIsNoKnock) {
  double first = 1e300, last = -1e300;
  for (const campaign::LoadingReading& row : day().loading->rows)
    first = std::min(first, row.time_s), last = std::max(last, row.time_s);
  const audit::AuditReport report = auditAfter([&](campaign::Campaign& campaign) {
    for (campaign::LoadingReading& row : campaign.loading->rows)
      row.point += 0.3e-3 * (row.time_s - first) / (last - first) * Eigen::Vector3d(0.0, 0.6, 0.8);
  });
  const preparation::AuditCheck& found = check(report, "frame_moved");
  EXPECT_EQ(found.verdict, preparation::AuditVerdict::warn);
  EXPECT_TRUE(says(found, "readings drift by")) << reports::words(found.message);
  EXPECT_NEAR(*found.value, 0.3e-3, 0.04e-3);
  EXPECT_EQ(check(report, "joint_read_back").verdict, preparation::AuditVerdict::pass);
}

TEST(MovedMeanwhile, AToolThatSlippedIsNoKnockedTripod) {
  const std::vector<int> order = posesInOrder(day());
  const Eigen::Matrix3d station_from_base = spec().tracker.base_from_tracker.linear().transpose();
  const Eigen::Vector3d slip(0.2e-3, -0.1e-3, 0.2e-3);  // in the flange
  const audit::AuditReport report = auditAfter([&](campaign::Campaign& campaign) {
    std::map<int, Eigen::Matrix3d> base_from_flange;
    for (const campaign::State& state : campaign.states->rows) {
      if (state.step == 0)
        base_from_flange[state.pose] = robot::postureAt(campaign.robot, state.q).motion.back().linear() *
                                       campaign.robot.base_from_flange_at_zero.linear();
    }
    for (campaign::LoadingReading& row : campaign.loading->rows) {
      if (placeOf(order, row.pose) >= 8) row.point += station_from_base * base_from_flange.at(row.pose) * slip;
    }
  });
  const preparation::AuditCheck& found = check(report, "frame_moved");
  EXPECT_TRUE(says(found, "from posture " + nameOf(day(), order[8]) + " on all reflectors"))
      << reports::words(found.message);
  EXPECT_TRUE(says(found, "the tool slipped on the flange")) << reports::words(found.message);
  EXPECT_NEAR(*found.value, slip.norm(), 0.03e-3);
  EXPECT_EQ(check(report, "joint_read_back").verdict, preparation::AuditVerdict::pass);
}

TEST(MovedMeanwhile, OfALongDayTheVeryPostureIsNamed) {
  simulation::SimulationSpec long_spec = cleanDay(78, 1.0);
  ASSERT_TRUE(long_spec.posture_draw);
  long_spec.posture_draw->count = 700;
  long_spec.posture_draw->candidates = 1;
  campaign::Campaign campaign = simulation::simulate(long_spec);
  campaign.nests.reset();
  const std::vector<int> order = posesInOrder(campaign);
  for (campaign::LoadingReading& row : campaign.loading->rows) {
    if (placeOf(order, row.pose) >= 401) row.point.z() += 0.2e-3;
  }
  const audit::AuditReport report = audit::audit(campaign);
  EXPECT_TRUE(says(check(report, "frame_moved"), "from posture " + nameOf(campaign, order[401]) + " on readings"))
      << reports::words(check(report, "frame_moved").message);
  EXPECT_NEAR(*check(report, "frame_moved").value, 0.2e-3, 0.02e-3);
}

TEST(MovedMeanwhile, StaleAnglesStayStaleAngles) {
  const std::vector<int> order = posesInOrder(day());
  const int before_last = order[order.size() - 2], last = order.back();
  const audit::AuditReport report = auditAfter([&](campaign::Campaign& campaign) {
    for (campaign::State& row : campaign.states->rows) {
      if (row.pose == before_last || row.pose == last) row.q[1] += 0.02 * io::kDegree;
    }
  });
  EXPECT_EQ(check(report, "frame_moved").verdict, preparation::AuditVerdict::pass);
  const preparation::AuditCheck& stale = check(report, "joint_read_back");
  EXPECT_EQ(stale.verdict, preparation::AuditVerdict::fail);
  EXPECT_TRUE(says(stale, "pose " + nameOf(day(), last) + ": joint 2")) << reports::words(stale.message);
}

TEST(MovedMeanwhile, AStalePostureBesideAKnockIsNamed) {
  const std::vector<int> order = posesInOrder(day());
  const audit::AuditReport report = auditAfter([&](campaign::Campaign& campaign) {
    for (campaign::LoadingReading& row : campaign.loading->rows) {
      if (placeOf(order, row.pose) >= 6) row.point.y() += 0.3e-3;
    }
    for (campaign::State& row : campaign.states->rows) {
      if (row.pose == order[11]) row.q[2] += 0.05 * io::kDegree;
    }
  });
  EXPECT_TRUE(says(check(report, "frame_moved"), "from posture " + nameOf(day(), order[6]) + " on"))
      << reports::words(check(report, "frame_moved").message);
  EXPECT_TRUE(says(check(report, "joint_read_back"), "pose " + nameOf(day(), order[11]) + ": joint 3"))
      << reports::words(check(report, "joint_read_back").message);
}

}  // namespace moved_meanwhile_test
}  // namespace stiffscope
