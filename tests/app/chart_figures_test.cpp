// What charts draw and their captions say, where a reader was misled once.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "app/figures/accuracy_figures.h"
#include "app/figures/drawn.h"
#include "app/figures/figures.h"
#include "core/accuracy/diagnose_accuracy.h"
#include "core/campaign/read_campaign.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace chart_figures_test {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A sweep of axis 4 from -360 to 360 degrees by 144: six readings at five places of a circle of 1 m.
TEST(ChartFigures, ASweepThatGoesRoundTwiceIsNoStar) {
  SmallResult small;
  frames::MeasuredAxis& axis = small.identification.frames.axes[3];
  axis.measured = true;
  axis.targets = {0};
  axis.fit.circles = {{1.0, 0.0, 2.0 * std::numbers::pi, 0.0}};
  axis.fit.axis.line.point = Eigen::Vector3d::Zero();
  axis.fit.axis.line.direction = Eigen::Vector3d::UnitZ();
  campaign::CircleSweeps sweeps{"circle_sweeps.csv", campaign::PointFrame::base_link, {}};
  frames::RigidPoints points;
  for (int i = 0; i < 6; ++i) {
    const double angle = (-360.0 + 144.0 * i) * std::numbers::pi / 180.0, radius = i % 2 == 0 ? 1.00001 : 0.99999;
    campaign::CircleReading reading{};
    reading.axis = 3;
    reading.target = 0;
    reading.q = JointVector::Zero(6);
    reading.q[3] = angle;
    reading.point = {radius * std::cos(angle), radius * std::sin(angle), 0.0};
    sweeps.rows.push_back(reading);
    points.circle_sweeps.push_back(reading.point);
  }
  small.campaign.circle_sweeps = std::move(sweeps);
  const auto chart = app::sweepCircles({small.campaign, small.identification}, points);
  ASSERT_TRUE(chart.has_value());
  ASSERT_EQ(chart->shapes.size(), 1u);
  ASSERT_EQ(chart->shapes[0].series.size(), 2u);  // the ring and the readings
  const render::PointSeries& readings = chart->shapes[0].series[1];
  ASSERT_EQ(readings.points.size(), 6u);
  ASSERT_FALSE(readings.line.empty());
  ASSERT_EQ(readings.values.size(), 6u);
  EXPECT_EQ(chart->shapes[0].value_name, "Radial residual (µm)");
  for (const render::PointValue& value : readings.values) EXPECT_NEAR(std::abs(value.value), 10.0, 1e-6);
  double ring = 0.0, length = 0.0;
  for (const render::PlotPoint& point : chart->shapes[0].series[0].points) ring = std::hypot(point.x, point.y);
  // The line keeps to its ring, and goes round it once: from each of its points the next is near.
  for (std::size_t i = 0; i < readings.line.size(); ++i) {
    const double radius = std::hypot(readings.line[i].x, readings.line[i].y);
    EXPECT_NEAR(radius, ring, 0.5 * ring);
    if (i == 0) continue;
    const double step =
        std::hypot(readings.line[i].x - readings.line[i - 1].x, readings.line[i].y - readings.line[i - 1].y);
    EXPECT_LT(step, 0.6 * ring) << i;  // two readings at one angle lie across the ring at most
    length += step;
  }
  EXPECT_LT(length, 3.0 * std::numbers::pi * ring);  // one turn, not the sweep's two
}

/// The sample without a load: its geometry leaves nearly as much as the nominal one.
struct Unloaded {
  campaign::Campaign campaign = campaign::readCampaign(STIFFSCOPE_SOURCE_DIR "/samples/unloaded").campaign;
  identification::Identification identification = identification::framesAlone(campaign);
  accuracy::AccuracyDiagnosis accuracy = accuracy::diagnoseAccuracy(campaign);
  reports::ReportCampaign one{campaign, identification, nullptr, nullptr, nullptr, nullptr, nullptr, &accuracy};
};

const Unloaded& unloaded() {
  static const Unloaded one;
  return one;
}

double largestX(const render::PointPanel& panel) {
  double largest = 0.0;
  for (const render::PointSeries& series : panel.series) {
    for (const render::PlotPoint& point : series.points) largest = std::max(largest, point.x);
  }
  return largest;
}

TEST(ChartFigures, APanelThatIsCalledEnlargedIs) {
  const render::PointChart chart = app::accuracyCurves(unloaded().one);
  ASSERT_EQ(chart.diagrams.size(), 2u);
  EXPECT_EQ(chart.diagrams[1].title, "With effects, enlarged");
  EXPECT_LT(largestX(chart.diagrams[1]), 0.5 * largestX(chart.diagrams[0]));
}

TEST(ChartFigures, WhatEffectsLeaveOverTheDayIsSeenBesideWhatTheGeometryLeaves) {
  const render::PointChart chart = app::residualsOverDay(unloaded().one);
  ASSERT_EQ(chart.diagrams.size(), 6u);
  EXPECT_EQ(chart.columns, 2);
  const auto largestY = [](const render::PointPanel& panel) {
    double largest = 0.0;
    for (const render::PointSeries& series : panel.series) {
      for (const render::PlotPoint& point : series.points) largest = std::max(largest, std::abs(point.y));
    }
    return largest;
  };
  for (std::size_t i = 0; i < 6; i += 2) {
    EXPECT_TRUE(has(chart.diagrams[i + 1].title, chart.diagrams[i].title)) << i;
    EXPECT_TRUE(has(chart.diagrams[i + 1].title, "with effects")) << i;
    EXPECT_LT(largestY(chart.diagrams[i + 1]), 0.5 * largestY(chart.diagrams[i])) << i;
  }
}

TEST(ChartFigures, CurvesAndMapsSayTheirValues) {
  for (const render::PointPanel& panel : app::accuracyCurves(unloaded().one).diagrams) {
    for (const render::PointSeries& curve : panel.series) {
      ASSERT_EQ(curve.values.size(), curve.points.size());
      EXPECT_EQ(curve.values.back().value, curve.points.back().y);
      EXPECT_EQ(curve.values.back().at, curve.points.back().x);
    }
  }
  double largest = 0.0;  // of the nominal model, whose maps come first
  for (const render::PointSeries& series : app::accuracyMap(unloaded().one).shapes.front().series) {
    for (const render::PointValue& value : series.values) {
      largest = std::max(largest, value.value);
    }
  }
  EXPECT_NEAR(largest, largestX(app::accuracyCurves(unloaded().one).diagrams[0]), 1e-9);
}

/// What `invert(.905) hue-rotate(180deg) brightness(1.35)` of the page in the dark makes of a colour (W3C, Filter
/// Effects), each step cut to 0..255.
render::Colour inTheDark(render::Colour colour) {
  const auto cut = [](const Eigen::Vector3d& rgb) { return Eigen::Vector3d(rgb.cwiseMax(0.0).cwiseMin(255.0)); };
  Eigen::Matrix3d half_turn;
  half_turn << -0.574, 1.43, 0.144, 0.426, 0.43, 0.144, 0.426, 1.43, -0.856;
  const Eigen::Vector3d rgb(colour.red, colour.green, colour.blue);
  const Eigen::Vector3d seen = cut(1.35 * cut(half_turn * cut(Eigen::Vector3d::Constant(0.905 * 255.0) - 0.81 * rgb)));
  return {static_cast<std::uint8_t>(seen[0]), static_cast<std::uint8_t>(seen[1]), static_cast<std::uint8_t>(seen[2])};
}

/// CIE L*a*b* (D65).
Eigen::Vector3d lab(render::Colour colour) {
  const auto linear = [](double c) {
    return c / 255.0 <= 0.04045 ? c / 255.0 / 12.92 : std::pow((c / 255.0 + 0.055) / 1.055, 2.4);
  };
  Eigen::Matrix3d xyz_from_rgb;
  xyz_from_rgb << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Eigen::Vector3d rgb(linear(colour.red), linear(colour.green), linear(colour.blue));
  const Eigen::Vector3d f =
      (xyz_from_rgb * rgb).cwiseQuotient(Eigen::Vector3d(0.9505, 1.0, 1.089)).unaryExpr([](double t) {
        return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
      });
  return {116.0 * f.y() - 16.0, 500.0 * (f.x() - f.y()), 200.0 * (f.y() - f.z())};
}

TEST(ChartFigures, ColoursOfTheMapAreToldApartInTheDarkToo) {
  const render::PointChart chart = app::accuracyMap(unloaded().one);
  std::vector<render::PointSeries> named;
  for (const render::PointSeries& series : chart.shapes.front().series) {
    if (!series.name.empty()) named.push_back(series);
  }
  ASSERT_GE(named.size(), 5u);  // classes of errors and base_link
  for (std::size_t i = 0; i < named.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const std::string which = named[i].name + " and " + named[k].name;
      // Ten times what is just seen side by side.
      EXPECT_GT((lab(named[i].colour) - lab(named[k].colour)).norm(), 23.0) << which;
      EXPECT_GT((lab(inTheDark(named[i].colour)) - lab(inTheDark(named[k].colour))).norm(), 23.0) << which;
    }
  }
}

TEST(ChartFigures, InOneLegendNoTwoThingsLookAlike) {
  const campaign::Campaign campaign = campaign::readCampaign(STIFFSCOPE_SOURCE_DIR "/samples/active").campaign;
  const SmallResult small;
  const auto chart = app::stationDrift({campaign, small.identification}, app::stationMotionOf(campaign));
  ASSERT_TRUE(chart.has_value());
  ASSERT_EQ(chart->diagrams.size(), 3u);
  using Look = std::array<int, 4>;
  std::vector<std::vector<std::pair<Look, std::string>>> legends(1);
  for (const render::PointPanel& panel : chart->diagrams) {
    for (const render::PointSeries& series : panel.series)
      legends.back().push_back(
          {{series.colour.red, series.colour.green, series.colour.blue, static_cast<int>(series.mark)}, series.name});
    if (chart->legend_a_panel) legends.emplace_back();
  }
  for (const auto& legend : legends) {
    for (const auto& [look, name] : legend) {
      for (const auto& [other_look, other] : legend) {
        if (look == other_look) EXPECT_EQ(name, other);
      }
    }
  }
  // And the legends are drawn: three signs more of ink than without.
  render::PointChart unnamed = *chart;
  for (render::PointPanel& panel : unnamed.diagrams) {
    for (render::PointSeries& series : panel.series) series.name.clear();
  }
  EXPECT_NE(render::render(*chart, {960, 560, false, 1.25}).rgb, render::render(unnamed, {960, 560, false, 1.25}).rgb);
}

/// All effects testable from one size on, and a verdict of two that the postures would part.
diagnosis::Diagnosis alike() {
  diagnosis::Diagnosis diagnosis(6);
  diagnosis.usable = true;
  diagnosis.verdict.entries = {{{effects::Effect::bearing_tilt, effects::Effect::base_compliance}, ""}};
  for (std::size_t e = 0; e < effects::kEffectCount; ++e)
    diagnosis.detectable.push_back({static_cast<effects::Effect>(e), 3.7e-6});
  diagnosis.size_limit = 3.7e-6;
  return diagnosis;
}

TEST(ChartFigures, EffectsOfOneSizeAndTwoThatAreNamedAsOneAreSaid) {
  const SmallResult small;
  diagnosis::Diagnosis diagnosis = alike();
  const reports::ReportCampaign one{small.campaign, small.identification, nullptr, nullptr, nullptr, &diagnosis};
  const std::string caption = app::describeEffectClasses(one).caption;
  EXPECT_TRUE(has(caption, "these readings do not part bearing tilt or base compliance")) << caption;
  EXPECT_FALSE(has(caption, "named alone")) << caption;
  EXPECT_TRUE(has(caption, "All would have been seen from one size on, 3.7\u00a0µm")) << caption;

  diagnosis.aliases = {{effects::Effect::joint_hardening, effects::Effect::backlash}};
  EXPECT_FALSE(has(app::describeEffectClasses(one).caption, "The others are told apart"));
  diagnosis.aliases.clear();
  diagnosis.verdict.entries = {{{effects::Effect::bearing_tilt}, ""}};
  diagnosis.detectable[0].size = 5e-6;
  const std::string differ = app::describeEffectClasses(one).caption;
  EXPECT_TRUE(has(differ, "No two effects look alike here")) << differ;
  EXPECT_TRUE(has(differ, "An effect smaller than its dot would have passed unseen")) << differ;
}

/// Candidates that the table calls one are not told apart, whatever the verdict names.
TEST(ChartFigures, CandidatesThatAreNotPartedAreSaid) {
  using calibration::UnloadedEffect;
  const SmallResult small;
  accuracy::AccuracyDiagnosis accuracy;
  accuracy.usable = true;
  accuracy.verdict = {{{UnloadedEffect::transmission_error}, "joint 2"}, {{}, ""}};
  accuracy.detectable = {{UnloadedEffect::joint_compliance, 2e-6}, {UnloadedEffect::base_compliance, 2e-6}};
  accuracy::AccuracyClass wave, candidate;
  wave.effects = {UnloadedEffect::transmission_error};
  candidate.effects = {UnloadedEffect::joint_compliance, UnloadedEffect::base_compliance};
  accuracy.classes = {wave, candidate};
  reports::ReportCampaign one{small.campaign, small.identification};
  one.accuracy = &accuracy;
  const std::string caption = app::describeEffectClasses(one).caption;
  EXPECT_TRUE(has(caption, "these readings do not part joint compliance or base compliance")) << caption;
  EXPECT_FALSE(has(caption, "named alone")) << caption;
}

TEST(ChartFigures, TheTitleOfTheAxisOfSizesIsNotCut) {
  const SmallResult small;
  diagnosis::Diagnosis diagnosis = alike();
  diagnosis.aliases = {{effects::Effect::joint_hardening, effects::Effect::backlash}};
  auto chart = app::effectClasses({small.campaign, small.identification, nullptr, nullptr, nullptr, &diagnosis});
  ASSERT_TRUE(chart.has_value());
  const render::Size size{960, 560, false, 1.25};
  const render::Image whole = render::render(*chart, size);
  chart->x_title += " xxxxxxxxxxxxxxxx";  // of a title that is cut anyway nothing more would be seen
  EXPECT_NE(render::render(*chart, size).rgb, whole.rgb);
}

TEST(ChartFigures, ThePaperIsNamedWhereTheReportStandsBesideIt) {
  const SmallResult small;
  const reports::ReportCampaign one{small.campaign, small.identification};
  for (const auto& figure : {app::describeResidualBars(one), app::describeResidualZoom(one)})
    EXPECT_FALSE(has(figure.caption, "paper")) << figure.caption;
  EXPECT_TRUE(has(app::describeResidualBars(one).caption, "Bars: how far it moves in each posture"));
  EXPECT_TRUE(has(app::describeResidualBars(one, true).caption, "the paper's Fig. 7"));
  EXPECT_TRUE(has(app::describeResidualZoom(one, true).caption, "the paper's Fig. 8"));
}

TEST(ChartFigures, NumbersBesideNamesWithCommasArePartedBySemicolons) {
  const SmallResult small;
  const reports::ReportCampaign one{small.campaign, small.identification};
  render::PointChart chart = *app::residualDirections(one);
  chart.diagrams[1].title = "Across it, level";
  const std::string caption = app::describeResidualDirections(one, chart).caption;
  EXPECT_TRUE(has(caption, "; across it, level ")) << caption;
}

}  // namespace chart_figures_test
}  // namespace stiffscope
