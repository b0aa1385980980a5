#include <gtest/gtest.h>

#include <algorithm>
#include "core/audit/audit.h"
#include "core/audit/remarks.h"
#include "core/io/input_error.h"
#include "core/preparation/finding.h"
#include "core/preparation/remarks.h"
#include "core/robot/read_urdf.h"
#include "reports/words/remark_words.h"
#include "tests/fixtures/clean_day.h"
#include "tests/fixtures/simulated_lab.h"

// What the audit says of days of which little or nothing can be tested, and of stray nests.

namespace stiffscope {
namespace evidence_test {

constexpr double kSigma = 8e-6;                          // m, of a reading, in every direction
constexpr double kForceSigma = 1.0, kMomentSigma = 0.3;  // N, Nm

bool unanswered(const audit::AuditReport& report, audit::RemarkId id) {
  return std::any_of(report.unanswered.begin(), report.unanswered.end(), [&](const Remark& one) { return one.is(id); });
}

const preparation::AuditCheck& checkOf(const audit::AuditReport& report, const std::string& id) {
  for (const preparation::AuditCheck& check : report.checks) {
    if (check.id == id) return check;
  }
  throw std::out_of_range("no check " + id);
}

/// A machine whose points are written in its base, so that displacements need no sweeps.
SimulatedLab inBase() {
  SimulatedLab lab;
  lab.withoutMasses();
  lab.tracker_from_base = Eigen::Isometry3d::Identity();
  lab.compliance << 2e-7, 3e-7, 4e-7, 2e-6, 4e-6, 6e-6;
  return lab;
}

struct DisplacementDay {
  bool returns = false;  ///< a last step without load
  bool cell = false;     ///< moments and unloaded readings as they are read, with their noise stated
  std::size_t targets = 1;
};

campaign::Campaign displacementDay(const DisplacementDay& day) {
  const SimulatedLab lab = inBase();
  campaign::Campaign campaign = lab.empty();
  campaign.tracker = campaign::Tracker{"tracker", kSigma, 0.0, kSigma, 0.0, {3.5, 0.0, 1.2}};
  campaign.targets.resize(day.targets);
  for (std::size_t k = 0; k < day.targets; ++k) campaign.targets[k].position_in_flange = lab.targets_in_flange[k];
  if (day.cell) campaign.load_cell->force_sigma = kForceSigma, campaign.load_cell->moment_sigma = kMomentSigma;
  campaign.states = campaign::States{"states.csv", campaign::PointFrame::base_link, {}};
  campaign.displacements = campaign::Displacements{"displacements.csv", campaign::PointFrame::base_link, {}};
  Noise noise(31);
  std::size_t line = 2;
  const auto read = [&](Vector6d wrench) {
    if (!day.cell) return Vector6d((Vector6d() << wrench.head<3>(), Eigen::Vector3d::Zero()).finished());
    wrench.head<3>() += kForceSigma * noise.normal3();
    wrench.tail<3>() += kMomentSigma * noise.normal3();
    return wrench;
  };
  for (int pose = 0; pose < 24; ++pose) {
    campaign.pose_ids.push_back(std::to_string(pose + 1));
    const JointVector q = somePosture(noise);
    const JointVector loaded = lab.settled(q, pulledForce(pose));
    std::vector<Eigen::Vector3d> first;
    for (std::size_t k = 0; k < day.targets; ++k) first.push_back(lab.seen(q, k) + kSigma * noise.normal3());
    campaign.states->rows.push_back({pose, 0, 0.0, q, read(Vector6d::Zero())});
    const auto step = [&](int number, const JointVector& at, const Vector6d& wrench) {
      campaign.states->rows.push_back({pose, number, 60.0 * number, q, read(wrench)});
      for (std::size_t k = 0; k < day.targets; ++k) {
        const Eigen::Vector3d now = lab.seen(at, k) + kSigma * noise.normal3();
        campaign.displacements->rows.push_back({pose, number, static_cast<int>(k), now - first[k], line++});
      }
    };
    step(1, loaded, lab.cellReading(loaded, pulledForce(pose)));
    if (day.returns) step(2, q, Vector6d::Zero());
  }
  return campaign;
}

TEST(Evidence, AnEmptyCampaignIsNotTestable) {
  const audit::AuditReport report = audit::audit(SimulatedLab().empty());
  EXPECT_EQ(report.verdict, preparation::AuditVerdict::not_testable);
  EXPECT_EQ(report.made, 0);
  EXPECT_EQ(report.of, preparation::checksOf(false));
  EXPECT_EQ(report.unanswered.size(), 4u);
  for (const preparation::AuditCheck& check : report.checks)
    EXPECT_EQ(check.verdict, preparation::AuditVerdict::not_testable) << check.id;
  EXPECT_TRUE(report.suspected.empty());
}

// One reflector, one load step, forces alone: the day could be identified from, and nothing says that it is right.
TEST(Evidence, SixChecksAreNotEnough) {
  const audit::AuditReport report = audit::audit(displacementDay({}));
  EXPECT_EQ(report.verdict, preparation::AuditVerdict::not_testable);
  EXPECT_EQ(report.made, 6);
  ASSERT_EQ(report.unanswered.size(), 2u);
  EXPECT_TRUE(unanswered(report, audit::RemarkId::unknown_worth_of_readings));
  EXPECT_TRUE(unanswered(report, audit::RemarkId::unknown_load_cell));
  for (const char* id : {"time_order", "completeness", "servo_change", "load_size", "posture_set", "load_model"})
    EXPECT_NE(checkOf(report, id).verdict, preparation::AuditVerdict::not_testable) << id;
}

TEST(Evidence, DisplacementsThatComeBackAndALoadCellThatIsReadPass) {
  const audit::AuditReport report = audit::audit(displacementDay({true, true, 2}));
  EXPECT_EQ(report.verdict, preparation::AuditVerdict::pass);
  EXPECT_TRUE(report.unanswered.empty());
  const preparation::AuditCheck& back = checkOf(report, "return_to_zero");
  // 24 postures, two reflectors, three coordinates: a standard deviation of 6 % of the ratio, three of them.
  EXPECT_NEAR(*back.value, 1.0, 0.18);
  // Either by itself leaves a question open.
  EXPECT_EQ(audit::audit(displacementDay({true, false, 2})).verdict, preparation::AuditVerdict::not_testable);
  EXPECT_EQ(audit::audit(displacementDay({false, true, 2})).verdict, preparation::AuditVerdict::not_testable);
}

TEST(Evidence, ADisplacementThatDoesNotComeBackIsNamed) {
  campaign::Campaign campaign = displacementDay({true, true, 2});
  std::size_t line = 0;
  for (campaign::Displacement& row : campaign.displacements->rows) {
    if (row.pose != 7 || row.step != 2 || row.target != 1) continue;
    row.displacement.z() += 0.3e-3;
    line = row.line;
  }
  const audit::AuditReport report = audit::audit(campaign);
  const preparation::AuditCheck& check = checkOf(report, "return_to_zero");
  EXPECT_NE(check.verdict, preparation::AuditVerdict::pass);
  EXPECT_EQ(reports::words(check.where), "displacements.csv:" + std::to_string(line));
}

TEST(Evidence, SweepsAndUnloadedDaysAreNotTestable) {
  simulation::SimulationSpec spec = cleanDay(3, 1.0);
  spec.loading.reset();
  campaign::Campaign sweeps = simulation::simulate(spec);
  sweeps.loading.reset();
  sweeps.states.reset();
  const audit::AuditReport report = audit::audit(sweeps);
  EXPECT_EQ(report.verdict, preparation::AuditVerdict::not_testable);
  EXPECT_GT(report.made, 10);
  EXPECT_TRUE(unanswered(report, audit::RemarkId::unknown_if_it_identifies));

  campaign::Campaign unloaded = simulation::simulate(cleanDay(3, 1.0));
  std::erase_if(unloaded.loading->rows, [](const campaign::LoadingReading& row) { return row.step != 0; });
  std::erase_if(unloaded.states->rows, [](const campaign::State& row) { return row.step != 0; });
  EXPECT_EQ(audit::audit(unloaded).verdict, preparation::AuditVerdict::not_testable);
  // A load cell that stays in campaign.xml does not make it a day with a load.
  campaign::Campaign left_over_cell = unloaded;
  for (campaign::State& row : left_over_cell.states->rows) row.wrench_in_cell.setZero();
  const audit::AuditReport left_over = audit::audit(left_over_cell);
  EXPECT_EQ(left_over.purpose, audit::Purpose::calibrate);
  for (const preparation::AuditCheck& check : left_over.checks) {
    if (check.id == "tare") EXPECT_EQ(check.verdict, preparation::AuditVerdict::not_testable);
  }
  unloaded.load_cell.reset();
  EXPECT_EQ(audit::audit(unloaded).verdict, preparation::AuditVerdict::not_testable);
}

TEST(Evidence, ALinkThatIsNotInTheUrdfIsLookedForInTheCampaign) {
  try {
    robot::readUrdf(STIFFSCOPE_SOURCE_DIR "/samples/m900ib700.urdf", "base_link", "flansch");
    FAIL();
  } catch (const io::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("attribute flange_link of `robot` in campaign.xml"), std::string::npos)
        << error.what();
  }
}

TEST(Evidence, AFailureOutranksWhatCannotBeTested) {
  campaign::Campaign campaign = displacementDay({});
  for (campaign::State& row : campaign.states->rows) row.time_s = 100.0 - row.time_s;  // step 1 before step 0
  EXPECT_EQ(audit::audit(campaign).verdict, preparation::AuditVerdict::fail);
}

// Five readings of the nests off by 300 mm, on a day whose station drifts.
TEST(Evidence, StrayNestsAreRejectedAndTheDriftStays) {
  simulation::SimulationSpec spec = cleanDay(4, 1.0);
  spec.timing.nest_interval_s = 300.0;
  spec.station.ramp[0] = 8e-9;  // m/s: about a tenth of a millimetre a day
  const campaign::Campaign good = simulation::simulate(spec);
  campaign::Campaign spoilt = good;
  std::vector<std::size_t> lines;
  const std::size_t step = spoilt.nests->rows.size() / 5;
  for (std::size_t k = 0; k < 5; ++k) {
    campaign::NestReading& row = spoilt.nests->rows[k * step + 1];
    row.point += Eigen::Vector3d(0.3, 0.0, 0.0);
    lines.push_back(row.line);
  }
  const audit::AuditReport as_read = audit::audit(good), report = audit::audit(spoilt);
  EXPECT_EQ(checkOf(as_read, "nest_outliers").verdict, preparation::AuditVerdict::pass);
  const preparation::AuditCheck& check = checkOf(report, "nest_outliers");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::warn);
  EXPECT_EQ(*check.value, 5.0);
  ASSERT_EQ(report.rejected.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(report.rejected[k].file, "nests.csv");
    EXPECT_EQ(report.rejected[k].line, lines[k]);
    EXPECT_TRUE(report.rejected[k].reason.is(preparation::RemarkId::stands_from_nest));
  }
  // The drift is that of the other readings: of fifty rounds each known to some 20 um the largest, so to as much.
  EXPECT_NEAR(*checkOf(report, "station_drift").value, *checkOf(as_read, "station_drift").value, 20e-6);
  const auto& more = std::get<std::vector<Remark>>(checkOf(report, "station_drift").message.values.back());
  ASSERT_FALSE(more.empty());
  EXPECT_TRUE(more.back().is(audit::RemarkId::motion_taken_off));
  EXPECT_NE(checkOf(report, "nest_moved").verdict, preparation::AuditVerdict::fail);
}

}  // namespace evidence_test
}  // namespace stiffscope
