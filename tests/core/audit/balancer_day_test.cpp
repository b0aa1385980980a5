#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/audit/audit.h"
#include "core/calibration/calibrate.h"
#include "core/campaign/read_campaign.h"
#include "core/campaign/write_campaign.h"
#include "core/identification/identify.h"
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

const preparation::AuditCheck& checkOf(const audit::AuditReport& report, const std::string& id) {
  return *std::find_if(report.checks.begin(), report.checks.end(),
                       [&](const preparation::AuditCheck& check) { return check.id == id; });
}

TEST(BalancerDay, UnderLoadsIsIdentifiedAndTheAuditIsQuiet) {
  int values = 0, inside = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    simulation::SimulationSpec spec = cleanDay(seed, 1.0);
    spec.machine.link_springs = {cylinder()};
    const campaign::Campaign stated = throughFiles(simulation::simulate(spec));
    ASSERT_EQ(stated.robot.balancers.size(), 1u);
    const audit::AuditReport report = audit::audit(stated);
    EXPECT_EQ(report.verdict, preparation::AuditVerdict::pass);
    const identification::Identification found = identification::identify(stated);
    const identification::StiffnessEstimate& estimate = found.of(identification::Method::partial_pose).estimate;
    for (int joint = 1; joint < 6; ++joint) {  // a hanging load does not turn joint 1
      const double truth = *spec.machine.joints[static_cast<std::size_t>(joint)].torsion;
      const identification::CoverageInterval interval = identification::stiffnessInterval(estimate, joint);
      ++values;
      inside += interval.low <= truth && truth <= interval.high;
      // Four standard deviations of 95 % intervals: one of fifteen is beyond that in a thousandth of such tests.
      EXPECT_NEAR(estimate.compliance[joint] * truth, 1.0, 4.0 * truth * std::sqrt(estimate.covariance(joint, joint)));
    }

    // Where the unloaded arm stands is a millimetre elsewhere, and what base and reflectors cannot take of that is
    // found: ten times what the statement leaves, and the audit warns of it.
    const audit::AuditReport without = audit::audit(withoutStatement(stated));
    EXPECT_EQ(without.verdict, preparation::AuditVerdict::warn);
    EXPECT_EQ(checkOf(without, "unloaded_positions").verdict, preparation::AuditVerdict::warn);
    EXPECT_GT(*checkOf(without, "unloaded_positions").value, 5.0 * *checkOf(report, "unloaded_positions").value);
  }
  // 95 % of 15: twelve or fewer are as improbable as 4 in a hundred.
  EXPECT_GE(inside, 12) << "of " << values;
}

const calibration::EffectPart* partOf(const calibration::ArmFit& fit, calibration::UnloadedEffect effect) {
  const auto found = std::find_if(fit.parts.begin(), fit.parts.end(),
                                  [&](const calibration::EffectPart& part) { return part.effect == effect; });
  return found == fit.parts.end() ? nullptr : &*found;
}

TEST(BalancerDay, WithoutALoadTheSpringsAreThoseOfTheMachine) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    simulation::SimulationSpec spec = simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/unloaded.xml");
    spec.seed = seed;
    spec.machine.joints[1].angle_wave.reset();
    spec.machine.link_springs = {cylinder()};
    const campaign::Campaign stated = throughFiles(simulation::simulate(spec));
    const audit::AuditReport report = audit::audit(stated);
    EXPECT_FALSE(report.suspected.size() > 0);
    for (const preparation::AuditCheck& check : report.checks) {
      EXPECT_NE(check.verdict, preparation::AuditVerdict::warn) << check.id;
      EXPECT_NE(check.verdict, preparation::AuditVerdict::fail) << check.id;
    }

    using calibration::CalibratedModel, calibration::UnloadedEffect;
    const calibration::Calibration found = calibration::calibrate(stated, {});
    const calibration::ModelResult& gravity = found.of(CalibratedModel::gravity);
    // Of the gravity model joint by joint; joints 2 and 3 give, the others are rigid.
    ASSERT_EQ(gravity.fit.sizes.size(), 6);
    const int steps = static_cast<int>(gravity.fit.steps.size());
    for (int joint = 0; joint < 6; ++joint) {
      const auto& torsion = spec.machine.joints[static_cast<std::size_t>(joint)].torsion;
      const double truth = torsion ? 1.0 / *torsion : 0.0;
      const double sd = gravity.fit.sd(steps + joint);  // 0: held at zero
      // Torques at the reported angles would make joint 2 softer by K_c / k, 0.2 % or four times its sd.
      if (torsion || sd > 0.0) {
        EXPECT_NEAR(gravity.fit.sizes[joint], truth, 3.5 * sd) << joint;
      }
      if (torsion) {
        EXPECT_LT(sd, 0.01 * truth) << joint;
      }
    }
    EXPECT_EQ(partOf(found.best().fit, UnloadedEffect::gravity_compensator), nullptr);

    // Without it the own weight explains a third of a millimetre less, and an effect is named that stands in for it.
    const calibration::Calibration without = calibration::calibrate(withoutStatement(stated), {});
    EXPECT_LT(gravity.held_out.rms, 20e-6);
    EXPECT_GT(without.of(CalibratedModel::gravity).held_out.rms, 10.0 * gravity.held_out.rms);
    EXPECT_NE(partOf(without.best().fit, UnloadedEffect::gravity_compensator), nullptr);
  }
}

/// A sheet that is wrong is no known force: half the pressure leaves half of what no statement does.
TEST(BalancerDay, AWrongStatementIsSeen) {
  simulation::SimulationSpec spec = simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/unloaded.xml");
  spec.machine.joints[1].angle_wave.reset();
  spec.machine.link_springs = {cylinder()};
  campaign::Campaign day = simulation::simulate(spec);
  const auto heldOut = [&] {
    return calibration::calibrate(day, {}).of(calibration::CalibratedModel::gravity).held_out.rms;
  };
  const double right = heldOut();
  std::get<robot::GasLaw>(day.robot.balancers.at(0).law).pressure_pa *= 0.5;
  const double half = heldOut();
  day.robot.balancers.clear();
  const double none = heldOut();
  EXPECT_LT(right, 20e-6);
  EXPECT_NEAR(half, 0.5 * none, 0.15 * none);
}

}  // namespace balancer_day_test
}  // namespace stiffscope
