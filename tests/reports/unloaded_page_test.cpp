// The page of days without a load, and of days of sweeps alone.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <regex>
#include "core/accuracy/diagnose_accuracy.h"
#include "core/calibration/remarks.h"
#include "reports/json/json.h"
#include "reports/page/pages.h"
#include "reports/words/accuracy_words.h"
#include "reports/words/day_words.h"
#include "reports/words/numbers.h"
#include "reports/words/verdict.h"
#include "tests/fixtures/unloaded_day.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace unloaded_page_test {

/// A day whose joint 2 has a wave once a turn, of 0.5 mrad.
struct Day {
  campaign::Campaign campaign;
  identification::Identification identification;
  accuracy::AccuracyDiagnosis accuracy;
  preparation::Preparation preparation;

  explicit Day(double wave = 0.5e-3) {
    Noise noise(51);
    UnloadedSpec spec = builtOtherwise(noise);
    spec.postures = 120;
    spec.joint_errors = [wave](const JointVector& q) {
      JointVector errors = JointVector::Zero(6);
      errors[4] = wave * std::sin(2.0 * q[4]);
      return errors;
    };
    campaign = unloadedCampaign(spec, noise);
    identification = identification::framesAlone(campaign);
    accuracy = accuracy::diagnoseAccuracy(campaign);
    preparation.raw = true;
  }

  reports::ReportContent content() const {
    reports::ReportContent content;
    content.campaigns.push_back(
        {campaign, identification, nullptr, &preparation, nullptr, nullptr, nullptr, &accuracy, {}});
    content.title = reports::reportTitle(content.campaigns);
    content.verdict = reports::verdictOf(content.campaigns, content.avoided);
    return content;
  }
};

bool has(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

/// Sections in their order; each has something beside its heading.
std::vector<std::string> sectionsOf(const std::string& page) {
  std::vector<std::string> ids;
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(page.c_str(), page.size()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  const auto* main = document.RootElement()->FirstChildElement("body")->FirstChildElement("main");
  for (const auto* section = main->FirstChildElement("section"); section != nullptr;
       section = section->NextSiblingElement("section")) {
    ids.emplace_back(section->Attribute("id"));
    tinyxml2::XMLPrinter printed;
    section->Accept(&printed);
    const std::string inside = printed.CStr();
    const bool filled = has(inside, "<p") || has(inside, "<td") || has(inside, "<li") || has(inside, "<figure");
    EXPECT_TRUE(filled) << ids.back() << " is empty";
  }
  return ids;
}

TEST(UnloadedPage, HasATitleAndAnOrderOfItsOwn) {
  const Day day;
  const reports::ReportContent content = day.content();
  EXPECT_EQ(content.title, "Absolute accuracy");
  const std::string page = page::reportPage(content);
  EXPECT_EQ(sectionsOf(page), (std::vector<std::string>{"conditions", "accuracy", "parameters", "station",
                                                        "accuracy-gap", "next", "scope", "provenance"}));
  const std::string opening = page.substr(0, page.find("<main"));
  EXPECT_FALSE(has(opening, "tiffness"));
  EXPECT_TRUE(has(opening, "transmission error (joint 5)"));
  EXPECT_TRUE(has(opening, "rms position error, nominal (URDF), held out"));
  EXPECT_FALSE(has(page, ">nan"));
  EXPECT_FALSE(has(page, "not available"));
}

/// Links of steel that warm by eight degrees and cool again.
TEST(UnloadedPage, SaysOfWhichTemperatureTheAxesWithGrowthAre) {
  Day day;
  EXPECT_FALSE(has(page::reportPage(day.content()), "Growth is counted from"));
  Noise noise(52);
  UnloadedSpec spec = builtOtherwise(noise);
  spec.postures = 80;
  const auto warmer = [](int posture) { return 4.0 - 4.0 * std::cos(posture / 79.0 * 3.0 * std::numbers::pi); };
  spec.temperature_c = [warmer](int posture) { return 20.0 + warmer(posture); };
  spec.arm_at = [warmer](ChainArm arm, int posture) {
    for (std::size_t j = 1; j < arm.to_joint.size(); ++j)
      arm.to_joint[j].translation() *= 1.0 + 12e-6 * warmer(posture);
    return arm;
  };
  day.campaign = unloadedCampaign(spec, noise);
  day.identification = identification::framesAlone(day.campaign);
  day.accuracy = accuracy::diagnoseAccuracy(day.campaign);
  double mean = 20.0;
  for (int i = 0; i < spec.postures; ++i) mean += warmer(i) / spec.postures;
  EXPECT_TRUE(has(page::reportPage(day.content()),
                  fmt::format("Growth is counted from {:.1f} degrees C, the mean over the day", mean)));
}

TEST(UnloadedPage, TablesAreFilesOfTheirNames) {
  const page::ReportPage page = page::makeReportPage(Day().content());
  std::vector<std::string> names;
  for (const reports::TableFile& table : page.tables) names.push_back(table.name);
  for (const char* name : {"accuracy", "worst-postures", "calibrated-axes", "denavit-hartenberg", "places", "effects"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
}

/// What stands behind ± is U, and the link parameters have the digits that it gives them.
TEST(UnloadedPage, WhatIsReadBehindPlusMinusIsU) {
  const Day day;
  const page::ReportPage page = page::makeReportPage(day.content());
  EXPECT_FALSE(has(page.html, "standard uncertainty u"));
  const calibration::ArmFit& fit = day.accuracy.calibration.geometry().fit;
  constexpr int kShift = 4;  // of axis 2, along u
  ASSERT_GT(fit.sd(kShift), 0.0);
  EXPECT_TRUE(has(page.html,
                  "<td>" + reports::withUncertainty(1e3 * fit.steps[kShift], 1.96 * 1e3 * fit.sd(kShift)) + "</td>"));
  const robot::Robot& nominal = day.accuracy.calibration.day.arm;
  const double a = calibration::denavitHartenberg(fit.arm(nominal), nominal).links[0].a,
               sd = calibration::linkUncertainties(fit, nominal)[0].a;
  ASSERT_GT(sd, 0.0);
  EXPECT_TRUE(has(page.html, "<td>" + reports::withUncertainty(1e3 * a, 1.96 * 1e3 * sd) + " <small>"));
}

/// A choice of frame has no uncertainty: the calibration holds axis 1, so that nothing moves the first d.
TEST(UnloadedPage, AFixedLinkParameterHasNoUncertainty) {
  const Day day;
  const page::ReportPage page = page::makeReportPage(day.content());
  const robot::Robot& nominal = day.accuracy.calibration.day.arm;
  const double d = calibration::denavitHartenberg(nominal, nominal).links[0].d;
  EXPECT_TRUE(has(page.html, "<td>" + reports::fixed(1e3 * d, 3) + " <small>"));
  EXPECT_FALSE(has(page.html, "± 0.0000000"));
  const auto table = std::find_if(page.tables.begin(), page.tables.end(),
                                  [](const reports::TableFile& one) { return one.name == "denavit-hartenberg"; });
  ASSERT_NE(table, page.tables.end());
  // Nor in the file: of urdf_beta, sd_theta, sd_d, sd_a, sd_alpha, sd_beta two are there.
  EXPECT_TRUE(std::regex_search(table->csv, std::regex("\n1,2,[^\n]*,,,[0-9.e-]+,[0-9.e-]+,\\r?\n"))) << table->csv;
}

TEST(UnloadedPage, ACleanDayNamesNothing) {
  const Day day(0.0);
  const reports::ReportContent content = day.content();
  EXPECT_TRUE(has(content.verdict, "What the calibrated geometry leaves is noise, or too small to matter."));
  const std::string page = page::reportPage(content);
  sectionsOf(page);
  EXPECT_FALSE(has(page, "Effects beside the geometry"));
  EXPECT_TRUE(has(page, "no effect predicts postures that were held out better"));
}

/// Whatever the diagnosis fills in is shown, and what it leaves empty is not.
TEST(UnloadedPage, ShowsClassesWhereTablesAndWhatIsNotTestable) {
  using calibration::UnloadedEffect;
  Day day;
  day.accuracy.verdict = {{{UnloadedEffect::tracker_drift, UnloadedEffect::thermal_growth}, ""}, {{}, ""}};
  accuracy::AccuracyClass one;
  one.effects = day.accuracy.verdict.front().effects;
  one.score = 31.0;
  one.shrink = {0.42, 0.35, 0.48};
  one.in_verdict = true;
  day.accuracy.classes = {one};
  day.accuracy.where = {{"joint", {{"joint 5", 20e-6, 5e-6, 0.8, 6.0}}, false, 0.0}};
  day.accuracy.detectable = {{UnloadedEffect::backlash, 3e-6}};
  day.accuracy.not_testable = {{UnloadedEffect::target_motion, Remark(calibration::RemarkId::no_masses)}};
  day.accuracy.next = {Remark(calibration::RemarkId::no_unloaded_readings)};
  const std::string page = page::reportPage(day.content());
  for (const char* words : {"tracker drift or thermal growth, and something that no known effect explains", "35 to 48",
                            "joint 5", "Not testable with this data:", "target motion: the URDF states no link masses",
                            "If it is tracker drift: let the tracker warm up",
                            "Look for what is not in the list of effects", "There are no unloaded postures"})
    EXPECT_TRUE(has(page, words)) << words;
  EXPECT_TRUE(has(page, "The smallest sizes as a table"));
}

/// Fourteen waves of one joint, one of them within its U: its table has the twelve largest, its file all.
TEST(UnloadedPage, TheFileOfTheEffectsHasAllOfThem) {
  Day day;
  calibration::ArmFit& fit = day.accuracy.calibration.models.back().fit;
  constexpr int kWaves = 14, kSizes = 2 * kWaves;
  fit.parts.clear();
  fit.free.clear();
  fit.refused.assign(kSizes, false);
  fit.sizes.resize(kSizes);
  constexpr double kSd = 1e-6;
  fit.covariance = kSd * kSd * Eigen::MatrixXd::Identity(kSizes, kSizes);
  for (int k = 0; k < kWaves; ++k) {
    fit.parts.push_back(calibration::transmissionError(0, 10.0 + k));
    fit.sizes[2 * k] = k == 3 ? 0.5 * kSd : 10.0 * (k + 1) * kSd;
    fit.sizes[2 * k + 1] = 0.0;
  }
  for (int k = 0; k < kSizes; ++k) fit.free.push_back(static_cast<int>(fit.steps.size()) + k);
  const page::ReportPage page = page::makeReportPage(day.content());
  const auto file = std::find_if(page.tables.begin(), page.tables.end(),
                                 [](const reports::TableFile& one) { return one.name == "effects"; });
  ASSERT_NE(file, page.tables.end());
  for (int k = 0; k < kWaves; ++k)
    EXPECT_TRUE(has(file->csv, "joint 1, order " + std::to_string(10 + k) + ")")) << file->csv;
  const std::string section = page.html.substr(page.html.find("Effects beside the geometry in the order"));
  EXPECT_LT(section.find("order 23"), section.find("order 22"));
  EXPECT_FALSE(has(section, "order 10)"));
  EXPECT_FALSE(has(section, "order 13)"));
  EXPECT_TRUE(has(section, "And 2 more, smaller or within their U; all of them in the table's CSV file"));
}

TEST(UnloadedPage, ADayThatCannotBeCalibratedSaysWhy) {
  Day day;
  day.campaign.loading->rows.resize(3);
  day.accuracy = accuracy::diagnoseAccuracy(day.campaign);
  const reports::ReportContent content = day.content();
  EXPECT_TRUE(has(content.verdict, "The day could not be calibrated: 3 readings do not determine"));
  const std::vector<std::string> sections = sectionsOf(page::reportPage(content));
  EXPECT_EQ(std::count(sections.begin(), sections.end(), "accuracy"), 0);
}

TEST(UnloadedPage, ResultsHaveTheCalibration) {
  const Day day;
  const reports::ReportContent content = day.content();
  const reports::JsonDocument results = reports::resultsJson(content);
  const reports::Json& campaign = results.json["campaigns"][0];
  ASSERT_TRUE(campaign.contains("calibration"));
  EXPECT_EQ(campaign["diagnosis"]["verdict"][0][0], "transmission_error");
  EXPECT_EQ(campaign["calibration"]["folds"], 2);
  EXPECT_EQ(campaign["calibration"]["models"].back()["effects"][0], "transmission_error");
}

TEST(ReportTitle, IsOfTheKindsOfDays) {
  const Day day;
  const SmallResult loaded;
  campaign::Campaign swept;
  swept.circle_sweeps.emplace();
  const identification::Identification none;
  const reports::ReportCampaign unloaded_day = day.content().campaigns.front(),
                                loaded_day{loaded.campaign, loaded.identification}, swept_day{swept, none};
  EXPECT_EQ(reports::reportTitle({loaded_day}), "Joint stiffness");
  EXPECT_EQ(reports::reportTitle({swept_day}), "Geometry by circle sweeps");
  EXPECT_EQ(reports::reportTitle({loaded_day, unloaded_day}), "Absolute accuracy and joint stiffness");
  EXPECT_EQ(reports::reportTitle({swept_day, unloaded_day, loaded_day}),
            "Absolute accuracy, joint stiffness and geometry by circle sweeps");
}

/// Each section is about the days that have what it shows.
TEST(MixedPage, HasTheSectionsOfBothDays) {
  const Day day;
  const SmallResult loaded;
  reports::ReportContent content = day.content();
  content.campaigns.push_back({loaded.campaign, loaded.identification});
  const std::string page = page::reportPage(content);
  const std::vector<std::string> sections = sectionsOf(page);
  for (const char* id : {"accuracy", "next", "stiffness", "compensation"})
    EXPECT_EQ(std::count(sections.begin(), sections.end(), id), 1) << id;
  const std::size_t stiffness = page.find("<section id=\"stiffness\">");
  const std::string section = page.substr(stiffness, page.find("</section>", stiffness) - stiffness);
  EXPECT_TRUE(has(section, "<h3>small</h3>"));
  EXPECT_FALSE(has(section, "<h3>unloaded</h3>"));
}

}  // namespace unloaded_page_test
}  // namespace stiffscope
