#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <vector>
#include "core/audit/audit.h"
#include "core/identification/identify.h"
#include "core/io/units.h"
#include "core/mistakes/find_mistakes.h"
#include "tests/fixtures/clean_day.h"

// Days that parse and are hardly days: each gets an answer or a reason, and numbers that are numbers. scripts/sanitize
// runs them, too.

namespace stiffscope {
namespace odd_days_test {

using campaign::Campaign;

Campaign usualDay() {
  static const Campaign day = simulation::simulate(cleanDay(41, 1.0));
  return day;
}

/// Everything by one factor: robot, points, station.
Campaign scaledDay(double factor) {
  Campaign day = usualDay();
  for (auto& axis : day.robot.axes_in_base_at_zero) axis.point *= factor;
  day.robot.base_from_flange_at_zero.translation() *= factor;
  for (auto& link : day.robot.links) link.base_from_link_at_zero.translation() *= factor;
  for (auto& body : day.robot.bodies) body.com_in_base_at_zero *= factor;
  for (auto& row : day.circle_sweeps->rows) row.point *= factor;
  for (auto& row : day.wrist_sweep->rows) row.point *= factor;
  for (auto& row : day.loading->rows) row.point *= factor;
  for (auto& row : day.nests->rows) row.point *= factor;
  day.load_cell->parent_from_cell.translation() *= factor;
  return day;
}

/// The tracker so far from everything that it reads.
Campaign farDay(double metres) {
  simulation::SimulationSpec spec = cleanDay(42, 1.0);
  spec.tracker.base_from_tracker.translation() = Eigen::Vector3d(metres, 0.0, 1.0);
  return simulation::simulate(spec);
}

Campaign stiffDay(double nm_per_rad) {
  simulation::SimulationSpec spec = cleanDay(43, 1.0);
  for (auto& joint : spec.machine.joints) joint.torsion = nm_per_rad;
  return simulation::simulate(spec);
}

Campaign oneReadingAPosture() {
  Campaign day = usualDay();
  std::erase_if(day.loading->rows, [](const auto& row) { return row.target != 0 || row.repeat != "1"; });
  return day;
}

Campaign posturesAllAlike() {
  Campaign day = usualDay();
  std::map<int, Vector6d> q;
  std::map<std::tuple<int, int, std::string>, Eigen::Vector3d> points;
  std::map<int, Vector6d> wrenches;
  for (const auto& row : day.states->rows) {
    if (row.pose == 0) q[row.step] = row.q, wrenches[row.step] = row.wrench_in_cell;
  }
  for (const auto& row : day.loading->rows) {
    if (row.pose == 0) points[{row.step, row.target, row.repeat}] = row.point;
  }
  for (auto& row : day.states->rows) row.q = q.at(row.step), row.wrench_in_cell = wrenches.at(row.step);
  for (auto& row : day.loading->rows) row.point = points.at({row.step, row.target, row.repeat});
  return day;
}

/// Sweeps over 2 degrees, about the middle of what they were.
Campaign shortArcs() {
  simulation::SimulationSpec spec = cleanDay(44, 1.0);
  for (auto& sweep : spec.circle_sweeps) {
    const double middle = 0.5 * (sweep.start + sweep.stop);
    sweep.start = middle - io::kDegree;
    sweep.stop = middle + io::kDegree;
  }
  return simulation::simulate(spec);
}

/// Of each reflector one reading in all, so many reflectors.
Campaign manyTargets(int count) {
  Campaign day = usualDay();
  day.targets.clear();
  for (int k = 0; k < count; ++k) day.targets.push_back({"T" + std::to_string(k), {}});
  const std::vector<campaign::LoadingReading> rows = day.loading->rows;
  day.loading->rows.clear();
  for (std::size_t i = 0; day.loading->rows.size() < static_cast<std::size_t>(count); ++i) {
    for (const int step : {0, 1}) {
      campaign::LoadingReading row = rows[i % rows.size()];
      row.step = step;
      row.target = static_cast<int>(i % static_cast<std::size_t>(count));
      row.repeat = std::to_string(i);
      day.loading->rows.push_back(row);
    }
  }
  return day;
}

Campaign withoutRows() {
  Campaign day = usualDay();
  day.loading->rows.resize(1);
  day.states->rows.resize(1);
  day.wrist_sweep->rows.resize(1);
  day.circle_sweeps->rows.resize(1);
  day.nests->rows.resize(1);
  return day;
}

Campaign weightless() {
  Campaign day = usualDay();
  day.gravity_in_base.setZero();
  for (auto& row : day.states->rows) row.wrench_in_cell.setZero();
  return day;
}

Campaign atOnePoint() {
  Campaign day = usualDay();
  for (auto& row : day.circle_sweeps->rows) row.point.setZero();
  for (auto& row : day.wrist_sweep->rows) row.point.setZero();
  for (auto& row : day.loading->rows) row.point.setZero();
  for (auto& row : day.nests->rows) row.point.setZero();
  return day;
}

struct OddDay {
  const char* name;
  std::function<Campaign()> day;
};

std::vector<OddDay> oddDays() {
  return {{"an arm of 10 cm", [] { return scaledDay(0.03); }},
          {"an arm of 150 m", [] { return scaledDay(45.0); }},
          {"100 m from the station", [] { return farDay(100.0); }},
          {"1 mm from the station", [] { return farDay(1e-3); }},
          {"stiffness of 1e3 Nm/rad", [] { return stiffDay(1e3); }},
          {"stiffness of 1e9 Nm/rad", [] { return stiffDay(1e9); }},
          {"one reading a posture", oneReadingAPosture},
          {"postures all alike", posturesAllAlike},
          {"arcs of 2 degrees", shortArcs},
          {"30 targets", [] { return manyTargets(30); }},
          {"a row a table", withoutRows},
          {"no weight and no load", weightless},
          {"all readings at the station", atOnePoint}};
}

/// Each number that is said to be one.
void expectNumbers(const identification::Identification& result) {
  for (const identification::Method method : identification::kMethods) {
    const identification::MethodResult& one = result.of(method);
    if (!one.available) {
      EXPECT_FALSE(one.reason.empty());
      continue;
    }
    for (Eigen::Index j = 0; j < 6; ++j) {
      if (!one.estimate.identifiable[static_cast<std::size_t>(j)]) continue;
      EXPECT_TRUE(std::isfinite(one.estimate.compliance[j]));
      EXPECT_GE(one.estimate.covariance(j, j), 0.0);
    }
  }
}

TEST(OddDays, GetAnAnswerOrAReason) {
  for (const OddDay& odd : oddDays()) {
    SCOPED_TRACE(odd.name);
    const Campaign day = odd.day();
    const audit::AuditReport report = audit::audit(day);
    for (const preparation::AuditCheck& check : report.checks) {
      if (check.value) EXPECT_TRUE(std::isfinite(*check.value)) << check.id;
    }
    const mistakes::ModelAgreement agreement = mistakes::findMistakes(day);
    if (agreement.arm_miss) EXPECT_TRUE(std::isfinite(*agreement.arm_miss));
    if (agreement.loads_left) EXPECT_TRUE(std::isfinite(*agreement.loads_left));
    expectNumbers(identification::identify(day, identification::valuesOnly()));
  }
}

// The usual day, an arm of 10 cm, and one far away are no mistakes of the files.
TEST(OddDays, SizeAloneIsNoMistake) {
  for (const double factor : {0.03, 1.0}) {
    const mistakes::ModelAgreement agreement = mistakes::findMistakes(scaledDay(factor));
    EXPECT_FALSE(agreement.arm_contradicted) << factor;
  }
  EXPECT_FALSE(mistakes::findMistakes(farDay(100.0)).contradicted());
}

}  // namespace odd_days_test
}  // namespace stiffscope
