#include <gtest/gtest.h>

#include <cmath>
#include "core/identification/identify.h"
#include "core/identification/remarks.h"
#include "core/identification/warnings.h"
#include "core/io/units.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/spoilt_campaign.h"

// Units that are another's: forces, moments, lengths and angles, and what only looks like it.

namespace stiffscope {
namespace units_test {

// Angles that a script wrote in radians under q1_deg..q6_deg.
TEST(SpoiltCampaign, AnglesInAnotherUnitFail) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    for (campaign::State& row : campaign.states->rows) row.q *= io::kDegree;
  });
  EXPECT_EQ(report.verdict, preparation::AuditVerdict::fail);
  const preparation::AuditCheck& check = checkNamed(report, "unloaded_positions");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_TRUE(contains(check.message, "units, angles or the tracker's place are wrong"))
      << reports::words(check.message);
}

// A load cell's file in kN: forces a thousandth of what they were, the moments as before or in kNm, too.
TEST(SpoiltCampaign, ForcesInAnotherUnitFail) {
  EXPECT_EQ(checkNamed(goodReport(), "load_size").verdict, preparation::AuditVerdict::pass);
  EXPECT_FALSE(audit::findsTheImpossible(goodReport()));
  const audit::AuditReport forces = auditSpoilt([](campaign::Campaign& campaign) {
    for (campaign::State& row : campaign.states->rows) row.wrench_in_cell.head<3>() *= 1e-3;
  });
  const preparation::AuditCheck& lever = checkNamed(forces, "moment_lever");
  EXPECT_EQ(lever.verdict, preparation::AuditVerdict::fail);
  EXPECT_TRUE(contains(lever.message, "no tool is that long, forces (kN for N)")) << reports::words(lever.message);
  EXPECT_EQ(checkNamed(forces, "load_size").verdict, preparation::AuditVerdict::fail);
  EXPECT_TRUE(audit::findsTheImpossible(forces));

  const audit::AuditReport both = auditSpoilt([](campaign::Campaign& campaign) {
    for (campaign::State& row : campaign.states->rows) row.wrench_in_cell *= 1e-3;
  });
  const preparation::AuditCheck& size = checkNamed(both, "load_size");
  EXPECT_EQ(size.verdict, preparation::AuditVerdict::fail);
  EXPECT_NEAR(*size.value, 1e-3 * *checkNamed(goodReport(), "load_size").value, 1e-3 * *size.value);  // noise of places
  EXPECT_TRUE(contains(size.message, "forces (kN for N)")) << reports::words(size.message);
}

TEST(SpoiltCampaign, IdentifyCautionsOfForcesInAnotherUnit) {
  campaign::Campaign campaign = good();
  for (campaign::State& row : campaign.states->rows) row.wrench_in_cell.head<3>() *= 1e-3;
  const std::vector<std::string> cautions = reports::words(identification::identify(campaign).cautions);
  ASSERT_FALSE(cautions.empty());
  EXPECT_TRUE(contains(cautions[0], "forces (kN for N)")) << cautions[0];
  for (const Remark& caution : identification::identify(good()).cautions)
    EXPECT_FALSE(caution.is(identification::RemarkId::implausible_load)) << reports::words(caution);
}

TEST(SpoiltCampaign, MomentsInAnotherUnitFail) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    for (campaign::State& row : campaign.states->rows) row.wrench_in_cell.tail<3>() *= 1e3;
  });
  const preparation::AuditCheck& lever = checkNamed(report, "moment_lever");
  EXPECT_EQ(lever.verdict, preparation::AuditVerdict::fail);
  EXPECT_TRUE(contains(lever.message, "moments (N mm for Nm)")) << reports::words(lever.message);
  EXPECT_EQ(checkNamed(report, "load_size").verdict, preparation::AuditVerdict::pass);  // which looks at forces
}

// Every length a thousandth: all readings agree with each other, and with nothing that is known of the arm.
TEST(SpoiltCampaign, MetresUnderMillimetresFail) {
  EXPECT_EQ(checkNamed(goodReport(), "link_lengths").verdict, preparation::AuditVerdict::pass);
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    const auto shrink = [](auto& table) {
      for (auto& row : table.rows) row.point *= 1e-3;
    };
    shrink(*campaign.circle_sweeps);
    shrink(*campaign.wrist_sweep);
    shrink(*campaign.loading);
    shrink(*campaign.nests);
  });
  const preparation::AuditCheck& lengths = checkNamed(report, "link_lengths");
  EXPECT_EQ(lengths.verdict, preparation::AuditVerdict::fail);
  EXPECT_EQ(reports::words(lengths.where), "axes 2 and 3");  // the longest link, 1120 mm
  EXPECT_TRUE(contains(lengths.message, "another unit, or the URDF is another machine's"))
      << reports::words(lengths.message);
  EXPECT_EQ(checkNamed(report, "load_size").verdict, preparation::AuditVerdict::warn);
  EXPECT_TRUE(audit::findsTheImpossible(report));
}

TEST(SpoiltCampaign, SweepsInRadiansFail) {
  EXPECT_EQ(checkNamed(goodReport(), "sweep_angles").verdict, preparation::AuditVerdict::pass);
  EXPECT_LT(*checkNamed(goodReport(), "sweep_angles").value,
            1.01);  // sag turns joints by milliradians, of a radian or two
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    for (campaign::CircleReading& row : campaign.circle_sweeps->rows) row.q *= io::kDegree;
  });
  const preparation::AuditCheck& check = checkNamed(report, "sweep_angles");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_NEAR(*check.value, 57.3, 0.1);
  EXPECT_TRUE(contains(check.message, "in another unit (radians for degrees)")) << reports::words(check.message);
  EXPECT_TRUE(audit::findsTheImpossible(report));
}

// One reflector was hidden for most of the way, the others were not: the joint turned by what each of them saw.
TEST(SpoiltCampaign, AReflectorHiddenForAPartOfTheSweepIsNoOtherUnit) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    std::erase_if(campaign.circle_sweeps->rows, [](const campaign::CircleReading& row) {
      return row.axis == 3 && row.target == 1 && std::abs(row.q[3]) > 45.0 * io::kDegree;
    });
  });
  const preparation::AuditCheck& check = checkNamed(report, "sweep_angles");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::pass) << reports::words(check.message);
  EXPECT_LT(*check.value, 1.01) << reports::words(check.message);
}

TEST(SpoiltCampaign, AnAxisThatReportsOneAngleFails) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    for (campaign::CircleReading& row : campaign.circle_sweeps->rows) {
      if (row.axis == 4) row.q[4] = 0.1;
    }
  });
  const preparation::AuditCheck& check = checkNamed(report, "sweep_angles");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_FALSE(check.value);
  EXPECT_TRUE(contains(check.message, "axis 5 reports one and the same angle")) << reports::words(check.message);
}

// Forces that are noise say nothing of units, whatever stiffness and lever follow from them.
TEST(SpoiltCampaign, ForcesThatAreNoiseAreNoImpossibleOnes) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    double sign = 1.0;
    for (campaign::State& row : campaign.states->rows)
      row.wrench_in_cell.head<3>() = (sign = -sign) * Eigen::Vector3d(0.7, -0.2, 0.5);
  });
  EXPECT_FALSE(checkNamed(report, "load_size").impossible);
  EXPECT_FALSE(audit::findsTheImpossible(report));
}

TEST(ApparentStiffness, ByHand) {
  EXPECT_FALSE(identification::apparentStiffness({}));
  identification::LoadCase load_case;
  load_case.wrench.force = {0.0, 600.0, -800.0};
  load_case.targets.push_back({0, Eigen::Vector3d::Zero(), Eigen::Vector3d(0.0, 0.0, -1e-3), 1, 1});
  load_case.targets.push_back({1, Eigen::Vector3d::Zero(), Eigen::Vector3d(0.0, 0.0, -7e-3), 1, 1});
  const auto found = identification::apparentStiffness({load_case, load_case});
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->force, 1000.0);
  EXPECT_DOUBLE_EQ(found->displacement, 5e-3);                   // root of (1 + 49) / 2
  EXPECT_TRUE(identification::implausibleLoad(*found).empty());  // 2e5 N/m
  const std::string soft = reports::words(identification::implausibleLoad({1.0, 5e-3}));
  EXPECT_EQ(soft.rfind("1 N rms move the reflectors by 5 mm rms, 0.2 N/mm", 0), 0u) << soft;
  EXPECT_TRUE(contains(reports::words(identification::implausibleLoad({1000.0, 5e-6})), "lengths (m for mm)"));
  load_case.wrench.force.setZero();  // a moment alone
  EXPECT_FALSE(identification::apparentStiffness({load_case}));
}

}  // namespace units_test
}  // namespace stiffscope
