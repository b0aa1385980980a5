#include "core/fleet/fleet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "core/fleet/remarks.h"
#include "reports/csv/fleet_csv.h"
#include "reports/page/pages.h"
#include "reports/words/remark_words.h"
#include "reports/words/rich_text.h"
#include "tests/core/fleet/made_days.h"

namespace stiffscope::fleet {
namespace fleet_test {

std::vector<FleetCampaign> campaignsOf(const std::string& machine, std::vector<CampaignResult> days) {
  std::vector<FleetCampaign> campaigns;
  for (std::size_t t = 0; t < days.size(); ++t) {
    FleetCampaign one;
    one.machine = machine, one.date = "2026-01-" + std::to_string(10 + t), one.folder = machine + "/" + one.date;
    days[t].diagnosed = true;
    one.result = std::move(days[t]);
    campaigns.push_back(std::move(one));
  }
  return campaigns;
}

void add(std::vector<FleetCampaign>& all, std::vector<FleetCampaign> more) {
  all.insert(all.end(), more.begin(), more.end());
}

Fleet studied(std::vector<FleetCampaign> campaigns) {
  sortCampaigns(campaigns);
  return studyFleet(campaigns, pairsOf(seriesOf(campaigns)));
}

SpringsOfDay& springs(FleetCampaign& one) {
  return one.result->springs[static_cast<std::size_t>(identification::Method::partial_pose)];
}

const Machine& machine(const Fleet& fleet, const std::string& name) {
  return *std::find_if(fleet.machines.begin(), fleet.machines.end(),
                       [&](const Machine& one) { return one.name == name; });
}

TEST(Fleet, MachinesThatNeedMostStandFirst) {
  std::mt19937_64 draws(1);
  std::vector<FleetCampaign> all;
  add(all, campaignsOf("well", unchangedDays(draws, 6, 12)));
  std::vector<FleetCampaign> softer = campaignsOf("softer", unchangedDays(draws, 6, 12));
  for (std::size_t t = 3; t < 6; ++t) springs(softer[t]).compliance[1] += 20.0;
  add(all, softer);
  std::vector<FleetCampaign> failing = campaignsOf("failing", unchangedDays(draws, 6, 12));
  failing.back().result->audit = preparation::AuditVerdict::fail;
  failing.back().result->failed_checks = {"tare"};
  add(all, failing);
  std::vector<FleetCampaign> broken = campaignsOf("broken", unchangedDays(draws, 6, 12));
  broken[2].result.reset();
  broken[2].failure = "states.csv:3: fx_n";
  add(all, broken);
  std::vector<FleetCampaign> strange = campaignsOf("strange", unchangedDays(draws, 6, 12));
  for (FleetCampaign& one : strange) one.result->effects = {{{"unknown"}, ""}};
  add(all, strange);
  const Fleet fleet = studied(all);
  ASSERT_EQ(fleet.machines.size(), 5u);
  EXPECT_EQ(fleet.machines[0].name, "broken");
  EXPECT_EQ(fleet.machines[1].name, "failing");
  EXPECT_EQ(fleet.machines[2].name, "softer");
  EXPECT_EQ(fleet.machines[3].name, "strange");
  EXPECT_EQ(fleet.machines[4].name, "well");
  EXPECT_EQ(fleet.machines[0].needs.front().id, NeedId::no_result);
  EXPECT_EQ(fleet.machines[4].needs.front().id, NeedId::nothing);
  ASSERT_EQ(fleet.steps.size(), 1u);
  EXPECT_EQ(fleet.campaigns[fleet.steps[0].campaign].date, "2026-01-13");
  EXPECT_EQ(fleet.steps[0].compliance.joint, 1);
  EXPECT_LE(fleet.steps[0].p_holm, kFleetLevel);
  EXPECT_EQ(fleet.chart_questions, 5u);
  // The broken day misses in the series, and the days about it follow each other.
  const auto of_broken = std::count_if(fleet.pairs.begin(), fleet.pairs.end(), [&](const FleetPair& pair) {
    return fleet.campaigns[pair.after].machine == "broken";
  });
  EXPECT_EQ(of_broken, 4);
}

TEST(Fleet, AnEffectThatStaysIsAChangeAndOneOfTheLastDayAQuestion) {
  std::mt19937_64 draws(2);
  const EffectFound base{{"base_compliance"}, ""}, bearing{{"bearing_tilt"}, "joint 2"};
  std::vector<FleetCampaign> loose = campaignsOf("loose", unchangedDays(draws, 6, 12));
  std::vector<FleetCampaign> once = campaignsOf("once", unchangedDays(draws, 6, 12));
  std::vector<FleetCampaign> flickers = campaignsOf("flickers", unchangedDays(draws, 6, 12));
  for (std::size_t t = 0; t < 6; ++t) {
    loose[t].result->effects = t < 4 ? std::vector{bearing} : std::vector{bearing, base};
    once[t].result->effects = t < 5 ? std::vector{bearing} : std::vector{bearing, base};
    flickers[t].result->effects = t % 2 == 0 ? std::vector{bearing} : std::vector{bearing, base};
  }
  std::vector<FleetCampaign> all = loose;
  add(all, once), add(all, flickers);
  const Fleet fleet = studied(all);
  EXPECT_EQ(machine(fleet, "loose").needs.front().id, NeedId::changed);
  EXPECT_TRUE(machine(fleet, "loose").needs.front().reason.is(RemarkId::effect_appeared));
  EXPECT_EQ(fleet.campaigns[machine(fleet, "loose").needs.front().campaign].date, "2026-01-14");
  EXPECT_EQ(machine(fleet, "once").needs.front().id, NeedId::perhaps_changed);
  EXPECT_EQ(machine(fleet, "flickers").needs.front().id, NeedId::nothing);
}

TEST(Fleet, AChangeOfThePairsIsCorrectedOverTheFleet) {
  std::mt19937_64 draws(3);
  std::vector<FleetCampaign> all = campaignsOf("a", unchangedDays(draws, 3, 12));
  add(all, campaignsOf("b", unchangedDays(draws, 3, 12)));
  sortCampaigns(all);
  std::vector<FleetPair> pairs = pairsOf(seriesOf(all));
  ASSERT_EQ(pairs.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    pairs[i].result.emplace(6);
    pairs[i].result->p_value[1] = 0.01 * static_cast<double>(i + 1);
  }
  const Fleet fleet = studyFleet(all, pairs);
  EXPECT_EQ(fleet.pair_questions, 4u);
  EXPECT_DOUBLE_EQ(fleet.pairs[0].p_holm[1], 0.04);
  EXPECT_DOUBLE_EQ(fleet.pairs[1].p_holm[1], 0.06);
  EXPECT_DOUBLE_EQ(fleet.pairs[3].p_holm[1], 0.06);
  EXPECT_FALSE(std::isfinite(fleet.pairs[0].p_holm[0]));
}

TEST(Fleet, StatesOfTheEncodersAreNotMixed) {
  std::mt19937_64 draws(4);
  std::vector<FleetCampaign> all = campaignsOf("a", unchangedDays(draws, 4, 12));
  all[1].result->encoders = all[3].result->encoders = campaign::DoubleEncoder::active;
  const std::vector<DaySeries> series = seriesOf(all);
  ASSERT_EQ(series.size(), 2u);
  for (const FleetPair& pair : pairsOf(series))
    EXPECT_EQ(all[pair.before].result->encoders, all[pair.after].result->encoders);
}

/// Six parallel axes a metre apart, the second so far (m) from where it should be.
PerJoint<metrology::Line> axesWithSecondAt(double x) {
  PerJoint<metrology::Line> axes;
  for (int axis = 0; axis < 6; ++axis) {
    axes.push_back({Eigen::Vector3d(axis + (axis == 1 ? x : 0.0), 0.0, 0.0), Eigen::Vector3d::UnitZ()});
  }
  return axes;
}

// As of folders without a serial, each a machine of its own: `compare` refuses them, and so nothing is compared here.
TEST(Fleet, DifferentMachinesUnderOneNameAreNotCompared) {
  std::mt19937_64 draws(10);
  std::vector<FleetCampaign> all = campaignsOf("lab", unchangedDays(draws, 8, 12));
  for (std::size_t t = 0; t < 8; ++t) {
    const bool other = t % 2 == 1;
    all[t].result->axes = axesWithSecondAt(other ? 0.65 : 0.0);
    if (other) springs(all[t]).compliance[1] += 8000.0;
    if (t >= 4) all[t].result->effects = {{{"base_compliance"}, ""}};
  }
  // The last days of both machines are looked at, not that of the later alone.
  all[6].result->audit = preparation::AuditVerdict::fail;
  std::vector<FleetPair> pairs = pairsOf(seriesOf(all));
  compareLoaded(all, pairs);
  ASSERT_EQ(pairs.size(), 6u);
  for (const FleetPair& pair : pairs) {
    EXPECT_EQ(pair.before % 2, pair.after % 2);
    EXPECT_LT(std::abs(pair.result->difference[1].value), 20.0);
  }
  const Fleet fleet = studyFleet(all, pairs);
  ASSERT_EQ(fleet.arms.size(), 2u);
  EXPECT_EQ(fleet.arms[1].campaigns, (std::vector<std::size_t>{1, 3, 5, 7}));
  ASSERT_EQ(fleet.charts.size(), 2u);
  EXPECT_EQ(fleet.charts[0].joints[1].points.size(), 4u);
  for (const FleetStep& step : fleet.steps) EXPECT_EQ(step.what, FleetStep::What::effect_appeared);
  const std::vector<Need>& needs = fleet.machines.at(0).needs;
  ASSERT_EQ(needs.front().id, NeedId::several_machines);
  EXPECT_EQ(
      std::count_if(needs.begin(), needs.end(), [](const Need& one) { return one.id == NeedId::several_machines; }), 1);
  EXPECT_EQ(needs[1].id, NeedId::audit_failed);
  EXPECT_EQ(reports::plain(reports::words(needs.front().reason)),
            "2 machines under one name, not compared with each other: of lab/2026-01-10 and lab/2026-01-11 the URDFs "
            "describe different machines: axis 2 stands 650.0 mm elsewhere");
  const std::string next = reports::plain(reports::words(needs.front().next));
  EXPECT_NE(next.find("robot_serial"), std::string::npos) << next;
  EXPECT_NE(next.find("folder of its own"), std::string::npos) << next;
  const std::string page = page::fleetPage(fleet, {}, "0"), table = reports::detectableCsv(fleet);
  EXPECT_NE(page.find("lab (machine 2 of 2)"), std::string::npos);
  EXPECT_NE(page.find("axis 2 stands 650.0 mm elsewhere"), std::string::npos);
  EXPECT_NE(table.find(",1\r\n"), std::string::npos) << table;
  EXPECT_NE(table.find(",2\r\n"), std::string::npos) << table;
}

// Two URDFs of one machine round differently; three in a row may be further apart than two of them.
TEST(Fleet, OneArmIsWhatNoTwoDaysAreRefusedFor) {
  std::mt19937_64 draws(11);
  std::vector<FleetCampaign> all = campaignsOf("a", unchangedDays(draws, 3, 12));
  for (std::size_t t = 0; t < 3; ++t) all[t].result->axes = axesWithSecondAt(0.0008 * static_cast<double>(t));
  ASSERT_EQ(armsOf(all).size(), 2u);
  EXPECT_EQ(armsOf(all)[0].campaigns, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(armsOf(all)[1].differs_from, 0u);
  all.pop_back();
  EXPECT_EQ(armsOf(all).size(), 1u);
  EXPECT_EQ(studied(all).machines[0].needs.front().id, NeedId::nothing);
  // Names of their own need nothing: the same arm elsewhere is another machine.
  all[1].machine = "b", all[1].result->axes = axesWithSecondAt(0.65);
  EXPECT_EQ(armsOf(all).size(), 2u);
  for (const Machine& one : studied(all).machines) EXPECT_EQ(one.needs.front().id, NeedId::nothing);
}

TEST(Fleet, ArmsOfOtherJointsAreDifferentMachines) {
  std::mt19937_64 draws(12);
  std::vector<FleetCampaign> all = campaignsOf("a", unchangedDays(draws, 3, 12));
  all[0].result->axes = axesWithSecondAt(0.0), all[1].result.emplace(5);
  all[2].result->axes = axesWithSecondAt(0.0);  // a rod's axis beside: six joints, seven axes
  all[2].result->axes.push_back({Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()});
  const std::vector<Arm> arms = armsOf(all);
  ASSERT_EQ(arms.size(), 3u);
  EXPECT_EQ(reports::words(arms[1].difference), "the URDFs describe different machines: 6 joints and 5");
  EXPECT_EQ(reports::words(arms[2].difference), "the URDFs describe different machines: 6 joints and 7");
  const Fleet fleet = studied(all);
  EXPECT_TRUE(fleet.pairs.empty());
  EXPECT_EQ(fleet.machines[0].needs.front().id, NeedId::several_machines);
}

TEST(Fleet, WhoseACampaignIs) {
  EXPECT_EQ(machineOf("F-17", "arm of cell 3", "lab/cell3/2026-01-05"), "F-17");
  EXPECT_EQ(machineOf("", "arm of cell 3", "lab/cell3/2026-01-05"), "arm of cell 3");
  EXPECT_EQ(machineOf("", "", "lab/cell3/2026-01-05"), "cell3");
  EXPECT_EQ(machineOf("", "", "lab/cell3/2026-01-05/"), "cell3");
  // From within the folder above it is the same machine as from elsewhere.
  const std::filesystem::path here = std::filesystem::current_path();
  EXPECT_EQ(machineOf("", "", "2026-01-05"), here.filename().string());
  EXPECT_EQ(machineOf("", "", "./2026-01-05"), here.filename().string());
  EXPECT_EQ(machineOf("", "", "."), here.parent_path().filename().string());
  EXPECT_EQ(machineOf("", "", "/2026-01-05"), "2026-01-05");
}

// Two days that follow each other: the difference with what their postures share taken off, by hand.
TEST(Fleet, DaysThatFollowEachOtherAreComparedFromWhatIsKept) {
  std::vector<FleetCampaign> all = campaignsOf("a", {dayOf({0.6, 0.8}, 100.0), dayOf({0.3, 1.2}, 103.0)});
  std::vector<FleetPair> pairs = pairsOf(seriesOf(all));
  compareLoaded(all, pairs);
  ASSERT_EQ(pairs.size(), 1u);
  const PairResult& result = *pairs[0].result;
  EXPECT_TRUE(result.same_postures);
  EXPECT_EQ(result.postures, 2);
  EXPECT_DOUBLE_EQ(result.difference[1].value, 3.0);
  // sd^2 = 0.3^2 + 0.4^2; Student's factor of two degrees of freedom at 95 % is 4.303.
  EXPECT_NEAR(result.difference[1].high, 3.0 + 4.303 * 0.5, 1e-3);
  // t = 6: two-sided p of two degrees is 1 - t / sqrt(t^2 + 2).
  EXPECT_NEAR(result.p_value[1], 1.0 - 6.0 / std::sqrt(38.0), 1e-9);
  EXPECT_NEAR(result.taken[1].value, -0.03, 1e-15);
  EXPECT_FALSE(std::isfinite(result.difference[0].value));
}

/// The same days without a load, what they show shown by own weight.
std::vector<FleetCampaign> unloaded(std::vector<FleetCampaign> all) {
  for (FleetCampaign& one : all) {
    one.result->kind = DayKind::unloaded;
    one.result->own_weight = springs(one);
    for (SpringsOfDay& of_method : one.result->springs) of_method = SpringsOfDay(6);
    one.result->springs_method = one.result->method = std::nullopt;
  }
  return all;
}

// Softened by 8 % and mended: two changes, each of the dates beside it and no others.
TEST(Fleet, AChangeThatIsUndoneIsTwoChanges) {
  std::mt19937_64 draws(8);
  std::vector<FleetCampaign> mended = campaignsOf("mended", unchangedDays(draws, 10, 12));
  for (std::size_t t = 3; t < 7; ++t) springs(mended[t]).compliance[1] += 8.0;
  std::vector<FleetCampaign> all = mended;
  add(all, campaignsOf("well", unchangedDays(draws, 10, 12)));
  const Fleet fleet = studied(all);
  ASSERT_EQ(fleet.steps.size(), 2u);
  EXPECT_EQ(fleet.campaigns[fleet.steps[0].campaign].date, "2026-01-13");
  EXPECT_EQ(fleet.campaigns[fleet.steps[1].campaign].date, "2026-01-17");
  EXPECT_EQ(fleet.steps[0].days_before, 3u);
  EXPECT_EQ(fleet.steps[0].days_after, 4u);
  EXPECT_EQ(fleet.steps[1].days_before, 4u);
  EXPECT_EQ(fleet.steps[1].days_after, 3u);
  const Stated softer = fleet.steps[0].compliance.share(), stiffer = fleet.steps[1].compliance.share();
  EXPECT_LT(softer.low, 0.08);
  EXPECT_GT(softer.high, 0.08);
  EXPECT_LT(stiffer.low, -8.0 / 108.0);
  EXPECT_GT(stiffer.high, -8.0 / 108.0);
  for (const FleetStep& step : fleet.steps) EXPECT_LE(step.p_holm, kFleetLevel);
}

// A fit may give a joint less than no compliance. That it changed is said, and which way; not by what share.
TEST(Fleet, AShareOfNoComplianceIsWrittenAsNotKnown) {
  std::mt19937_64 draws(9);
  std::vector<FleetCampaign> odd = campaignsOf("odd", unchangedDays(draws, 6, 12));
  for (std::size_t t = 0; t < 6; ++t) springs(odd[t]).compliance[1] += (t < 3 ? 0.0 : 20.0) - 150.0;
  const Fleet fleet = studied(odd);
  ASSERT_EQ(fleet.steps.size(), 1u);
  EXPECT_NE(reports::stepsCsv(fleet).find("odd,2026-01-13,compliance,2,,,,,,"), std::string::npos)
      << reports::stepsCsv(fleet);
  const std::string need = reports::plain(reports::words(machine(fleet, "odd").needs.front().reason));
  EXPECT_NE(need.find("joint 2 softer from 2026-01-13 on"), std::string::npos) << need;
  const std::string page = page::fleetPage(fleet, {}, "0");
  for (const std::string& text : {need, page, reports::needsCsv(fleet), reports::stepsCsv(fleet)}) {
    for (const char* wrong : {">nan", " nan", "inf ", ">inf", "-nan"})
      EXPECT_EQ(text.find(wrong), std::string::npos) << wrong;
  }
}

// A joint of days without a load is judged as one of days with loads is, beside the geometry of each pair.
TEST(Fleet, AJointThatSoftensBetweenDaysWithoutALoadIsAChange) {
  std::mt19937_64 draws(6);
  std::vector<FleetCampaign> softer = unloaded(campaignsOf("softer", unchangedDays(draws, 6, 12)));
  for (std::size_t t = 3; t < 6; ++t) softer[t].result->own_weight.compliance[1] += 20.0;
  std::vector<FleetCampaign> all = softer;
  add(all, unloaded(campaignsOf("well", unchangedDays(draws, 6, 12))));
  sortCampaigns(all);
  std::vector<FleetPair> pairs = pairsOf(seriesOf(all));
  for (FleetPair& pair : pairs) {
    pair.result.emplace(6).kind = DayKind::unloaded;
    pair.result->machine_p = 0.4;
  }
  compareUnloaded(all, pairs);
  const Fleet fleet = studyFleet(all, pairs);
  ASSERT_EQ(fleet.steps.size(), 1u);
  EXPECT_EQ(fleet.steps[0].what, FleetStep::What::compliance);
  EXPECT_EQ(fleet.steps[0].machine, "softer");
  EXPECT_EQ(fleet.campaigns[fleet.steps[0].campaign].date, "2026-01-13");
  EXPECT_EQ(fleet.steps[0].compliance.joint, 1);
  EXPECT_EQ(fleet.chart_questions, 2u + 10u);
  EXPECT_EQ(fleet.pair_questions, 10u + 10u);
  EXPECT_TRUE(machine(fleet, "softer").needs.front().reason.is(RemarkId::compliance_changed));
  EXPECT_EQ(machine(fleet, "well").needs.front().id, NeedId::nothing);
  EXPECT_DOUBLE_EQ(fleet.pairs[2].result->difference[1].value,
                   softer[3].result->own_weight.compliance[1] - softer[2].result->own_weight.compliance[1]);
  // What is not seen is not said to be the same.
  ASSERT_EQ(fleet.charts.size(), 2u);
  EXPECT_FALSE(fleet.charts[0].method);
  EXPECT_TRUE(std::isfinite(fleet.charts[1].detectable[1].middle));
  EXPECT_GT(fleet.charts[1].detectable[1].last, fleet.charts[1].detectable[1].middle);
  EXPECT_FALSE(std::isfinite(fleet.charts[1].detectable[0].middle));
}

TEST(Fleet, DaysWithoutMassesAreComparedByTheirGeometryAlone) {
  std::mt19937_64 draws(7);
  std::vector<FleetCampaign> all = unloaded(campaignsOf("a", unchangedDays(draws, 3, 12)));
  all[1].result->own_weight = SpringsOfDay(6);
  std::vector<FleetPair> pairs = pairsOf(seriesOf(all));
  for (FleetPair& pair : pairs) pair.result.emplace(6).kind = DayKind::unloaded, pair.result->machine_p = 0.4;
  compareUnloaded(all, pairs);
  EXPECT_FALSE(std::isfinite(pairs[0].result->p_value[1]));
  const Fleet fleet = studyFleet(all, pairs);
  EXPECT_TRUE(fleet.charts.empty());
  EXPECT_EQ(fleet.chart_questions, 2u);
}

TEST(Fleet, AMovedGeometryIsAChange) {
  std::mt19937_64 draws(5);
  std::vector<FleetCampaign> all = campaignsOf("a", unchangedDays(draws, 3, 12));
  for (FleetCampaign& one : all) one.result->kind = DayKind::unloaded;
  std::vector<FleetPair> pairs = pairsOf(seriesOf(all));
  for (FleetPair& pair : pairs) pair.result.emplace(6).kind = DayKind::unloaded;
  pairs[0].result->machine_p = 0.4, pairs[1].result->machine_p = 1e-6, pairs[1].result->at_targets = 2e-4;
  const Fleet fleet = studyFleet(all, pairs);
  ASSERT_EQ(fleet.steps.size(), 1u);
  EXPECT_EQ(fleet.steps[0].what, FleetStep::What::geometry);
  EXPECT_EQ(fleet.campaigns[fleet.steps[0].campaign].date, "2026-01-12");
  EXPECT_DOUBLE_EQ(fleet.steps[0].p_holm, 2e-6);
}

}  // namespace fleet_test
}  // namespace stiffscope::fleet
