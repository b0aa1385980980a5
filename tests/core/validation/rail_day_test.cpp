#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include "core/audit/audit.h"
#include "core/diagnosis/diagnose.h"
#include "core/identification/identify.h"
#include "core/preparation/prepare.h"
#include "core/simulation/measure.h"
#include "core/validation/machine_kinds.h"
#include "reports/words/remark_words.h"

// Days of an arm on a rail from the simulator, which moves a true carriage and knows nothing of how its course is
// found.

namespace stiffscope {
namespace rail_day_test {

simulation::SimulationSpec drawnSpec(std::uint64_t seed) {
  const auto folder = std::filesystem::temp_directory_path() / "stiffscope_rail_day" / std::to_string(seed);
  std::filesystem::create_directories(folder);
  simulation::SimulationSpec spec =
      validation::drawMachineOfKind(validation::MachineKind::rail, seed, "case", folder / "robot.urdf").spec;
  spec.tracker.true_noise_factor = 0.0;
  spec.load_cell->declared.force_sigma = spec.load_cell->declared.moment_sigma = 0.0;
  return spec;
}

JointVector compliances(const campaign::Campaign& day, identification::Method method) {
  identification::IdentifyOptions quick;
  quick.subsets = {0, 100, 100, 1};
  return identification::identify(preparation::prepareCampaign(day).campaign, quick).of(method).estimate.compliance;
}

// Without noise, and with a carriage that goes straight, however tilted and scaled, the day says of the springs what it
// says with the carriage at rest.
TEST(RailDay, TheCarriageLeavesTheSpringsAsTheyAre) {
  simulation::SimulationSpec moving = drawnSpec(41);
  moving.rail.straightness = moving.rail.stop_sigma = 0.0;
  simulation::SimulationSpec still = moving;
  still.rail.low = still.rail.high = still.rail.sweeps_at;
  still.rail.stops = 0;
  const campaign::Campaign moved_day = simulation::simulate(moving);
  ASSERT_TRUE(moved_day.rail_sweep);
  for (const auto method : {identification::Method::complete_pose, identification::Method::partial_pose}) {
    const JointVector with = compliances(moved_day, method), without = compliances(simulation::simulate(still), method);
    ASSERT_EQ(with.size(), 6);
    for (int j = 0; j < 6; ++j) {
      EXPECT_EQ(with[j] == 0.0, without[j] == 0.0) << j;
      if (without[j] == 0.0) continue;  // a load that hangs does not turn joint 1
      // Weights are by the distance from the tracker, which is another: of a noise-free day they only weigh how far the
      // linear model is off.
      EXPECT_NEAR(with[j] / without[j], 1.0, 1e-3) << j;
    }
  }
}

const preparation::AuditCheck& named(const audit::AuditReport& report, const std::string& id) {
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.id == id) return check;
  }
  throw std::runtime_error("no check " + id);
}

simulation::SimulationSpec noisySpec(std::uint64_t seed) {
  const auto folder = std::filesystem::temp_directory_path() / "stiffscope_rail_day" / std::to_string(seed);
  std::filesystem::create_directories(folder);
  return validation::drawMachineOfKind(validation::MachineKind::rail, seed, "case", folder / "robot.urdf").spec;
}

TEST(RailDay, ItsAuditFindsNothing) {
  const audit::AuditReport report = audit::audit(simulation::simulate(noisySpec(42)));
  EXPECT_EQ(report.of, preparation::checksOf(true));
  for (const preparation::AuditCheck& check : report.checks) {
    EXPECT_NE(check.verdict, preparation::AuditVerdict::fail) << check.id << ": " << reports::words(check.message);
  }
  for (const char* id : {"rail_straight", "rail_scale", "rail_direction"})
    EXPECT_EQ(named(report, id).verdict, preparation::AuditVerdict::pass) << id;
}

// Stops that miss by 60 um, the sweeps' one with them, are not a robot that moved between sweeps and loading. One of
// the twelve may: of clean machines one in a hundred has a finding.
TEST(RailDay, WhatStopsMissIsNoMovedFrame) {
  int found = 0;
  for (std::uint64_t seed = 50; seed < 62; ++seed) {
    simulation::SimulationSpec spec = noisySpec(seed);
    spec.rail.straightness = 0.0;
    spec.rail.stop_sigma = 60e-6;
    const diagnosis::Diagnosis diagnosis = diagnosis::diagnose(simulation::simulate(spec));
    for (const auto& entry : diagnosis.verdict.entries) {
      for (const effects::Effect effect : entry.effects)
        found += effect == effects::Effect::frame_error || effect == effects::Effect::tracker_drift;
    }
  }
  EXPECT_LE(found, 1);
}

TEST(RailDay, ACarriageThatCountsTheOtherWayIsNamed) {
  campaign::Campaign day = simulation::simulate(noisySpec(43));
  for (campaign::RailReading& row : day.rail_sweep->rows) row.rail = -row.rail;
  for (campaign::CircleReading& row : day.circle_sweeps->rows) row.rail = -row.rail;
  for (campaign::WristReading& row : day.wrist_sweep->rows) row.rail = -row.rail;
  for (campaign::State& row : day.states->rows) row.rail = -row.rail;
  const preparation::AuditCheck check = named(audit::audit(day), "rail_direction");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_NE(reports::words(check.message).find("goes against the axis"), std::string::npos)
      << reports::words(check.message);
}

TEST(RailDay, AnotherUnitIsImpossible) {
  campaign::Campaign day = simulation::simulate(noisySpec(44));
  for (campaign::RailReading& row : day.rail_sweep->rows) row.rail /= 25.4;
  for (campaign::CircleReading& row : day.circle_sweeps->rows) row.rail /= 25.4;
  for (campaign::WristReading& row : day.wrist_sweep->rows) row.rail /= 25.4;
  for (campaign::State& row : day.states->rows) row.rail /= 25.4;
  const preparation::AuditCheck check = named(audit::audit(day), "rail_scale");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_TRUE(check.impossible);
}

TEST(RailDay, ACrookedRailIsAWarning) {
  simulation::SimulationSpec spec = noisySpec(45);
  spec.rail.straightness = 0.6e-3;
  const preparation::AuditCheck check = named(audit::audit(simulation::simulate(spec)), "rail_straight");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::warn) << reports::words(check.message);
}

}  // namespace rail_day_test
}  // namespace stiffscope
