#include "render/point_chart.h"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "tests/render/picture.h"

namespace stiffscope {
namespace point_chart_test {

render::PointChart postures(int count, int panels) {
  render::PointChart chart;
  chart.title = "Residuals";
  chart.columns = 3;
  for (int p = 0; p < panels; ++p) {
    render::PointPanel panel;
    panel.title = "Along the beam";
    panel.x_title = "Posture";
    panel.y_title = "Residual (µm)";
    render::PointSeries series;
    series.name = "P_{10}";
    series.colour = render::colours::kSeries[0];
    for (int i = 0; i < count; ++i) {
      panel.categories.push_back(std::to_string(i + 1));
      series.points.push_back({static_cast<double>(i), std::sin(i)});
    }
    panel.series = {series};
    chart.diagrams.push_back(panel);
  }
  return chart;
}

TEST(PointChart, NothingIsCutFromOneToSixtyPostures) {
  for (const int count : {1, 2, 19, 24, 60}) {
    SCOPED_TRACE(count);
    expectNothingClipped(decoded(render::render(postures(count, 6))));
  }
}

TEST(PointChart, LabelsUnderTheAxisStandApart) {
  // The strip of the labels: every label is a piece of ink; were two run together there would be fewer gaps.
  for (const int count : {19, 60}) {
    render::PointChart chart = postures(count, 1);
    chart.columns = 1;
    chart.diagrams[0].x_title.clear();
    chart.diagrams[0].title.clear();
    chart.title.clear();
    const cv::Mat ink = inkOf(decoded(render::render(chart)));
    const cv::Mat strip = ink.rowRange(ink.rows - 30, ink.rows - 8);
    int gap = 0, narrowest = ink.cols, begun = 0;
    for (int x = 80; x < ink.cols; ++x) {
      const bool any = cv::countNonZero(strip.col(x)) > 0;
      if (any && gap > 0 && begun > 0 && gap > 5) narrowest = std::min(narrowest, gap);  // up to 5: within a number
      gap = any ? 0 : gap + 1;
      begun += any ? 1 : 0;
    }
    EXPECT_GT(begun, 0);
    EXPECT_GE(narrowest, 7) << count;  // 8 pixels apart, less what a glyph overhangs
  }
}

TEST(PointChart, AShapeIsTrueToScale) {
  render::PointChart chart;
  render::ShapePanel panel;
  render::PointSeries ring;
  ring.colour = render::colours::kSeries[1];
  for (int i = 0; i < 4; ++i) ring.points.push_back({std::cos(i * M_PI / 2), std::sin(i * M_PI / 2)});
  panel.series = {ring};
  chart.shapes = {panel};
  const auto marks = piecesOf(maskOf(decoded(render::render(chart)), ring.colour));
  ASSERT_EQ(marks.size(), 4u);
  const int width = marks[3].x - marks[0].x;
  int top = 9999, bottom = 0;
  for (const cv::Rect& mark : marks) top = std::min(top, mark.y), bottom = std::max(bottom, mark.y);
  EXPECT_NEAR(width, bottom - top, 1);  // to a pixel
  EXPECT_GT(width, 300);
}

/// A shape has no axes, and a line no marks: they say what they are told to.
TEST(PointChart, PointsOfAShapeAndOfALineSayTheirValues) {
  render::PointSeries line;
  line.mark = render::PointMark::none;
  line.joined = true;
  line.points = {{0, 0}, {1, 2}};
  render::PointChart silent;
  silent.diagrams = {render::PointPanel{}};
  silent.diagrams[0].series = {line};
  EXPECT_TRUE(render::render(silent).marks.empty());
  line.values = {{0.0, 0.0, ""}, {2.0, 1.0, ""}};
  silent.diagrams[0].series = {line};
  EXPECT_EQ(render::render(silent).marks.size(), 2u);

  render::PointChart shape;
  shape.shapes = {render::ShapePanel{}};
  shape.shapes[0].title = "Axis 1";
  shape.shapes[0].value_name = "Residual (µm)";
  line.name = "P_{10}";
  line.values[1] = {7.5, 90.0, ""};
  shape.shapes[0].series = {line};
  const auto marks = render::render(shape).marks;
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_EQ(marks[1].series, "Axis 1: P_{10}");
  EXPECT_EQ(marks[1].quantity, "Residual (µm)");
  EXPECT_EQ(marks[1].value, 7.5);
  EXPECT_EQ(marks[1].category_at, 90.0);
  EXPECT_GT(marks[1].x, marks[0].x);
}

TEST(PointChart, AHostileTitleLeavesThePlotItsRoom) {
  render::PointChart plain = postures(19, 1), hostile = plain;
  plain.title = "Two lines of a title " + std::string(120, 'i');
  for (const std::string& name :
       {std::string(10'000, 'W'), std::string("<script>alert(\"1\")</script>\n\u202E\u05d0\u05d1"), [] {
          std::string words;
          while (words.size() < 10'000) words += "many words ";
          return words;
        }()}) {
    hostile.title = name;
    hostile.subtitle = name;
    const auto start = std::chrono::steady_clock::now();
    const cv::Mat picture = decoded(render::render(hostile));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_LT(seconds, 2.0);  // 0.1 s alone; measuring every prefix of such a name would take minutes
    expectNothingClipped(picture);
    // Two lines of each leave four fifths of the picture to the plot: its points are there.
    EXPECT_GE(piecesOf(maskOf(picture, render::colours::kSeries[0]), 8).size(), 15u);
  }
}

TEST(PointChart, RefusesWhatDoesNotFit) {
  EXPECT_THROW(render::render(render::PointChart{}), std::invalid_argument);
  render::PointChart chart = postures(3, 1);
  chart.diagrams[0].series[0].errors = {1.0};
  try {
    render::render(chart);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("1 errors for 3 points"), std::string::npos) << error.what();
  }
}

}  // namespace point_chart_test
}  // namespace stiffscope
