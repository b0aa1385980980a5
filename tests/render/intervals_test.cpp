#include "render/interval_chart.h"

#include <limits>
#include <stdexcept>
#include <string>

#include "tests/render/picture.h"

namespace stiffscope {
namespace intervals_test {

render::IntervalChart plain(std::vector<render::Interval> intervals) {
  render::IntervalChart chart;
  for (std::size_t i = 0; i < intervals.size(); ++i) chart.categories.push_back(std::to_string(i + 1));
  chart.series = {{"", render::colours::kDpp, std::move(intervals)}};
  return chart;
}

std::vector<cv::Rect> marks(const render::IntervalChart& chart) {
  return piecesOf(maskOf(decoded(render::render(chart)), render::colours::kDpp), 30);
}

double middle(const cv::Rect& mark) { return mark.y + mark.height / 2.0; }

TEST(Intervals, LogarithmicAxisSpacesDecadesEvenly) {
  render::IntervalChart chart = plain({{1, 1, 1}, {10, 10, 10}, {100, 100, 100}});
  chart.logarithmic = true;
  const auto points = marks(chart);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(middle(points[0]) - middle(points[1]), middle(points[1]) - middle(points[2]), 2);
  EXPECT_GT(middle(points[0]) - middle(points[1]), 100);
}

TEST(Intervals, WhiskerLengthFollowsTheInterval) {
  const auto points = marks(plain({{5, 4, 6}, {5, 3, 7}}));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR(points[1].height, 2 * points[0].height, 4);
}

TEST(Intervals, DoubtfulPointIsHollow) {
  const cv::Mat picture = decoded(render::render(plain({{5, 5, 5, false}, {5, 5, 5, true}})));
  const auto points = piecesOf(maskOf(picture, render::colours::kDpp), 20);
  ASSERT_EQ(points.size(), 2u);
  const auto colourInside = [&picture](const cv::Rect& r) {
    return picture.at<cv::Vec3b>(r.y + r.height / 2, r.x + r.width / 2);
  };
  EXPECT_EQ(colourInside(points[0]),
            cv::Vec3b(render::colours::kDpp.blue, render::colours::kDpp.green, render::colours::kDpp.red));
  EXPECT_EQ(colourInside(points[1]), cv::Vec3b(255, 255, 255));
}

TEST(Intervals, NotPositiveOnALogarithmicAxisIsAnArrowAtItsFoot) {
  render::IntervalChart chart = plain({{10, 8, 12}, {-3, -5, 9}, {5, -1, 20}});
  chart.logarithmic = true;
  const cv::Mat picture = decoded(render::render(chart));
  const auto points = piecesOf(maskOf(picture, render::colours::kDpp), 30);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(points[1].br().y, points[2].br().y, 1);
  EXPECT_GT(points[1].br().y, points[0].br().y + 20);
  expectNothingClipped(picture);
}

TEST(Intervals, MissingValueLeavesAGap) {
  EXPECT_EQ(marks(plain({{5, 4, 6}, {}, {5, 4, 6}})).size(), 2u);
  EXPECT_TRUE(marks(plain({{}, {}})).empty());
}

TEST(Intervals, RefusesAnIntervalWithoutItsValue) {
  try {
    render::render(plain({{5, 6, 7}}));
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("has 5 in an interval from 6 to 7"), std::string::npos) << error.what();
  }
}

// "At least 5" beside a fit of -4: what is possible does not hold what was found.
TEST(Intervals, ANegativeFitStandsBesideTheIntervalOfWhatIsPossible) {
  render::IntervalChart chart = plain({{10, 8, 12}, {-4, 5, std::numeric_limits<double>::infinity()}});
  chart.logarithmic = true;
  const auto points = marks(chart);
  ASSERT_GE(points.size(), 3u);
  int whiskers = 0, arrows = 0;
  for (const cv::Rect& one : points) {
    if (one.x < points.front().br().x + 50) continue;  // of the first
    if (one.y < points.front().y) ++whiskers;          // open above: to the edge of the diagram
    if (one.y > points.front().br().y + 20) ++arrows;
  }
  EXPECT_EQ(whiskers, 1);
  EXPECT_EQ(arrows, 1);
  chart.series[0].intervals[1] = {-4, 7, 6};
  EXPECT_THROW(render::render(chart), std::invalid_argument);
}

}  // namespace intervals_test
}  // namespace stiffscope
