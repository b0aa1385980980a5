#include "render/spread_chart.h"

#include <stdexcept>
#include <string>

#include "tests/render/picture.h"

namespace stiffscope {
namespace spreads_test {

render::SpreadChart panels(std::vector<std::optional<render::Spread>> spreads) {
  render::SpreadChart chart;
  chart.methods = {{"", render::colours::kPp}};
  for (auto& spread : spreads) chart.panels.push_back({"k", {spread}, {}, {}, {}});
  chart.axis = render::SpreadAxis::shared;
  return chart;
}

std::vector<cv::Rect> outlines(const cv::Mat& picture) { return piecesOf(maskOf(picture, render::colours::kPp), 100); }

TEST(Spreads, BoxesAndWhiskersFollowThePercentiles) {
  const cv::Mat picture =
      decoded(render::render(panels({render::Spread{1, 2, 3, 4, 5, 3}, render::Spread{1, 1.5, 3, 4.5, 9, 3}})));
  const auto boxes = outlines(picture);
  ASSERT_EQ(boxes.size(), 2u);
  // Whole pieces run from the 5 % to the 95 % whisker.
  EXPECT_NEAR(boxes[1].height, 2 * boxes[0].height, 4);
  expectNothingClipped(picture);
}

TEST(Spreads, TailBeyondTheAxisIsCutWithAnArrow) {
  const render::Spread narrow{1, 2, 3, 4, 5, 3};
  render::Spread heavy = narrow;
  heavy.p95 = 500;
  heavy.mean = 2300;
  const auto calm = outlines(decoded(render::render(panels({narrow, narrow}))));
  const cv::Mat picture = decoded(render::render(panels({narrow, heavy})));
  const auto cut = outlines(picture);
  ASSERT_EQ(calm.size(), 2u);
  ASSERT_EQ(cut.size(), 2u);
  // The narrow box keeps a fair share of its height although its neighbour's mean is 2300.
  EXPECT_GT(cut[0].height, calm[0].height / 3);
  // The arrow: at the top of the heavy one the ink is pointed, and widens below the tip.
  const cv::Mat mask = maskOf(picture, render::colours::kPp);
  EXPECT_LT(cv::countNonZero(mask.row(cut[1].y)(cv::Range::all(), cv::Range(cut[1].x, cut[1].br().x))), 4);
  EXPECT_GT(cv::countNonZero(mask.row(cut[1].y + 8)(cv::Range::all(), cv::Range(cut[1].x, cut[1].br().x))), 6);
  // The mean is printed above it.
  const cv::Rect above(cut[1].x - 40, cut[1].y - 22, cut[1].width + 80, 18);
  EXPECT_GT(cv::countNonZero(inkOf(picture)(above)), 60);
  expectNothingClipped(picture);
}

TEST(Spreads, ReferenceIsADashedLine) {
  render::SpreadChart chart = panels({render::Spread{1, 2, 3, 4, 5, 3}});
  chart.panels[0].references = {4.6};
  const cv::Mat mask = maskOf(decoded(render::render(chart)), render::colours::kInk);
  int most = 0;
  for (int y = 120; y < mask.rows - 80; ++y) {
    std::vector<cv::Rect> dashes = piecesOf(mask.row(y), 3);
    most = std::max(most, static_cast<int>(dashes.size()));
  }
  EXPECT_GT(most, 20);
}

TEST(Spreads, MissingSpreadLeavesAGap) {
  const cv::Mat picture = decoded(render::render(panels({std::nullopt, render::Spread{1, 2, 3, 4, 5, 3}})));
  const auto boxes = outlines(picture);
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_GT(boxes[0].x, picture.cols / 2);
}

TEST(Spreads, ManyPanelsAndConstantValuesAreNotClipped) {
  for (const std::size_t count : {1, 6, 12, 20}) {
    render::SpreadChart chart =
        panels(std::vector<std::optional<render::Spread>>(count, render::Spread{2, 2, 2, 2, 2, 2}));
    chart.axis = render::SpreadAxis::own_per_panel;
    expectNothingClipped(decoded(render::render(chart)));
  }
}

TEST(Spreads, RefusesPercentilesOutOfOrder) {
  try {
    render::render(panels({render::Spread{1, 2, 3, 2.5, 5, 3}}));
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("percentiles 1 2 3 2.5 5"), std::string::npos) << error.what();
  }
  EXPECT_THROW(render::render(render::SpreadChart{}), std::invalid_argument);
}

}  // namespace spreads_test
}  // namespace stiffscope
