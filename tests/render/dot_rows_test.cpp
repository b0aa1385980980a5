#include <cmath>
#include <stdexcept>
#include <string>
#include "render/dot_row_chart.h"
#include "tests/render/picture.h"

namespace stiffscope {
namespace dot_rows_test {

render::DotRowChart threeRows() {
  render::DotRowChart chart;
  chart.x_title = "Size (µm)";
  chart.rows = {{"a", 1.0, "", false}, {"b", 10.0, "", false}, {"c", 100.0, "", false}};
  return chart;
}

/// The dots, from left to right; their stems are thinner than they are.
std::vector<cv::Rect> dots(const render::DotRowChart& chart, render::Colour colour) {
  cv::Mat mask = maskOf(decoded(render::render(chart)), colour);
  cv::erode(mask, mask, cv::Mat::ones(5, 5, CV_8U));
  return piecesOf(mask, 10);
}

TEST(DotRows, DecadesAreEvenlySpacedAndRowsStandInOrder) {
  const auto found = dots(threeRows(), render::colours::kSeries[0]);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_NEAR(found[1].x - found[0].x, found[2].x - found[1].x, 2);  // a pixel of rounding at each end
  EXPECT_GT(found[1].x - found[0].x, 100);
  EXPECT_GT(found[1].y, found[0].y + 50);
  EXPECT_GT(found[2].y, found[1].y + 50);
}

TEST(DotRows, AMarkedRowHasAnotherSignAndOneWithoutSizeNone) {
  render::DotRowChart chart = threeRows();
  chart.rows[1].marked = true;
  chart.rows[2].size = NAN;
  chart.rows[2].words = "not testable";
  EXPECT_EQ(dots(chart, render::colours::kSeries[0]).size(), 1u);
  EXPECT_EQ(dots(chart, render::colours::kSeries[1]).size(), 1u);
  expectNothingClipped(decoded(render::render(chart)));
}

TEST(DotRows, AGroupIsALineBesideItsRows) {
  render::DotRowChart chart = threeRows();
  chart.group_title = "alike";
  const auto inkOfColumn = [&chart] {
    cv::Mat mask = maskOf(decoded(render::render(chart)), render::colours::kInk);
    cv::erode(mask, mask, cv::Mat::ones(60, 2, CV_8U));  // upright lines alone
    return cv::countNonZero(mask);
  };
  EXPECT_EQ(inkOfColumn(), 0);
  chart.groups = {{0, 2}};
  EXPECT_GT(inkOfColumn(), 0);
}

TEST(DotRows, FitsWhateverItIsGiven) {
  render::DotRowChart chart;
  chart.title = std::string(300, 'm');
  chart.group_title = "not told apart";
  chart.reference = 3.0;
  chart.reference_name = "limit";
  for (int i = 0; i < 16; ++i)
    chart.rows.push_back({std::string(80, 'w'), i % 3 ? std::pow(10.0, i % 5) : NAN, std::string(400, 'x'), i == 4});
  for (std::size_t i = 0; i < 20; ++i) chart.groups.push_back({i % 16, (i + 5) % 16});
  expectNothingClipped(decoded(render::render(chart)));
  expectNothingClipped(decoded(render::render(chart, {480, 320})));
}

TEST(DotRows, RefusesAGroupOfARowThatThereIsNot) {
  render::DotRowChart chart = threeRows();
  chart.groups = {{0, 7}};
  try {
    render::render(chart);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("a group of rows 0, 7, expected two or more of 3"), std::string::npos)
        << error.what();
  }
}

TEST(RichText, WhatStandsBetweenEscapesIsTakenToTheLetter) {
  // A subscript is set smaller: read to the letter the same name is wider, and the stems begin farther to the
  // right.
  const auto stemsBeginAt = [](const std::string& name) {
    render::DotRowChart chart = threeRows();
    chart.rows[0].name = name;
    return piecesOf(maskOf(decoded(render::render(chart)), render::colours::kSeries[0]), 100).front().x;
  };
  const int marked = stemsBeginAt("P_{xxxxxx}"), verbatim = stemsBeginAt("\x1bP_{xxxxxx}\x1b");
  EXPECT_GT(verbatim, marked + 20);
  EXPECT_NEAR(stemsBeginAt("P\x1b_{xxxxxx}\x1b"), verbatim, 1);  // other runs, another rounding
  EXPECT_EQ(stemsBeginAt("Pxxxxxx"), stemsBeginAt("\x1bPxxxxxx\x1b"));
  EXPECT_EQ(stemsBeginAt("P_{xxxxxx}\x1b"), marked);
}

}  // namespace dot_rows_test
}  // namespace stiffscope
