#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "core/fleet/fleet.h"
#include "reports/csv/fleet_csv.h"
#include "reports/json/fleet_json.h"
#include "reports/page/pages.h"
#include "tests/core/fleet/made_days.h"

namespace stiffscope::reports {
namespace fleet_results_test {

using fleet::CampaignResult;

CampaignResult fullDay() {
  CampaignResult day = fleet::dayOf({0.1, 1.0 / 3.0}, 100.0 / 7.0);
  day.name = "a \"day\"", day.date = "2026-01-05", day.robot = "arm", day.encoders = campaign::DoubleEncoder::active;
  day.audit = preparation::AuditVerdict::fail, day.failed_checks = {"tare"}, day.warned_checks = {"drift_nests"};
  day.own_weight = day.springs[1], day.own_weight.compliance[1] = 100.0 / 9.0;
  day.stiffness[1] = {1e6 / 3.0, 2e5, std::numeric_limits<double>::infinity()};
  day.stiffness[2] = {2e6, 1e6, 3e6};
  day.deflection = 1e-3 / 3.0, day.compensated = {0.9, 0.8, 0.95};
  day.gap_before = 1e-5, day.diagnosed = true;
  day.axes = {{{0.1, 1.0 / 3.0, 0.0}, {0.0, 0.6, 0.8}}, {{0.0, 0.0, 1.0 / 7.0}, {1.0, 0.0, 0.0}}};
  day.effects = {{{"bearing_tilt", "link_compliance"}, "joint 2"}, {{"unknown"}, ""}};
  return day;
}

// What is kept of a campaign comes back to the last digit, what is open and what is not known with it.
TEST(FleetResults, AreKeptWhole) {
  const CampaignResult day = fullDay();
  const std::string bytes = keptJson(day).dump();
  const CampaignResult back = keptCampaign(Json::parse(bytes));
  EXPECT_EQ(keptJson(back).dump(), bytes);
  EXPECT_EQ(back.stiffness[1].value, 1e6 / 3.0);
  EXPECT_EQ(back.stiffness[1].high, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(back.stiffness[0].high));
  EXPECT_TRUE(std::isnan(back.gap_after));
  EXPECT_EQ(back.springs[1].influences[1], day.springs[1].influences[1]);
  EXPECT_EQ(back.loaded_postures[1].q, day.loaded_postures[1].q);
  EXPECT_EQ(back.own_weight.influences[1], day.own_weight.influences[1]);
  EXPECT_FALSE(keptCampaign(Json::parse(keptJson(CampaignResult(6)).dump())).own_weight.available);
  ASSERT_EQ(back.axes.size(), day.axes.size());
  EXPECT_EQ(back.axes[0].point, day.axes[0].point);
  EXPECT_EQ(back.axes[1].direction, day.axes[1].direction);
  EXPECT_EQ(back.audit, day.audit);
  EXPECT_TRUE(back.hasUnknown());
}

TEST(FleetResults, WhatIsNoResultIsRefused) {
  Json json = keptJson(fullDay());
  json["audit"] = "good";
  EXPECT_THROW(keptCampaign(json), std::runtime_error);
  json = keptJson(fullDay());
  while (json["axes"].size() <= static_cast<std::size_t>(kMostJoints)) json["axes"].push_back(json["axes"][0]);
  EXPECT_THROW(keptCampaign(json), std::runtime_error);
}

fleet::Fleet smallFleet() {
  std::mt19937_64 draws(3);
  std::vector<fleet::FleetCampaign> campaigns;
  for (CampaignResult& day : fleet::unchangedDays(draws, 6, 12)) {
    fleet::FleetCampaign one;
    one.machine = "A, <1>", one.date = "2026-01-0" + std::to_string(campaigns.size() + 1), one.folder = one.date;
    if (campaigns.size() >= 3) day.springs[1].compliance[1] += 20.0;
    one.result = day, one.report = "reports/" + one.date + "/report.html";
    campaigns.push_back(one);
  }
  campaigns[1].result.reset(), campaigns[1].failure = "states.csv:3: q1_deg: 'x': expected a number";
  std::vector<fleet::FleetPair> pairs = fleet::pairsOf(fleet::seriesOf(campaigns));
  fleet::compareLoaded(campaigns, pairs);
  return fleet::studyFleet(campaigns, pairs);
}

TEST(FleetResults, TablesAndPageSayWhatChangedAndWhatFailed) {
  const fleet::Fleet fleet = smallFleet();
  const std::string campaigns = fleetCsv(fleet), steps = stepsCsv(fleet), changes = changesCsv(fleet),
                    needs = needsCsv(fleet), lines = fleetJsonLines(fleet);
  EXPECT_EQ(std::count(campaigns.begin(), campaigns.end(), '\n'), 7);
  EXPECT_NE(campaigns.find("\"A, <1>\",2026-01-02,2026-01-02,states.csv:3: q1_deg: 'x': expected a number,"),
            std::string::npos)
      << campaigns;
  EXPECT_NE(steps.find("\"A, <1>\",2026-01-04,compliance,2,,0."), std::string::npos) << steps;
  EXPECT_EQ(std::count(changes.begin(), changes.end(), '\n'), 1 + 4);  // five days with a result, one joint
  EXPECT_NE(needs.find("1,\"A, <1>\",no_result,2026-01-02,"), std::string::npos) << needs;
  EXPECT_NE(needs.find(",changed,2026-01-04,\"joint 2 softer from 2026-01-04 on: compliance +"), std::string::npos)
      << needs;
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 6);
  EXPECT_EQ(Json::parse(lines.substr(0, lines.find('\n'))).at("machine"), "A, <1>");
  const std::string detectable = detectableCsv(fleet);
  EXPECT_EQ(std::count(detectable.begin(), detectable.end(), '\n'), 1 + 6);
  EXPECT_NE(detectable.find("\"A, <1>\",loaded,unspecified,1,5,yes,,,"), std::string::npos) << detectable;
  EXPECT_NE(detectable.find("\"A, <1>\",loaded,unspecified,2,5,yes,"), std::string::npos) << detectable;
  const std::string page = page::fleetPage(fleet, {}, "0123456789ab");
  EXPECT_NE(page.find("What a change has to be to be found"), std::string::npos);
  EXPECT_NE(page.find("A, &lt;1&gt;"), std::string::npos);
  EXPECT_NE(page.find("href=\"reports/2026-01-04/report.html\""), std::string::npos);
  EXPECT_NE(page.find("states.csv:3: q1_deg"), std::string::npos);
}

}  // namespace fleet_results_test
}  // namespace stiffscope::reports
