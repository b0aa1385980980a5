#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/accuracy/diagnose_accuracy.h"
#include "core/audit/audit.h"
#include "core/calibration/calibrate.h"
#include "core/campaign/read_campaign.h"
#include "core/campaign/write_campaign.h"
#include "core/identification/identify.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/clean_day.h"
#include "tests/fixtures/small_campaign.h"

// Days of a machine on a gas cylinder whose maker's data the campaign states: written, read, audited and identified;
// and the same days without the statement. The simulator's gas and its equilibrium share nothing with the
// identification.

namespace stiffscope {
namespace balancer_day_test {

/// Behind the column and on a lug of the upper arm: 25 kN, near 6 kNm on joint 2, some 40 % of what the arm weighs
/// there.
simulation::LinkSpring cylinder() {
  return {1,   2, {-0.5, 0, 0.94}, {0.25, 0, 1.13}, 0.0, 0.0, simulation::CylinderGas{150e5, 17e-4, 6e-3, 1.0, false},
          true};
}

/// Through the files, as a user has it.
campaign::Campaign throughFiles(const campaign::Campaign& campaign) {
  const TemporaryFolder folder;
  campaign::writeCampaign(campaign, STIFFSCOPE_SOURCE_DIR "/samples/m900ib700.urdf", folder.path());
  const campaign::CampaignReading reading = campaign::readCampaign(folder.path());
  EXPECT_TRUE(reading.warnings.empty()) << reading.warnings.front();
  return reading.campaign;
}

campaign::Campaign withoutStatement(campaign::Campaign campaign) {
  campaign.robot.balancers.clear();
  return campaign;
}

TEST(BalancerDay, Explore) {
  for (std::uint64_t seed : {1, 2, 3}) {
    simulation::SimulationSpec spec = cleanDay(seed, 1.0);
    spec.machine.link_springs = {cylinder()};
    const campaign::Campaign stated = throughFiles(simulation::simulate(spec));
    for (const bool with : {true, false}) {
      const campaign::Campaign day = with ? stated : withoutStatement(stated);
      const audit::AuditReport report = audit::audit(day);
      fmt::print("seed {} with {} audit {}\n", seed, with, (int)report.verdict);
      for (const auto& check : report.checks)
        if (check.verdict == preparation::AuditVerdict::warn || check.verdict == preparation::AuditVerdict::fail)
          fmt::print("   {}: {}\n", check.id, reports::words(check.message));
      const identification::Identification found = identification::identify(day);
      for (const auto method : identification::kMethods) {
        const auto& result = found.of(method);
        if (!result.available) continue;
        fmt::print("  method {}:", (int)method);
        for (int j = 0; j < 6; ++j) {
          const double k = *spec.machine.joints[static_cast<std::size_t>(j)].torsion;
          const double sd = std::sqrt(result.estimate.covariance(j, j));
          fmt::print(" {:.2f} ({:.2f}%)", (result.estimate.compliance[j] - 1.0 / k) / sd, 100 * sd * k);
        }
        fmt::print("\n");
      }
    }
  }
}

TEST(BalancerDay, ExploreUnloaded) {
  for (std::uint64_t seed : {1, 2, 3}) {
    simulation::SimulationSpec spec = simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/unloaded.xml");
    spec.seed = seed;
    spec.machine.joints[1].angle_wave.reset();
    spec.machine.link_springs = {cylinder()};
    const campaign::Campaign stated = throughFiles(simulation::simulate(spec));
    for (const bool with : {true, false}) {
      const campaign::Campaign day = with ? stated : withoutStatement(stated);
      const audit::AuditReport report = audit::audit(day);
      fmt::print("seed {} with {} audit {}\n", seed, with, (int)report.verdict);
      for (const auto& check : report.checks)
        if (check.verdict == preparation::AuditVerdict::warn || check.verdict == preparation::AuditVerdict::fail)
          fmt::print("   {}: {}\n", check.id, reports::words(check.message));
      const calibration::Calibration found = calibration::calibrate(day, {});
      for (const auto& model : found.models) {
        fmt::print("  model {} rms {:.1f} um held {:.1f} um:", (int)model.model, 1e6 * model.fitted.rms,
                   1e6 * model.held_out.rms);
        for (const auto& part : model.fit.parts) fmt::print(" {} {}", idOf(part.effect), part.detail);
        fmt::print("\n");
      }
      const auto& best = found.best().fit;
      for (Eigen::Index i = 0; i < best.sizes.size(); ++i) fmt::print(" {}", best.sizes[i]);
      fmt::print("\n");
    }
  }
}

}  // namespace balancer_day_test
}  // namespace stiffscope
