// Of a long day pictures draw so many postures or readings that none hides another, and say so.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>
#include "app/figures/chart_style.h"
#include "app/figures/figures.h"
#include "app/figures/page_scene.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace long_day_figures_test {

constexpr std::size_t kPostures = 1000, kFarthest = 617;

/// The small result's postures over and over; one, which is not drawn, moves farther than all others.
struct LongDay {
  SmallResult small;

  LongDay() {
    identification::Identification& result = small.identification;
    for (std::size_t i = 3; i < kPostures; ++i) {
      const auto again = [i](auto& list) {
        auto once_more = list[i % 3];
        list.push_back(std::move(once_more));
      };
      small.campaign.pose_ids.push_back("p" + std::to_string(i));
      again(result.cases);
      result.cases.back().pose = static_cast<int>(i);
      again(result.wrist);
      again(result.wrist_displacement);
      again(result.target_displacement);
      for (identification::MethodResult& method : result.methods) {
        if (!method.available) continue;
        again(method.wrist_rows);
        again(method.target_rows);
        again(method.wrist_residual);
        again(method.target_residual);
      }
    }
    result.wrist_displacement[kFarthest] = 7.5e-3;
    for (identification::MethodResult& method : result.methods) {
      if (method.available) method.target_rows[kFarthest].right *= 9.0;
    }
  }

  reports::ReportCampaign report() const { return {small.campaign, small.identification}; }
};

TEST(LongDay, TheWordsOfWhatIsDrawn) {
  EXPECT_EQ(app::drawnWords(5, 5, "postures"), "");
  EXPECT_EQ(app::drawnWords(10'000, 200, "postures"), " Drawn: 200 of 10000 postures, spread evenly.");
}

TEST(LongDay, BarsOfTwoHundredPosturesAndTheLongestInWords) {
  const LongDay day;
  const render::GroupedBarChart chart = app::residualBars(day.report());
  ASSERT_EQ(chart.categories.size(), 200u);
  EXPECT_EQ(chart.categories[0], "A");
  EXPECT_EQ(chart.categories[1], "p5");
  ASSERT_EQ(chart.series.size(), 3u);
  for (const render::BarSeries& series : chart.series) EXPECT_EQ(series.values.size(), 200u);
  EXPECT_DOUBLE_EQ(chart.series[0].values[1], 2.0);  // the sixth posture, p5, is the third once more
  const std::string caption = app::describeResidualBars(day.report()).caption;
  EXPECT_NE(
      caption.find("Drawn: 200 of 1000 postures, spread evenly. The longest of all is 7.50\u00a0mm, in posture p617."),
      std::string::npos)
      << caption;
  const SmallResult three;
  EXPECT_EQ(app::describeResidualBars({three.campaign, three.identification}).caption.find("Drawn"), std::string::npos);
}

TEST(LongDay, ThePostureThatCaptionsNameIsInTheScene) {
  const LongDay day;  // p617 has the longest displacement and the longest residual; every seventeenth is in the scene
  EXPECT_EQ(app::namedPoses(day.report()), (std::set<int>{static_cast<int>(kFarthest)}));
}

TEST(LongDay, ResidualsOfAHundredPosturesAtTheirPlaces) {
  const LongDay day;
  const auto chart = app::residualDirections(day.report());
  ASSERT_TRUE(chart.has_value());
  for (const render::PointPanel& panel : chart->diagrams) {
    ASSERT_EQ(panel.categories.size(), 100u);
    EXPECT_EQ(panel.categories[2], "p20");
    ASSERT_EQ(panel.series.size(), 3u);
    for (const render::PointSeries& series : panel.series) {
      ASSERT_EQ(series.points.size(), 100u);
      for (std::size_t k = 0; k < 100; ++k) EXPECT_NEAR(series.points[k].x, static_cast<double>(k), 0.5);
    }
  }
  // p20 is the third posture once more, of 2 mm, of which DPP leaves a tenth, along z.
  EXPECT_NEAR(chart->diagrams[2].series[0].points[2].y, -200.0, 1e-9);
  const std::string caption = app::describeResidualDirections(day.report(), *chart).caption;
  // Of p617, the third once more, 9 times 2 mm less the 1.8 mm that DPP predicts.
  EXPECT_NE(caption.find("The longest residual of all is 16\u00a0mm, of P_{10} in posture p617."), std::string::npos)
      << caption;
}

TEST(LongDay, EachReflectorOfAWristSweepIsDrawnWhereTheyTakeTurns) {
  SmallResult small;
  frames::WristCentre& wrist = small.identification.frames.wrist;
  wrist.measured = true;
  wrist.radii = {1.0, 1.0, 1.0};
  campaign::WristSweep sweep{"wrist_sweep.csv", campaign::PointFrame::base_link, {}};
  frames::RigidPoints points;
  for (int i = 0; i < 30'000; ++i) {
    const double azimuth = 0.001 * i;
    sweep.rows.push_back({std::to_string(i / 3),
                          i % 3,
                          JointVector::Zero(6),
                          campaign::kNotGiven,
                          {std::cos(azimuth), std::sin(azimuth), 0.0},
                          campaign::kNoTime,
                          0});
    points.wrist_sweep.push_back(sweep.rows.back().point);
  }
  small.campaign.wrist_sweep = std::move(sweep);
  for (int target = 0; target < 3; ++target) {
    wrist.table.push_back({});
    wrist.table.back().target = target;
    wrist.table.back().readings = 10'000;
  }
  const reports::ReportCampaign report{small.campaign, small.identification};
  const auto chart = app::wristSphere(report, points);
  ASSERT_TRUE(chart.has_value());
  ASSERT_EQ(chart->diagrams[0].series.size(), 4u);  // three reflectors and the line of means
  for (std::size_t target = 0; target < 3; ++target) EXPECT_EQ(chart->diagrams[0].series[target].points.size(), 1000u);
  EXPECT_NE(app::describeWristSphere(report).caption.find(
                "Drawn: 1000 of 10000 readings of a reflector, spread evenly. The means are of all."),
            std::string::npos);
}

}  // namespace long_day_figures_test
}  // namespace stiffscope
