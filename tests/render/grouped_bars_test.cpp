#include "render/grouped_bar_chart.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/render/picture.h"

namespace stiffscope {
namespace grouped_bars_test {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Without names, so that no legend shows the colours too.
render::GroupedBarChart plainBars(std::vector<double> values) {
  render::GroupedBarChart chart;
  for (std::size_t i = 0; i < values.size(); ++i) chart.categories.push_back(std::to_string(i + 1));
  chart.series = {{"", render::colours::kPp, std::move(values), {}}};
  return chart;
}

render::GroupedBarChart figure7(int postures) {
  render::GroupedBarChart chart;
  chart.title = "Displacement of P_{wrist} before and after compensation";
  chart.subtitle = "Double encoders active";
  chart.y_title = "Displacement of P_{wrist} (mm)";
  chart.category_title = "Posture";
  chart.series = {{"none", render::colours::kNone, {}, {}},
                  {"Complete Pose", render::colours::kCp, {}, {}},
                  {"Partial Pose", render::colours::kPp, {}, {}},
                  {"Decoupled Partial Pose", render::colours::kDpp, {}, {}}};
  for (int i = 0; i < postures; ++i) {
    chart.categories.push_back(std::to_string(i + 1));
    const double displacement = 1 + 0.4 * std::sin(i);
    double share = 1;
    for (render::BarSeries& series : chart.series) {
      series.values.push_back(share * displacement);
      share -= 0.25;
    }
  }
  return chart;
}

TEST(GroupedBars, HeightFollowsValue) {
  const auto bars = piecesOf(maskOf(decoded(render::render(plainBars({1, 2}))), render::colours::kPp));
  ASSERT_EQ(bars.size(), 2u);
  // A pixel of each bar is shared with the zero line, another with its upper edge.
  EXPECT_NEAR(bars[1].height, 2 * bars[0].height, 3);
  EXPECT_NEAR(bars[0].br().y, bars[1].br().y, 1);
  EXPECT_GT(bars[0].height, 200);
}

TEST(GroupedBars, SeriesStandInTheirOrderInEachGroup) {
  render::GroupedBarChart chart = figure7(3);
  for (render::BarSeries& series : chart.series) series.name.clear();
  const cv::Mat picture = decoded(render::render(chart));
  std::vector<std::vector<cv::Rect>> bars;
  for (const render::BarSeries& series : chart.series) bars.push_back(piecesOf(maskOf(picture, series.colour)));
  for (std::size_t group = 0; group < 3; ++group) {
    for (std::size_t s = 0; s < 4; ++s) {
      ASSERT_EQ(bars[s].size(), 3u);
      if (s > 0) {
        EXPECT_GE(bars[s][group].x, bars[s - 1][group].br().x);
      }
    }
    if (group > 0) {
      EXPECT_GT(bars[0][group].x, bars[3][group - 1].br().x);
    }
  }
}

TEST(GroupedBars, MissingValueLeavesAGap) {
  const cv::Mat mask = maskOf(decoded(render::render(plainBars({1, kNaN, 1}))), render::colours::kPp);
  const auto bars = piecesOf(mask);
  ASSERT_EQ(bars.size(), 2u);
  const cv::Rect between(bars[0].br().x, 0, bars[1].x - bars[0].br().x, mask.rows);
  EXPECT_GT(between.width, 200);
  EXPECT_EQ(cv::countNonZero(mask(between)), 0);
}

TEST(GroupedBars, NegativeValueHangsFromTheZeroLine) {
  const auto bars = piecesOf(maskOf(decoded(render::render(plainBars({1, -1}))), render::colours::kPp));
  ASSERT_EQ(bars.size(), 2u);
  EXPECT_NEAR(bars[1].y, bars[0].br().y, 2);
  EXPECT_NEAR(bars[0].height, bars[1].height, 2);
}

TEST(GroupedBars, WhiskerIsAsLongAsItsError) {
  render::GroupedBarChart chart = plainBars({1, 2});
  chart.series[0].errors = {kNaN, 0.25};
  const cv::Mat picture = decoded(render::render(chart));
  const auto bars = piecesOf(maskOf(picture, render::colours::kPp), 1000);
  ASSERT_GE(bars.size(), 2u);
  const cv::Rect first = bars[0], second = bars[1];
  // Above the middle of the second bar there is ink for an eighth of its height; the first has no whisker.
  const auto inkAbove = [&picture](const cv::Rect& bar, int height) {
    const cv::Mat dark = picture(cv::Rect(bar.x + bar.width / 2 - 2, bar.y - height, 4, height)) < cv::Scalar::all(110);
    cv::Mat rows;
    std::vector<cv::Mat> channels;
    cv::split(dark, channels);
    cv::reduce(channels[0], rows, 1, cv::REDUCE_MAX);
    return cv::countNonZero(rows);
  };
  const double error = first.height * 0.25;
  EXPECT_NEAR(inkAbove(second, static_cast<int>(error) + 30), error, 3);
  EXPECT_EQ(inkAbove(first, 30), 0);
}

TEST(GroupedBars, NoClippingFromOneToSixtyPostures) {
  for (const int postures : {1, 2, 19, 60}) {
    for (const render::Size size : {render::Size{1200, 700}, render::Size{480, 320}, render::Size{2000, 900}}) {
      SCOPED_TRACE(testing::Message() << postures << " postures, " << size.width << " x " << size.height);
      const cv::Mat picture = decoded(render::render(figure7(postures), size));
      ASSERT_EQ(picture.size(), cv::Size(size.width, size.height));
      expectNothingClipped(picture);
    }
  }
}

TEST(GroupedBars, SixtyPosturesKeepAllBarsAndSpaceBetweenLabels) {
  render::GroupedBarChart chart = figure7(60);
  chart.category_title.clear();
  const cv::Mat picture = decoded(render::render(chart));
  const auto bars = piecesOf(maskOf(picture, render::colours::kPp), 60);
  ASSERT_EQ(bars.size(), 61u) << "with the square in the legend";
  // The row of labels below the plot, blurred over the space between digits, falls apart into labels.
  const int zero = bars.back().br().y;
  cv::Mat labels = inkOf(picture)(cv::Rect(0, zero + 4, picture.cols, picture.rows - zero - 4)).clone();
  cv::dilate(labels, labels, cv::getStructuringElement(cv::MORPH_RECT, {5, 15}));
  const auto words = piecesOf(labels);
  EXPECT_GE(words.size(), 12u);
  for (const cv::Rect& word : words) EXPECT_LT(word.width, 40);
}

TEST(GroupedBars, LongNamesStandUpright) {
  render::GroupedBarChart chart = plainBars(std::vector<double>(30, 1.0));
  for (std::string& name : chart.categories) name = "campaign of day " + name;
  const cv::Mat picture = decoded(render::render(chart));
  expectNothingClipped(picture);
  const int zero = piecesOf(maskOf(picture, render::colours::kPp)).front().br().y;
  const cv::Mat below = inkOf(picture).rowRange(zero + 4, picture.rows).clone();
  for (const cv::Rect& letter : piecesOf(below)) EXPECT_LT(letter.width, 20);
  EXPECT_GT(picture.rows - zero, 80);
}

TEST(GroupedBars, NothingFiniteStillDrawsAxes) {
  const cv::Mat picture = decoded(render::render(plainBars({kNaN, kNaN})));
  EXPECT_GT(cv::countNonZero(inkOf(picture)), 1000);
  expectNothingClipped(picture);
}

TEST(GroupedBars, RefusesInconsistentData) {
  render::GroupedBarChart chart = plainBars({1, 2});
  chart.series[0].name = "DPP";
  chart.series[0].values.pop_back();
  try {
    render::render(chart);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "bar chart '': series 'DPP' has 1 values and 0 errors for 2 categories");
  }
  EXPECT_THROW(render::render(render::GroupedBarChart{}), std::invalid_argument);
  EXPECT_THROW(render::render(plainBars({1}), {100, 100}), std::invalid_argument);
}

}  // namespace grouped_bars_test
}  // namespace stiffscope
