#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "core/audit/audit.h"
#include "core/campaign/read_campaign.h"
#include "core/identification/apparent_stiffness.h"
#include "core/identification/identify.h"
#include "core/input/units.h"

// A good campaign, spoilt in memory in one way at a time: the audit names each, with the row where a row is
// guilty. The machine of samples/active has bearings that give, which some checks warn of; what is spoilt
// must come on top.

namespace stiffscope {
namespace {

const Campaign& good() {
  static const Campaign campaign =
      readCampaign(std::filesystem::path(STIFFSCOPE_SOURCE_DIR) / "samples" / "active").campaign;
  return campaign;
}

const AuditReport& goodReport() {
  static const AuditReport report = audit(good());
  return report;
}

const AuditCheck& checkNamed(const AuditReport& report, const std::string& id,
                             const std::string& where = {}) {
  for (const AuditCheck& check : report.checks) {
    if (check.id == id && (where.empty() || check.where == where)) return check;
  }
  throw std::out_of_range("no check " + id + " at " + where);
}

AuditReport auditSpoilt(const std::function<void(Campaign&)>& spoil) {
  Campaign campaign = good();
  spoil(campaign);
  return audit(campaign);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Checks that found something and that the good campaign passes, but for `meant`.
std::vector<std::string> besides(const AuditReport& report, const std::vector<std::string>& meant) {
  std::vector<std::string> others;
  for (std::size_t i = 0; i < report.checks.size(); ++i) {
    const AuditCheck& check = report.checks[i];
    if (check.verdict != AuditVerdict::warn && check.verdict != AuditVerdict::fail) continue;
    if (std::find(meant.begin(), meant.end(), check.id) != meant.end()) continue;
    if (goodReport().checks[i].verdict == AuditVerdict::pass)
      others.push_back(check.id + ": " + check.message);
  }
  return others;
}

#define EXPECT_ONLY(report, ...) \
  EXPECT_EQ(besides(report, std::vector<std::string>(__VA_ARGS__)), std::vector<std::string>{})

LoadingReading& reading(Campaign& campaign, int pose, int step, const std::string& repeat, int target) {
  for (LoadingReading& row : campaign.loading->rows) {
    if (row.pose == pose && row.step == step && row.repeat == repeat && row.target == target) return row;
  }
  throw std::out_of_range("no such reading");
}

State& state(Campaign& campaign, int pose, int step) {
  for (State& row : campaign.states->rows) {
    if (row.pose == pose && row.step == step) return row;
  }
  throw std::out_of_range("no such state");
}

TEST(SpoiltCampaign, TheGoodOneDoesNotFail) {
  EXPECT_NE(goodReport().verdict, AuditVerdict::fail);
  EXPECT_TRUE(goodReport().rejected.empty());
}

TEST(SpoiltCampaign, LostBeam) {
  std::size_t line = 0;
  const AuditReport report = auditSpoilt([&](Campaign& campaign) {
    LoadingReading& row = reading(campaign, 4, 2, "2", 1);
    row.point.setZero();
    line = row.line;
  });
  const AuditCheck& check = checkNamed(report, "lost_beam");
  EXPECT_EQ(check.verdict, AuditVerdict::fail);
  EXPECT_EQ(check.where, fmt::format("loading.csv:{}", line));
  ASSERT_EQ(report.rejected.size(), 1u);
  EXPECT_EQ(report.rejected[0].line, line);
  EXPECT_EQ(checkNamed(report, "completeness").verdict, AuditVerdict::warn);  // a repeat short now
  EXPECT_ONLY(report, {"lost_beam", "completeness"});
}

TEST(SpoiltCampaign, DuplicatedReading) {
  std::size_t line = 0;
  const AuditReport report = auditSpoilt([&](Campaign& campaign) {
    LoadingReading& row = reading(campaign, 7, 1, "3", 0);
    row.point = reading(campaign, 7, 1, "2", 0).point;
    line = row.line;
  });
  EXPECT_EQ(checkNamed(report, "duplicate_readings").where, fmt::format("loading.csv:{}", line));
  EXPECT_ONLY(report, {"duplicate_readings", "completeness"});
}

TEST(SpoiltCampaign, OneRepeatOff) {
  std::size_t line = 0;
  const AuditReport report = auditSpoilt([&](Campaign& campaign) {
    LoadingReading& row = reading(campaign, 2, 3, "1", 2);
    row.point.y() += 0.3e-3;  // 20 times the noise
    line = row.line;
  });
  EXPECT_EQ(checkNamed(report, "repeat_outliers").where, fmt::format("loading.csv:{}", line));
  EXPECT_ONLY(report, {"repeat_outliers", "completeness"});
}

TEST(SpoiltCampaign, ReflectorsExchanged) {
  const AuditReport report = auditSpoilt([&](Campaign& campaign) {
    for (const char* repeat : {"1", "2", "3"}) {
      std::swap(reading(campaign, 5, 3, repeat, 0).point, reading(campaign, 5, 3, repeat, 1).point);
    }
  });
  const AuditCheck& check = checkNamed(report, "rigid_tool");
  EXPECT_EQ(check.verdict, AuditVerdict::fail);
  EXPECT_TRUE(contains(check.message, "P10 is P11, P11 is P10")) << check.message;
  EXPECT_TRUE(contains(check.message, "pose 6, step 3")) << check.message;
  Campaign campaign = good();
  EXPECT_EQ(check.where, fmt::format("loading.csv:{}", reading(campaign, 5, 3, "1", 0).line));
}

TEST(SpoiltCampaign, LooseReflector) {
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    // P11 sits 0.1 mm lower in its nest from the eighth posture on.
    for (LoadingReading& row : campaign.loading->rows) {
      if (row.target == 1 && row.pose >= 7) row.point.z() -= 0.1e-3;
    }
  });
  const AuditCheck& check = checkNamed(report, "rigid_tool");
  EXPECT_NE(check.verdict, AuditVerdict::pass);
  EXPECT_TRUE(contains(check.message, "reflector P11 moves")) << check.message;
  EXPECT_TRUE(contains(check.where, "P11")) << check.where;
}

TEST(SpoiltCampaign, StepsInWrongOrder) {
  std::size_t line = 0;
  const AuditReport report = auditSpoilt([&](Campaign& campaign) {
    for (LoadingReading& row : campaign.loading->rows) {
      if (row.pose != 3 || (row.step != 1 && row.step != 2)) continue;
      row.step = 3 - row.step;
      if (row.step == 2 && line == 0) line = row.line;
    }
  });
  const AuditCheck& check = checkNamed(report, "time_order");
  EXPECT_EQ(check.verdict, AuditVerdict::fail);
  EXPECT_EQ(check.where, fmt::format("loading.csv:{}", line));
  EXPECT_TRUE(contains(check.message, "pose 4: step 2 before step 1")) << check.message;
}

TEST(SpoiltCampaign, StationBumpedBeforeLoadingWithoutNests) {
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    campaign.nests.reset();
    for (LoadingReading& row : campaign.loading->rows) row.point += Eigen::Vector3d(1.2e-3, -0.8e-3, 0.5e-3);
  });
  const AuditCheck& check = checkNamed(report, "frame_moved");
  EXPECT_EQ(check.verdict, AuditVerdict::fail);
  EXPECT_NEAR(*check.value, 1.53, 0.15);  // mm; a tenth for what the bearings' sag leaves open
  EXPECT_EQ(checkNamed(report, "station_drift").verdict, AuditVerdict::not_testable);
  EXPECT_ONLY(report, {"frame_moved"});
}

TEST(SpoiltCampaign, StationDrifts) {
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    const auto drift = [](auto& table) {
      for (auto& row : table.rows) row.point.x() += 5e-8 * row.time_s;  // 3 um a minute
    };
    drift(*campaign.circle_sweeps);
    drift(*campaign.wrist_sweep);
    drift(*campaign.loading);
    drift(*campaign.nests);
  });
  const AuditCheck& check = checkNamed(report, "station_drift");
  EXPECT_EQ(check.verdict, AuditVerdict::fail);
  EXPECT_TRUE(contains(check.message, "a drift of")) << check.message;
  EXPECT_ONLY(report, {"station_drift"});
}

TEST(SpoiltCampaign, NestMoved) {
  std::size_t line = 0;
  const AuditReport report = auditSpoilt([&](Campaign& campaign) {
    for (NestReading& row : campaign.nests->rows) {
      if (row.nest != 2 || row.time_s < 5000.0) continue;
      row.point.x() += 0.5e-3;
      if (line == 0) line = row.line;
    }
  });
  const AuditCheck& check = checkNamed(report, "nest_moved");
  EXPECT_EQ(check.verdict, AuditVerdict::warn);
  EXPECT_EQ(check.where, fmt::format("nests.csv:{}", line));
  EXPECT_TRUE(contains(check.message, "nest N3 moved")) << check.message;
  EXPECT_ONLY(report, {"nest_moved"});
}

TEST(SpoiltCampaign, WrongTare) {
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    for (State& row : campaign.states->rows) row.wrench_in_cell[2] += 8.0;
  });
  const AuditCheck& check = checkNamed(report, "tare");
  EXPECT_EQ(check.verdict, AuditVerdict::warn);
  EXPECT_TRUE(contains(check.message, "not tared")) << check.message;
}

TEST(SpoiltCampaign, SignOfAMomentTurnedRound) {
  std::size_t line = 0;
  const AuditReport report = auditSpoilt([&](Campaign& campaign) {
    State& row = state(campaign, 9, 3);
    row.wrench_in_cell[3] = -row.wrench_in_cell[3];
    line = row.line;
  });
  const AuditCheck& check = checkNamed(report, "moment_lever");
  EXPECT_NE(check.verdict, AuditVerdict::pass);
  EXPECT_EQ(check.where, fmt::format("states.csv:{}", line));
  EXPECT_TRUE(contains(check.message, "with mx of that state turned round they agree")) << check.message;
}

TEST(SpoiltCampaign, StaleJointAngle) {
  std::size_t line = 0;
  const AuditReport report = auditSpoilt([&](Campaign& campaign) {
    for (State& row : campaign.states->rows) {
      if (row.pose == 11) row.q[2] += 0.3 * kDegree;  // read before joint 3 had settled
    }
    line = state(campaign, 11, 0).line;
  });
  const AuditCheck& check = checkNamed(report, "joint_read_back");
  EXPECT_EQ(check.verdict, AuditVerdict::fail);
  EXPECT_EQ(check.where, fmt::format("states.csv:{}", line));
  EXPECT_TRUE(contains(check.message, "pose 12: joint 3 stands -0.3")) << check.message;
  EXPECT_ONLY(report, {"joint_read_back"});
}

TEST(SpoiltCampaign, ShortArc) {
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    std::erase_if(campaign.circle_sweeps->rows, [](const CircleReading& row) {
      return row.axis == 0 && std::abs(row.q[0]) > 16.0 * kDegree;
    });
  });
  const AuditCheck& check = checkNamed(report, "circle_arc", "axis 1");
  EXPECT_EQ(check.verdict, AuditVerdict::fail);
  EXPECT_LT(*check.value, 32.0);
  EXPECT_TRUE(contains(check.message, "does not suffice")) << check.message;
}

TEST(SpoiltCampaign, WideArcsOfFewReadingsOfOneReflector) {
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    int count = 0;
    std::erase_if(campaign.circle_sweeps->rows, [&](const CircleReading& row) {
      return row.axis == 2 && (row.target != 0 || count++ % 5 != 0);
    });
  });
  const AuditCheck& check = checkNamed(report, "circle_arc", "axis 3");
  EXPECT_EQ(check.verdict, AuditVerdict::warn);
  EXPECT_GT(*check.value, 80.0);
  EXPECT_TRUE(contains(check.message, "does not suffice")) << check.message;
}

TEST(SpoiltCampaign, OneReadingOffItsCircleIsNamed) {
  // The bearings' misfit runs along the sweep; a reading 2 mm off is another matter.
  EXPECT_TRUE(contains(checkNamed(goodReport(), "circle_residual").message, "that of axes 3, 4, 5 runs along the sweep"));
  std::size_t line = 0;
  const AuditReport report = auditSpoilt([&](Campaign& campaign) {
    for (CircleReading& row : campaign.circle_sweeps->rows) {
      if (row.axis != 5 || row.target != 1 || line != 0) continue;
      row.point += Eigen::Vector3d(2e-3, 2e-3, 2e-3);
      line = row.line;
    }
  });
  const AuditCheck& check = checkNamed(report, "circle_residual");
  EXPECT_TRUE(contains(check.message, fmt::format("most of that of axis 6 is the one reading circle_sweeps.csv:{}", line)))
      << check.message;
}

TEST(SpoiltCampaign, AMaximumPermissibleErrorDeclaredAsSigma) {
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    Tracker& tracker = *campaign.tracker;
    for (double* figure :
         {&tracker.range_fixed, &tracker.range_per_m, &tracker.angle_fixed, &tracker.angle_per_m})
      *figure *= 2.5;
  });
  const AuditCheck& check = checkNamed(report, "repeatability_across");
  EXPECT_EQ(check.verdict, AuditVerdict::pass);  // a cautious declaration is no fault
  ASSERT_EQ(check.details.size(), 1u);
  EXPECT_TRUE(contains(check.details[0], "maximum permissible error")) << check.details[0];
}

TEST(SpoiltCampaign, EveryJointIsJudgedInThePostureSet) {
  const AuditCheck& check = checkNamed(goodReport(), "posture_set");
  ASSERT_EQ(check.details.size(), 6u);
  EXPECT_TRUE(contains(check.details[0], "joint 1: not identifiable: the load only hangs")) << check.details[0];
  for (std::size_t j = 1; j < 6; ++j) EXPECT_TRUE(contains(check.details[j], ": identifiable")) << check.details[j];
  EXPECT_TRUE(contains(check.message, "with a condition number of")) << check.message;
}

TEST(SpoiltCampaign, AngleOfOneStepChanged) {
  std::size_t line = 0;
  const AuditReport report = auditSpoilt([&](Campaign& campaign) {
    State& row = state(campaign, 1, 3);
    row.q[1] += 0.01 * kDegree;
    line = row.line;
  });
  EXPECT_EQ(checkNamed(report, "servo_change").verdict, AuditVerdict::warn);
  EXPECT_EQ(checkNamed(report, "servo_change").where, fmt::format("states.csv:{}", line));
  EXPECT_ONLY(report, {"servo_change"});
}

TEST(SpoiltCampaign, DoesNotComeBackToZero) {
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    for (LoadingReading& row : campaign.loading->rows) {
      if (row.pose == 14 && row.step == 4) row.point.z() -= 0.1e-3;
    }
  });
  const AuditCheck& check = checkNamed(report, "return_to_zero");
  EXPECT_NE(check.verdict, AuditVerdict::pass);
  EXPECT_TRUE(contains(check.message, "1 of 19 postures do not come back: 15 by")) << check.message;
  EXPECT_ONLY(report, {"return_to_zero"});
}

// Angles that a script wrote in radians under q1_deg..q6_deg.
TEST(SpoiltCampaign, AnglesInAnotherUnitFail) {
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    for (State& row : campaign.states->rows) row.q *= kDegree;
  });
  EXPECT_EQ(report.verdict, AuditVerdict::fail);
  const AuditCheck& check = checkNamed(report, "unloaded_positions");
  EXPECT_EQ(check.verdict, AuditVerdict::fail);
  EXPECT_TRUE(contains(check.message, "units, angles or the tracker's place are wrong")) << check.message;
}

// A load cell's file in kN: forces a thousandth of what they were, the moments as before or in kNm, too.
TEST(SpoiltCampaign, ForcesInAnotherUnitFail) {
  EXPECT_EQ(checkNamed(goodReport(), "load_size").verdict, AuditVerdict::pass);
  EXPECT_FALSE(findsTheImpossible(goodReport()));
  const AuditReport forces = auditSpoilt([](Campaign& campaign) {
    for (State& row : campaign.states->rows) row.wrench_in_cell.head<3>() *= 1e-3;
  });
  const AuditCheck& lever = checkNamed(forces, "moment_lever");
  EXPECT_EQ(lever.verdict, AuditVerdict::fail);
  EXPECT_TRUE(contains(lever.message, "no tool is that long, forces (kN for N)")) << lever.message;
  EXPECT_EQ(checkNamed(forces, "load_size").verdict, AuditVerdict::fail);
  EXPECT_TRUE(findsTheImpossible(forces));

  const AuditReport both = auditSpoilt([](Campaign& campaign) {
    for (State& row : campaign.states->rows) row.wrench_in_cell *= 1e-3;
  });
  const AuditCheck& size = checkNamed(both, "load_size");
  EXPECT_EQ(size.verdict, AuditVerdict::fail);
  EXPECT_NEAR(*size.value, 1e-3 * *checkNamed(goodReport(), "load_size").value, 1e-3 * *size.value);  // noise of places
  EXPECT_TRUE(contains(size.message, "forces (kN for N)")) << size.message;
}

TEST(SpoiltCampaign, IdentifyCautionsOfForcesInAnotherUnit) {
  Campaign campaign = good();
  for (State& row : campaign.states->rows) row.wrench_in_cell.head<3>() *= 1e-3;
  const auto cautions = identify(campaign).cautions;
  ASSERT_FALSE(cautions.empty());
  EXPECT_TRUE(contains(cautions[0], "forces (kN for N)")) << cautions[0];
  for (const std::string& caution : identify(good()).cautions) EXPECT_FALSE(contains(caution, "another unit")) << caution;
}

TEST(SpoiltCampaign, MomentsInAnotherUnitFail) {
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    for (State& row : campaign.states->rows) row.wrench_in_cell.tail<3>() *= 1e3;
  });
  const AuditCheck& lever = checkNamed(report, "moment_lever");
  EXPECT_EQ(lever.verdict, AuditVerdict::fail);
  EXPECT_TRUE(contains(lever.message, "moments (N mm for Nm)")) << lever.message;
  EXPECT_EQ(checkNamed(report, "load_size").verdict, AuditVerdict::pass);  // which looks at forces
}

// Every length a thousandth: all readings agree with each other, and with nothing that is known of the arm.
TEST(SpoiltCampaign, MetresUnderMillimetresFail) {
  EXPECT_EQ(checkNamed(goodReport(), "link_lengths").verdict, AuditVerdict::pass);
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    const auto shrink = [](auto& table) {
      for (auto& row : table.rows) row.point *= 1e-3;
    };
    shrink(*campaign.circle_sweeps);
    shrink(*campaign.wrist_sweep);
    shrink(*campaign.loading);
    shrink(*campaign.nests);
  });
  const AuditCheck& lengths = checkNamed(report, "link_lengths");
  EXPECT_EQ(lengths.verdict, AuditVerdict::fail);
  EXPECT_EQ(lengths.where, "axes 2 and 3");  // the longest link, 1120 mm
  EXPECT_TRUE(contains(lengths.message, "another unit, or the URDF is another machine's")) << lengths.message;
  EXPECT_EQ(checkNamed(report, "load_size").verdict, AuditVerdict::warn);
  EXPECT_TRUE(findsTheImpossible(report));
}

TEST(SpoiltCampaign, SweepsInRadiansFail) {
  EXPECT_EQ(checkNamed(goodReport(), "sweep_angles").verdict, AuditVerdict::pass);
  EXPECT_LT(*checkNamed(goodReport(), "sweep_angles").value, 1.01);  // sag turns joints by milliradians, of a radian or two
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    for (CircleReading& row : campaign.circle_sweeps->rows) row.q *= kDegree;
  });
  const AuditCheck& check = checkNamed(report, "sweep_angles");
  EXPECT_EQ(check.verdict, AuditVerdict::fail);
  EXPECT_NEAR(*check.value, 57.3, 0.1);
  EXPECT_TRUE(contains(check.message, "in another unit (radians for degrees)")) << check.message;
  EXPECT_TRUE(findsTheImpossible(report));
}

// One reflector was hidden for most of the way, the others were not: the joint turned by what each of them saw.
TEST(SpoiltCampaign, AReflectorHiddenForAPartOfTheSweepIsNoOtherUnit) {
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    std::erase_if(campaign.circle_sweeps->rows, [](const CircleReading& row) {
      return row.axis == 3 && row.target == 1 && std::abs(row.q[3]) > 45.0 * kDegree;
    });
  });
  const AuditCheck& check = checkNamed(report, "sweep_angles");
  EXPECT_EQ(check.verdict, AuditVerdict::pass) << check.message;
  EXPECT_LT(*check.value, 1.01) << check.message;
}

TEST(SpoiltCampaign, AnAxisThatReportsOneAngleFails) {
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    for (CircleReading& row : campaign.circle_sweeps->rows) {
      if (row.axis == 4) row.q[4] = 0.1;
    }
  });
  const AuditCheck& check = checkNamed(report, "sweep_angles");
  EXPECT_EQ(check.verdict, AuditVerdict::fail);
  EXPECT_FALSE(check.value);
  EXPECT_TRUE(contains(check.message, "axis 5 reports one and the same angle")) << check.message;
}

// Forces that are noise say nothing of units, whatever stiffness and lever follow from them.
TEST(SpoiltCampaign, ForcesThatAreNoiseAreNoImpossibleOnes) {
  const AuditReport report = auditSpoilt([](Campaign& campaign) {
    double sign = 1.0;
    for (State& row : campaign.states->rows)
      row.wrench_in_cell.head<3>() = (sign = -sign) * Eigen::Vector3d(0.7, -0.2, 0.5);
  });
  EXPECT_FALSE(checkNamed(report, "load_size").impossible);
  EXPECT_FALSE(findsTheImpossible(report));
}

TEST(ApparentStiffness, ByHand) {
  EXPECT_FALSE(apparentStiffness({}));
  LoadCase load_case;
  load_case.wrench.force = {0.0, 600.0, -800.0};
  load_case.targets.push_back({0, Eigen::Vector3d::Zero(), Eigen::Vector3d(0.0, 0.0, -1e-3), 1, 1});
  load_case.targets.push_back({1, Eigen::Vector3d::Zero(), Eigen::Vector3d(0.0, 0.0, -7e-3), 1, 1});
  const auto found = apparentStiffness({load_case, load_case});
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->force, 1000.0);
  EXPECT_DOUBLE_EQ(found->displacement, 5e-3);  // root of (1 + 49) / 2
  EXPECT_EQ(implausibleLoad(*found), "");       // 2e5 N/m
  EXPECT_EQ(implausibleLoad({1.0, 5e-3}).rfind("1 N rms move the reflectors by 5 mm rms, 0.2 N/mm", 0), 0u)
      << implausibleLoad({1.0, 5e-3});
  EXPECT_TRUE(contains(implausibleLoad({1000.0, 5e-6}), "lengths (m for mm)"));
  load_case.wrench.force.setZero();  // a moment alone
  EXPECT_FALSE(apparentStiffness({load_case}));
}

}  // namespace
}  // namespace stiffscope
