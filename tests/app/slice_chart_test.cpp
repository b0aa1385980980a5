// The compliance over a slice of the workspace: outlines as large as can be read, the scale said.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "app/figures/figures.h"
#include "reports/words/workspace_words.h"
#include "tests/reports/small_result.h"

namespace stiffscope {
namespace slice_chart_test {

constexpr double kSpacing = 0.2, kCompliance = 2e-6;  // m, m/N

/// Places of a square grid that give alike in all directions; the first `softer` times as much.
workspace::WorkspaceStiffness sliceOf(int across, double softer = 1.0) {
  workspace::WorkspaceStiffness found;
  found.slice.pose = "A";
  found.slice.q = JointVector::Zero(6);
  found.slice.spacing = kSpacing;
  for (int up = 0; up < across; ++up) {
    for (int out = 0; out < across; ++out) {
      workspace::SlicePlace place;
      place.radius = out * kSpacing, place.height = up * kSpacing;
      place.at.model = (up + out == 0 ? softer : 1.0) * kCompliance * Eigen::Matrix3d::Identity();
      found.slice.places.push_back(place);
    }
  }
  return found;
}

/// Widths of the outlines, m of the plane, in order of size.
std::vector<double> widthsOf(const render::ShapePanel& panel) {
  std::vector<double> widths;
  for (const render::PointSeries& series : panel.series) {
    if (series.mark != render::PointMark::none) continue;  // the arm
    Eigen::AlignedBox1d box;
    for (const render::PlotPoint& point : series.points) {
      if (std::isfinite(point.x)) {
        box.extend(Eigen::Matrix<double, 1, 1>(point.x));
      } else {
        widths.push_back(box.sizes()[0]);
        box.setEmpty();
      }
    }
  }
  std::sort(widths.begin(), widths.end());
  return widths;
}

render::ShapePanel panelOf(const workspace::WorkspaceStiffness& found) {
  const SmallResult small;
  return app::stiffnessSliceChart(small.campaign, small.identification.frames, found).shapes.front();
}

TEST(SliceChart, DrawsAllOfFewPlaces) {
  const render::ShapePanel panel = panelOf(sliceOf(8));
  const std::vector<double> widths = widthsOf(panel);
  EXPECT_EQ(widths.size(), 64u);
  EXPECT_DOUBLE_EQ(panel.scale_bar, kSpacing);
  EXPECT_NEAR(widths.back(), 0.96 * kSpacing, 1e-3 * kSpacing);  // they do not touch
}

TEST(SliceChart, OfManyPlacesDrawsFewerAndThoseLarger) {
  const render::ShapePanel panel = panelOf(sliceOf(13));
  const std::vector<double> widths = widthsOf(panel);
  EXPECT_EQ(widths.size(), 49u);  // every second each way, of 169
  EXPECT_DOUBLE_EQ(panel.scale_bar, 2.0 * kSpacing);
  EXPECT_NEAR(widths.back(), 0.96 * 2.0 * kSpacing, 1e-3 * kSpacing);
  // 2 mm/kN make half a width.
  EXPECT_EQ(panel.scale_name.rfind("400 mm; as a move of P_{TCP}: 4.17", 0), 0u) << panel.scale_name;
}

TEST(SliceChart, OneSoftPlaceDoesNotMakeTheOthersSmall) {
  const std::vector<double> widths = widthsOf(panelOf(sliceOf(8, 20.0)));
  EXPECT_NEAR(widths[widths.size() / 2], 0.48 * kSpacing, 1e-3 * kSpacing);
}

TEST(SliceChart, SaysTheStiffnessOfEachPlaceThatIsDrawn) {
  std::size_t said = 0;
  const render::ShapePanel panel = panelOf(sliceOf(8));
  for (const render::PointSeries& series : panel.series) {
    for (const render::PointValue& value : series.values) EXPECT_NEAR(value.value, 0.5, 1e-12);  // 1 / 2e-6 m/N
    said += series.values.size();
  }
  EXPECT_EQ(said, 64u);
  EXPECT_EQ(panel.value_name, "Softest in the plane (N/µm)");
}

TEST(SliceChart, NeedsAJointThatMovesThePointInThePlane) {
  workspace::WorkspaceStiffness found = sliceOf(2);
  EXPECT_TRUE(reports::givesInSlice(found.slice));
  for (workspace::SlicePlace& place : found.slice.places)
    place.at.model = Eigen::Vector3d(0, kCompliance, 0).asDiagonal();  // of joint 1 alone
  EXPECT_FALSE(reports::givesInSlice(found.slice));
}

}  // namespace slice_chart_test
}  // namespace stiffscope
