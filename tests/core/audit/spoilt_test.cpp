#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include "core/audit/remarks.h"
#include "core/io/units.h"
#include "tests/fixtures/spoilt_campaign.h"

// The audit names each way a day is spoilt, with the row where a row is guilty.

namespace stiffscope {
namespace spoilt_test {

/// Checks that found something and that the good campaign passes, but for `meant`.
std::vector<std::string> besides(const audit::AuditReport& report, const std::vector<std::string>& meant) {
  std::vector<std::string> others;
  for (std::size_t i = 0; i < report.checks.size(); ++i) {
    const preparation::AuditCheck& check = report.checks[i];
    if (check.verdict != preparation::AuditVerdict::warn && check.verdict != preparation::AuditVerdict::fail) continue;
    if (std::find(meant.begin(), meant.end(), check.id) != meant.end()) continue;
    if (goodReport().checks[i].verdict == preparation::AuditVerdict::pass)
      others.push_back(check.id + ": " + reports::words(check.message));
  }
  return others;
}

#define EXPECT_ONLY(report, ...) \
  EXPECT_EQ(besides(report, std::vector<std::string>(__VA_ARGS__)), std::vector<std::string>{})

campaign::LoadingReading& reading(campaign::Campaign& campaign, int pose, int step, int repeat, int target) {
  for (campaign::LoadingReading& row : campaign.loading->rows) {
    if (row.pose == pose && row.step == step && row.repeat == repeat && row.target == target) return row;
  }
  throw std::out_of_range("no such reading");
}

campaign::State& state(campaign::Campaign& campaign, int pose, int step) {
  for (campaign::State& row : campaign.states->rows) {
    if (row.pose == pose && row.step == step) return row;
  }
  throw std::out_of_range("no such state");
}

TEST(SpoiltCampaign, TheGoodOneDoesNotFail) {
  EXPECT_NE(goodReport().verdict, preparation::AuditVerdict::fail);
  EXPECT_TRUE(goodReport().rejected.empty());
}

TEST(SpoiltCampaign, EveryCheckOfTheTableReportsInItsOrder) {
  std::vector<std::string> ids, table;
  for (const preparation::AuditCheck& check : goodReport().checks) {
    if (ids.empty() || ids.back() != check.id) ids.push_back(check.id);
  }
  for (const preparation::AuditCheckId& check : preparation::kAuditCheckIds) {
    if (!check.of_rail) table.emplace_back(check.id);
  }
  EXPECT_EQ(ids, table);
  // 1 % over the day by these limits: one that joins or leaves moves every other, on purpose only.
  EXPECT_EQ(preparation::limitsByChance(), 21);
}

TEST(SpoiltCampaign, LostBeam) {
  std::size_t line = 0;
  const audit::AuditReport report = auditSpoilt([&](campaign::Campaign& campaign) {
    campaign::LoadingReading& row = reading(campaign, 4, 2, 2, 1);
    row.point.setZero();
    line = row.line;
  });
  const preparation::AuditCheck& check = checkNamed(report, "lost_beam");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_EQ(reports::words(check.where), fmt::format("loading.csv:{}", line));
  ASSERT_EQ(report.rejected.size(), 1u);
  EXPECT_EQ(report.rejected[0].line, line);
  EXPECT_EQ(checkNamed(report, "completeness").verdict, preparation::AuditVerdict::warn);  // a repeat short now
  EXPECT_ONLY(report, {"lost_beam", "completeness"});
}

TEST(SpoiltCampaign, DuplicatedReading) {
  std::size_t line = 0;
  const audit::AuditReport report = auditSpoilt([&](campaign::Campaign& campaign) {
    campaign::LoadingReading& row = reading(campaign, 7, 1, 3, 0);
    row.point = reading(campaign, 7, 1, 2, 0).point;
    line = row.line;
  });
  EXPECT_EQ(reports::words(checkNamed(report, "duplicate_readings").where), fmt::format("loading.csv:{}", line));
  EXPECT_ONLY(report, {"duplicate_readings", "completeness"});
}

TEST(SpoiltCampaign, NestsInMetres) {
  const audit::AuditReport report = auditSpoilt([&](campaign::Campaign& campaign) {
    for (campaign::NestReading& row : campaign.nests->rows) row.point *= 1e-3;
  });
  const preparation::AuditCheck& check = checkNamed(report, "nest_moved");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_FALSE(check.value || check.limit);  // how far they scatter says nothing
  EXPECT_NE(reports::words(check.message).find("closer than two reflectors can: the coordinates are in another unit"),
            std::string::npos)
      << reports::words(check.message);
}

TEST(SpoiltCampaign, OneRepeatOff) {
  std::size_t line = 0;
  const audit::AuditReport report = auditSpoilt([&](campaign::Campaign& campaign) {
    campaign::LoadingReading& row = reading(campaign, 2, 3, 1, 2);
    row.point.y() += 0.3e-3;  // 20 times the noise
    line = row.line;
  });
  EXPECT_EQ(reports::words(checkNamed(report, "repeat_outliers").where), fmt::format("loading.csv:{}", line));
  EXPECT_ONLY(report, {"repeat_outliers", "completeness"});
}

TEST(SpoiltCampaign, ReflectorsExchanged) {
  const audit::AuditReport report = auditSpoilt([&](campaign::Campaign& campaign) {
    for (const int repeat : {1, 2, 3}) {
      std::swap(reading(campaign, 5, 3, repeat, 0).point, reading(campaign, 5, 3, repeat, 1).point);
    }
  });
  const preparation::AuditCheck& check = checkNamed(report, "rigid_tool");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_TRUE(contains(check.message, "P10 is P11, P11 is P10")) << reports::words(check.message);
  EXPECT_TRUE(contains(check.message, "pose 6, step 3")) << reports::words(check.message);
  campaign::Campaign campaign = good();
  EXPECT_EQ(reports::words(check.where), fmt::format("loading.csv:{}", reading(campaign, 5, 3, 1, 0).line));
}

TEST(SpoiltCampaign, LooseReflector) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    // P11 sits 0.1 mm lower in its nest from the eighth posture on.
    for (campaign::LoadingReading& row : campaign.loading->rows) {
      if (row.target == 1 && row.pose >= 7) row.point.z() -= 0.1e-3;
    }
  });
  const preparation::AuditCheck& check = checkNamed(report, "rigid_tool");
  EXPECT_NE(check.verdict, preparation::AuditVerdict::pass);
  EXPECT_TRUE(contains(check.message, "reflector P11 moves")) << reports::words(check.message);
  EXPECT_TRUE(contains(check.where, "P11")) << reports::words(check.where);
}

TEST(SpoiltCampaign, StepsInWrongOrder) {
  std::size_t line = 0;
  const audit::AuditReport report = auditSpoilt([&](campaign::Campaign& campaign) {
    for (campaign::LoadingReading& row : campaign.loading->rows) {
      if (row.pose != 3 || (row.step != 1 && row.step != 2)) continue;
      row.step = 3 - row.step;
      if (row.step == 2 && line == 0) line = row.line;
    }
  });
  const preparation::AuditCheck& check = checkNamed(report, "time_order");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_EQ(reports::words(check.where), fmt::format("loading.csv:{}", line));
  EXPECT_TRUE(contains(check.message, "pose 4: step 2 before step 1")) << reports::words(check.message);
}

TEST(SpoiltCampaign, StationBumpedBeforeLoadingWithoutNests) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    campaign.nests.reset();
    for (campaign::LoadingReading& row : campaign.loading->rows) row.point += Eigen::Vector3d(1.2e-3, -0.8e-3, 0.5e-3);
  });
  const preparation::AuditCheck& check = checkNamed(report, "frame_moved");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_NEAR(*check.value, 1.53e-3, 0.15e-3);  // m; a tenth for what the bearings' sag leaves open
  EXPECT_EQ(checkNamed(report, "station_drift").verdict, preparation::AuditVerdict::not_testable);
  EXPECT_ONLY(report, {"frame_moved"});
}

TEST(SpoiltCampaign, StationDrifts) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    const auto drift = [](auto& table) {
      for (auto& row : table.rows) row.point.x() += 5e-8 * row.time_s;  // 3 um a minute
    };
    drift(*campaign.circle_sweeps);
    drift(*campaign.wrist_sweep);
    drift(*campaign.loading);
    drift(*campaign.nests);
  });
  const preparation::AuditCheck& check = checkNamed(report, "station_drift");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_TRUE(contains(check.message, "a drift of")) << reports::words(check.message);
  EXPECT_ONLY(report, {"station_drift"});
}

TEST(SpoiltCampaign, NestMoved) {
  std::size_t line = 0;
  const audit::AuditReport report = auditSpoilt([&](campaign::Campaign& campaign) {
    for (campaign::NestReading& row : campaign.nests->rows) {
      if (row.nest != 2 || row.time_s < 5000.0) continue;
      row.point.x() += 0.5e-3;
      if (line == 0) line = row.line;
    }
  });
  const preparation::AuditCheck& check = checkNamed(report, "nest_moved");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::warn);
  EXPECT_EQ(reports::words(check.where), fmt::format("nests.csv:{}", line));
  EXPECT_TRUE(contains(check.message, "nest N3 moved")) << reports::words(check.message);
  EXPECT_ONLY(report, {"nest_moved"});
}

TEST(SpoiltCampaign, WrongTare) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    for (campaign::State& row : campaign.states->rows) row.wrench_in_cell[2] += 8.0;
  });
  const preparation::AuditCheck& check = checkNamed(report, "tare");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::warn);
  EXPECT_TRUE(contains(check.message, "not tared")) << reports::words(check.message);
}

TEST(SpoiltCampaign, SignOfAMomentTurnedRound) {
  std::size_t line = 0;
  const audit::AuditReport report = auditSpoilt([&](campaign::Campaign& campaign) {
    campaign::State& row = state(campaign, 9, 3);
    row.wrench_in_cell[3] = -row.wrench_in_cell[3];
    line = row.line;
  });
  const preparation::AuditCheck& check = checkNamed(report, "moment_lever");
  EXPECT_NE(check.verdict, preparation::AuditVerdict::pass);
  EXPECT_EQ(reports::words(check.where), fmt::format("states.csv:{}", line));
  EXPECT_TRUE(contains(check.message, "with mx of that state turned round they agree"))
      << reports::words(check.message);
}

TEST(SpoiltCampaign, StaleJointAngle) {
  std::size_t line = 0;
  const audit::AuditReport report = auditSpoilt([&](campaign::Campaign& campaign) {
    for (campaign::State& row : campaign.states->rows) {
      if (row.pose == 11) row.q[2] += 0.3 * io::kDegree;  // read before joint 3 had settled
    }
    line = state(campaign, 11, 0).line;
  });
  const preparation::AuditCheck& check = checkNamed(report, "joint_read_back");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_EQ(reports::words(check.where), fmt::format("states.csv:{}", line));
  EXPECT_TRUE(contains(check.message, "pose 12: joint 3 stands -0.3")) << reports::words(check.message);
  EXPECT_ONLY(report, {"joint_read_back"});
}

TEST(SpoiltCampaign, ShortArc) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    std::erase_if(campaign.circle_sweeps->rows, [](const campaign::CircleReading& row) {
      return row.axis == 0 && std::abs(row.q[0]) > 16.0 * io::kDegree;
    });
  });
  const preparation::AuditCheck& check = checkNamed(report, "circle_arc", "axis 1");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_LT(*check.value, 32.0 * io::kDegree);
  EXPECT_TRUE(contains(check.message, "does not suffice")) << reports::words(check.message);
}

TEST(SpoiltCampaign, AReflectorThatIsHiddenOverPartOfASweepLeavesTheArcOfTheOthers) {
  const preparation::AuditCheck& whole = checkNamed(goodReport(), "circle_arc", "axis 2");
  for (const int hidden : {0, 1, 2}) {
    const audit::AuditReport report = auditSpoilt([hidden](campaign::Campaign& campaign) {
      std::erase_if(campaign.circle_sweeps->rows, [hidden](const campaign::CircleReading& row) {
        return row.axis == 1 && row.target == hidden && std::abs(row.q[1]) > 16.0 * io::kDegree;
      });
    });
    const preparation::AuditCheck& check = checkNamed(report, "circle_arc", "axis 2");
    EXPECT_NEAR(*check.value, *whole.value, 1e-3) << hidden;
    EXPECT_EQ(check.verdict, whole.verdict) << hidden << ": " << reports::words(check.message);
  }
}

TEST(SpoiltCampaign, WideArcsOfFewReadingsOfOneReflector) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    int count = 0;
    std::erase_if(campaign.circle_sweeps->rows, [&](const campaign::CircleReading& row) {
      return row.axis == 2 && (row.target != 0 || count++ % 5 != 0);
    });
  });
  const preparation::AuditCheck& check = checkNamed(report, "circle_arc", "axis 3");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::warn);
  EXPECT_GT(*check.value, 80.0 * io::kDegree);
  EXPECT_TRUE(contains(check.message, "does not suffice")) << reports::words(check.message);
}

TEST(SpoiltCampaign, OneReadingOffItsCircleIsNamed) {
  // The bearings' misfit runs along the sweep; a reading 2 mm off is another matter.
  EXPECT_TRUE(contains(checkNamed(goodReport(), "circle_residual").message, "that of axes 3, 4"));
  EXPECT_TRUE(contains(checkNamed(goodReport(), "circle_residual").message, "runs along the sweep"));
  std::size_t line = 0;
  const audit::AuditReport report = auditSpoilt([&](campaign::Campaign& campaign) {
    for (campaign::CircleReading& row : campaign.circle_sweeps->rows) {
      if (row.axis != 5 || row.target != 1 || line != 0) continue;
      row.point += Eigen::Vector3d(2e-3, 2e-3, 2e-3);
      line = row.line;
    }
  });
  const preparation::AuditCheck& check = checkNamed(report, "circle_residual");
  EXPECT_TRUE(
      contains(check.message, fmt::format("most of that of axis 6 is the one reading circle_sweeps.csv:{}", line)))
      << reports::words(check.message);
}

TEST(SpoiltCampaign, AMaximumPermissibleErrorDeclaredAsSigma) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    campaign::Tracker& tracker = *campaign.tracker;
    for (double* figure : {&tracker.range_fixed, &tracker.range_per_m, &tracker.angle_fixed, &tracker.angle_per_m})
      *figure *= 2.5;
  });
  const preparation::AuditCheck& check = checkNamed(report, "repeatability_across");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::pass);  // the repeats are no worse than declared
  ASSERT_EQ(check.details.size(), 1u);
  EXPECT_TRUE(check.details[0].is(audit::RemarkId::repeats_scatter_little));
  EXPECT_EQ(checkNamed(report, "noise_declared", "tracker").verdict, preparation::AuditVerdict::warn);
}

TEST(SpoiltCampaign, EveryJointIsJudgedInThePostureSet) {
  const preparation::AuditCheck& check = checkNamed(goodReport(), "posture_set");
  ASSERT_EQ(check.details.size(), 6u);
  EXPECT_TRUE(contains(check.details[0], "joint 1: not identifiable: the load only hangs"));
  for (std::size_t j = 1; j < 6; ++j) EXPECT_TRUE(check.details[j].is(audit::RemarkId::joint_identifiable)) << j;
  EXPECT_TRUE(check.message.is(audit::RemarkId::joints_identified));
}

TEST(SpoiltCampaign, AngleOfOneStepChanged) {
  std::size_t line = 0;
  const audit::AuditReport report = auditSpoilt([&](campaign::Campaign& campaign) {
    campaign::State& row = state(campaign, 1, 3);
    row.q[1] += 0.01 * io::kDegree;
    line = row.line;
  });
  EXPECT_EQ(checkNamed(report, "servo_change").verdict, preparation::AuditVerdict::warn);
  EXPECT_EQ(reports::words(checkNamed(report, "servo_change").where), fmt::format("states.csv:{}", line));
  EXPECT_ONLY(report, {"servo_change"});
}

TEST(SpoiltCampaign, DoesNotComeBackToZero) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    for (campaign::LoadingReading& row : campaign.loading->rows) {
      if (row.pose == 14 && row.step == 4) row.point.z() -= 0.1e-3;
    }
  });
  const preparation::AuditCheck& check = checkNamed(report, "return_to_zero");
  EXPECT_NE(check.verdict, preparation::AuditVerdict::pass);
  EXPECT_TRUE(contains(check.message, "1 of 19 postures do not come back: 15 by")) << reports::words(check.message);
  EXPECT_ONLY(report, {"return_to_zero"});
}

TEST(SpoiltCampaign, ClockOfTheStatesAnHourAhead) {
  for (const double ahead : {3600.0, -7200.0}) {
    const audit::AuditReport report = auditSpoilt([&](campaign::Campaign& campaign) {
      for (campaign::State& row : campaign.states->rows) row.time_s += ahead;
    });
    const preparation::AuditCheck& check = checkNamed(report, "time_order");
    EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
    EXPECT_TRUE(contains(check.message, ahead > 0.0 ? "the clock of states.csv is 3600 s ahead of that of loading.csv"
                                                    : "the clock of states.csv is 7200 s behind that of loading.csv"))
        << reports::words(check.message);
    EXPECT_LT(reports::words(check.message).size(), 250u);
  }
}

TEST(SpoiltCampaign, StatesSortedAsTextAndNumberedAfresh) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    std::vector<std::string> as_text = campaign.pose_ids;
    std::sort(as_text.begin(), as_text.end());
    std::map<std::string, int> place;
    for (std::size_t i = 0; i < as_text.size(); ++i) place[as_text[i]] = static_cast<int>(i);
    for (campaign::State& row : campaign.states->rows)
      row.pose = place.at(campaign.pose_ids[static_cast<std::size_t>(row.pose)]);
  });
  const preparation::AuditCheck& check = checkNamed(report, "time_order");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  EXPECT_TRUE(contains(check.message, "pose 2 while 10 was: the table was sorted as text"))
      << reports::words(check.message);
  const preparation::AuditCheck& arm = checkNamed(report, "arm_model");
  EXPECT_EQ(arm.verdict, preparation::AuditVerdict::fail);
  EXPECT_TRUE(contains(arm.message, "one of the usual mistakes explains it")) << reports::words(arm.message);
  ASSERT_EQ(report.suspected.size(), 1u);
  EXPECT_TRUE(contains(report.suspected.front().remedy, "in the order of their names as texts"))
      << reports::words(report.suspected.front().remedy);
}

TEST(SpoiltCampaign, ManyStepsInWrongOrderAreNotAllListed) {
  const audit::AuditReport report = auditSpoilt([](campaign::Campaign& campaign) {
    for (campaign::LoadingReading& row : campaign.loading->rows) {
      if (row.step == 1 || row.step == 2) row.step = 3 - row.step;
    }
  });
  const preparation::AuditCheck& check = checkNamed(report, "time_order");
  EXPECT_TRUE(contains(check.message, "pose 1: step 2 before step 1")) << reports::words(check.message);
  EXPECT_TRUE(contains(check.message, fmt::format("and {:.0f} more", *check.value - 8.0)))
      << reports::words(check.message);
}

TEST(SpoiltCampaign, ReflectorsRenamedFromAPostureOn) {
  std::size_t line = 0;
  const audit::AuditReport report = auditSpoilt([&](campaign::Campaign& campaign) {
    for (campaign::LoadingReading& row : campaign.loading->rows) {
      if (row.pose < 12 || row.target > 1) continue;
      row.target = 1 - row.target;
      if (line == 0) line = row.line;
    }
  });
  const preparation::AuditCheck& check = checkNamed(report, "rigid_tool");
  EXPECT_EQ(check.verdict, preparation::AuditVerdict::fail);
  const std::string words = reports::words(check.message);
  EXPECT_TRUE(contains(words, fmt::format("reflectors exchanged from loading.csv:{} (pose 13, step 0) on: ", line)))
      << words;
  EXPECT_EQ(words.find("reflectors exchanged"), words.rfind("reflectors exchanged")) << words;
  for (const char* id : {"arm_model", "load_model"}) {
    EXPECT_FALSE(contains(checkNamed(report, id).message, "none of the usual mistakes"))
        << id << ": " << reports::words(checkNamed(report, id).message);
  }
}

}  // namespace spoilt_test
}  // namespace stiffscope
