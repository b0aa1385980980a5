#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "app/figures/chart_style.h"
#include "app/figures/path_figures.h"
#include "core/io/units.h"
#include "core/preparation/subsample.h"
#include "render/ticks.h"
#include "reports/words/numbers.h"
#include "reports/words/rich_text.h"

namespace stiffscope::app {

namespace {

constexpr render::Colour kBefore = render::colours::kCp, kAfter = render::colours::kPp;
constexpr std::size_t kMostPoses = 2000;  // more are less than a pixel apart

std::vector<const toolpath::CompensatedPathPose*> drawnPoses(const toolpath::CompensatedPath& path) {
  std::vector<const toolpath::CompensatedPathPose*> poses;
  for (const std::size_t i : preparation::evenlySpreadIndices(path.poses.size(), kMostPoses))
    poses.push_back(&path.poses[i]);
  return poses;
}

bool anyPredicted(const toolpath::CompensatedPath& path) {
  return std::any_of(path.poses.begin(), path.poses.end(), [](const auto& pose) { return pose.compensated.predicted; });
}

/// A line through poses; NaN breaks it.
render::PointSeries pathLine(const std::string& name, render::Colour colour) {
  render::PointSeries series;
  series.name = name;
  series.colour = colour;
  series.mark = render::PointMark::none;
  series.joined = true;
  return series;
}

std::string poseCount(const campaign::Campaign& campaign, const toolpath::CompensatedPath& path) {
  const compensation::CompensationSummary summary = compensation::summaryOf(path.postures());
  return fmt::format("{}; {} of {} poses compensated", reports::asIs(campaign.name), summary.compensated,
                     summary.asked);
}

/// The two axes of the workpiece along which the path extends most, in their order.
std::array<Eigen::Index, 2> planeOf(const toolpath::CompensatedPath& path) {
  Eigen::Vector3d low = path.poses.front().tip_in_workpiece, high = low;
  for (const toolpath::CompensatedPathPose& pose : path.poses) {
    low = low.cwiseMin(pose.tip_in_workpiece);
    high = high.cwiseMax(pose.tip_in_workpiece);
  }
  Eigen::Index least = 0;
  (high - low).minCoeff(&least);
  // Of a straight path the plane's second axis would be chance: z is left out first.
  if ((high - low)[2] <= (high - low)[least] + 1e-9) least = 2;
  return {least == 0 ? 1 : 0, least == 2 ? 1 : 2};
}

double extentOf(const toolpath::CompensatedPath& path, const std::array<Eigen::Index, 2>& plane) {
  double largest = 0.0;
  for (const Eigen::Index axis : plane) {
    const auto [low, high] = std::minmax_element(
        path.poses.begin(), path.poses.end(),
        [&](const auto& a, const auto& b) { return a.tip_in_workpiece[axis] < b.tip_in_workpiece[axis]; });
    largest = std::max(largest, high->tip_in_workpiece[axis] - low->tip_in_workpiece[axis]);
  }
  return largest;
}

}  // namespace

std::optional<render::PointChart> pathShapes(const campaign::Campaign& campaign,
                                             const toolpath::CompensatedPath& path) {
  if (!anyPredicted(path)) return std::nullopt;
  const std::array<Eigen::Index, 2> plane = planeOf(path);
  const double extent = extentOf(path, plane);
  double deviation = 0.0;
  for (const toolpath::CompensatedPathPose& pose : path.poses)
    deviation = std::max(deviation, pose.deflection.shift.norm());
  constexpr double kShare = 0.12;  // of the path's extent, drawn
  const double wanted = deviation > 0.0 && extent > 0.0 ? kShare * extent / deviation : 1.0;
  const double magnified = std::max(1.0, render::roundDown125(wanted));

  const auto drawn = [&](const Eigen::Vector3d& point) {
    return render::PlotPoint{point[plane[0]] / io::kMillimetre, point[plane[1]] / io::kMillimetre};
  };
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Constant(NAN);
  render::PointSeries asked = pathLine("path as asked for", render::colours::kInk);
  render::PointSeries before = pathLine("under the process load", kBefore);
  std::array<render::PointSeries, 2> band{pathLine("with compensation at most there (U, 95 %)", kAfter),
                                          pathLine("with compensation at most there (U, 95 %)", kAfter)};
  const std::vector<const toolpath::CompensatedPathPose*> poses = drawnPoses(path);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const toolpath::CompensatedPathPose& pose = *poses[i];
    asked.points.push_back(drawn(pose.tip_in_workpiece));
    before.points.push_back(drawn(pose.compensated.predicted
                                      ? Eigen::Vector3d(pose.tip_in_workpiece + magnified * pose.deflection.shift)
                                      : nowhere));
    const Eigen::Vector3d along =
        poses[std::min(i + 1, poses.size() - 1)]->tip_in_workpiece - poses[i > 0 ? i - 1 : 0]->tip_in_workpiece;
    Eigen::Vector3d aside = Eigen::Vector3d::Zero();
    aside[plane[0]] = -along[plane[1]];
    aside[plane[1]] = along[plane[0]];
    if (aside.norm() > 0.0) aside.normalize();
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
      const double way = (side == 0 ? 1.0 : -1.0) * magnified * pose.compensated.tcp.expanded;
      band[side].points.push_back(
          drawn(pose.compensated.solved ? Eigen::Vector3d(pose.tip_in_workpiece + way * aside) : nowhere));
    }
  }

  render::PointChart chart;
  chart.title = "Path of the tool's tip without and with compensation";
  constexpr const char* kAxisNames = "xyz";
  chart.subtitle = fmt::format("{}; {} to the right, {} up; deviations \u00d7 {}", poseCount(campaign, path),
                               kAxisNames[plane[0]], kAxisNames[plane[1]], render::shortNumber(magnified));
  chart.columns = 2;
  const double bar_mm = render::roundUp125(0.1 * extent / io::kMillimetre);
  for (const bool compensated : {false, true}) {
    render::ShapePanel panel;
    panel.title = compensated ? "With compensation" : "Without compensation";
    panel.scale_bar = bar_mm;
    panel.scale_name = fmt::format("{} mm", render::shortNumber(bar_mm));
    panel.series = compensated ? std::vector<render::PointSeries>{band[0], band[1], asked}
                               : std::vector<render::PointSeries>{asked, before};
    chart.shapes.push_back(std::move(panel));
  }
  return chart;
}

std::optional<render::PointChart> pathDeviations(const campaign::Campaign& campaign,
                                                 const toolpath::CompensatedPath& path) {
  if (!anyPredicted(path)) return std::nullopt;
  render::PointSeries before = pathLine("without compensation", kBefore);
  render::PointSeries after = pathLine("with it at most (U, 95 %)", kAfter);
  std::array<render::PointSeries, 3> components;
  constexpr const char* kAxisNames = "xyz";
  for (std::size_t k = 0; k < 3; ++k)
    components[k] = pathLine(std::string(1, kAxisNames[k]), render::colours::kSeries[k]);
  for (const toolpath::CompensatedPathPose* pose : drawnPoses(path)) {
    const double at = pose->along / io::kMillimetre;
    const bool predicted = pose->compensated.predicted;
    before.points.push_back({at, predicted ? pose->deflection.shift.norm() / io::kMillimetre : NAN});
    after.points.push_back({at, pose->compensated.solved ? pose->compensated.tcp.expanded / io::kMillimetre : NAN});
    for (std::size_t k = 0; k < 3; ++k)
      components[k].points.push_back(
          {at, predicted ? pose->deflection.shift[static_cast<Eigen::Index>(k)] / io::kMillimetre : NAN});
  }
  render::PointChart chart;
  chart.title = "Deviation of the tool's tip by the process load";
  chart.subtitle = poseCount(campaign, path);
  chart.columns = 2;
  render::PointPanel sizes, parts;
  sizes.title = "Size";
  parts.title = "Without compensation, along the workpiece's axes";
  sizes.y_title = parts.y_title = "Deviation (mm)";
  sizes.x_title = parts.x_title = "Length along the path (mm)";
  render::PointSeries zero;  // holds the axis, drawing nothing
  zero.mark = render::PointMark::none;
  zero.points = {{0.0, 0.0}};
  sizes.series = {zero, before, after};
  parts.series = {components[0], components[1], components[2]};
  chart.diagrams = {sizes, parts};
  return chart;
}

std::optional<render::Image> pathPicture(const campaign::Campaign& campaign, const toolpath::CompensatedPath& path) {
  const auto shapes = pathShapes(campaign, path), deviations = pathDeviations(campaign, path);
  if (!shapes || !deviations) return std::nullopt;
  constexpr render::Size kShapes{1200, 620}, kDeviations{1200, 480};
  render::Image picture = render::render(*shapes, kShapes);
  const render::Image below = render::render(*deviations, kDeviations);
  picture.rgb.insert(picture.rgb.end(), below.rgb.begin(), below.rgb.end());
  picture.height += below.height;
  return picture;
}

}  // namespace stiffscope::app
