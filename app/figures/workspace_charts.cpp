#include "app/figures/figures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/figures/arm_scenes.h"
#include "app/figures/chart_style.h"
#include "core/io/units.h"
#include "core/robot/kinematics.h"
#include "render/ticks.h"
#include "reports/page/html.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/workspace_words.h"

namespace stiffscope::app {

namespace {

using workspace::WorkspaceStiffness;

/// Softest to stiffest; L* of 38 to 74, and apart to the colour-blind.
constexpr std::array<render::Colour, 4> kStiffnessColours{
    {{150, 20, 40}, {213, 80, 0}, {214, 170, 40}, {28, 120, 170}}};

/// The plane's own two coordinates of a compliance: outward and up.
Eigen::Matrix2d inPlane(const Eigen::Matrix3d& compliance, const Eigen::Vector3d& outward) {
  Eigen::Matrix<double, 3, 2> axes;
  axes << outward, Eigen::Vector3d::UnitZ();
  return axes.transpose() * compliance * axes;
}

double softestIn(const Eigen::Matrix2d& compliance) {
  const double mean = 0.5 * compliance.trace(), half = 0.5 * (compliance(0, 0) - compliance(1, 1));
  return mean + std::hypot(half, compliance(0, 1));
}

/// What forces of one size in all directions of the plane move the point by: C d over unit d.
void addEllipse(const Eigen::Matrix2d& compliance, const render::PlotPoint& centre, double scale,
                std::vector<render::PlotPoint>& points) {
  constexpr int kCorners = 36;
  for (int i = 0; i <= kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    const Eigen::Vector2d move = scale * compliance * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    points.push_back({centre.x + move.x(), centre.y + move.y()});
  }
  points.push_back({std::numeric_limits<double>::quiet_NaN(), 0.0});  // breaks the line
}

render::PointSeries outline(std::string name, render::Colour colour) {
  render::PointSeries series;
  series.name = std::move(name);
  series.colour = colour;
  series.mark = render::PointMark::none;
  series.joined = true;
  return series;
}

/// Moves all points so that the middle of what they cover is the picture's, which is about (0, 0).
void centreInPicture(std::vector<render::PointSeries>& series) {
  Eigen::AlignedBox2d box;
  for (const render::PointSeries& one : series) {
    for (const render::PlotPoint& point : one.points)
      if (std::isfinite(point.x)) box.extend(Eigen::Vector2d(point.x, point.y));
  }
  if (box.isEmpty()) return;
  const Eigen::Vector2d middle = box.center();
  for (render::PointSeries& one : series) {
    for (render::PlotPoint& point : one.points) point = {point.x - middle.x(), point.y - middle.y()};
  }
}

/// Three bounds between four classes of equal number.
std::array<double, 3> classBounds(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::array<double, 3> bounds{};
  for (std::size_t k = 0; k < 3; ++k) bounds[k] = values[(k + 1) * values.size() / 4];
  return bounds;
}

std::string classWords(const std::array<double, 3>& bounds, std::size_t k, const reports::LinearStiffnessUnit& unit) {
  const auto number = [](double value) { return reports::significant(value, 2); };
  if (k == 0) return fmt::format("below {} {}", number(bounds[0]), unit.name);
  if (k == 3) return fmt::format("from {} {}", number(bounds[2]), unit.name);
  return fmt::format("{} to {} {}", number(bounds[k - 1]), number(bounds[k]), unit.name);
}

/// The places that are drawn: of many every second, third.. each way, so that an outline is as large as can be read.
struct DrawnPlaces {
  std::vector<const workspace::SlicePlace*> places;
  double apart = 0.0;  ///< m
};

DrawnPlaces drawnPlaces(const workspace::StiffnessSlice& slice) {
  constexpr std::size_t kMost = 64;  // half a centimetre each on paper
  for (int every = 1;; ++every) {
    // Of the grids so far apart the one with most places.
    DrawnPlaces best;
    for (int phase = 0; phase < every * every; ++phase) {
      DrawnPlaces own{{}, every * slice.spacing};
      for (const workspace::SlicePlace& one : slice.places) {
        const long across = std::lround(one.radius / slice.spacing), up = std::lround(one.height / slice.spacing);
        if ((across - phase % every) % every == 0 && (up - phase / every) % every == 0) own.places.push_back(&one);
      }
      if (phase == 0 || own.places.size() > best.places.size()) best = std::move(own);
    }
    if (best.places.size() <= kMost) return best;
  }
}

/// How large compliances are drawn, metres of the plane by m/N: outlines do not touch, but where a few are more than
/// twice as large as most, which would leave these too small to read.
double outlineScale(const workspace::StiffnessSlice& slice, double apart) {
  std::vector<double> sizes;
  for (const workspace::SlicePlace& one : slice.places)
    sizes.push_back(softestIn(inPlane(one.at.model, slice.outward)));
  std::sort(sizes.begin(), sizes.end());
  if (sizes.empty() || !(sizes.back() > 0.0)) return 0.0;
  const double median = sizes[sizes.size() / 2], largest = sizes.back();
  return 0.48 * apart / (median > 0.0 ? std::min(largest, 2.0 * median) : largest);
}

}  // namespace

render::PointChart stiffnessSliceChart(const campaign::Campaign& campaign, const frames::Frames& frames,
                                       const WorkspaceStiffness& found) {
  const workspace::StiffnessSlice& slice = found.slice;
  const reports::LinearStiffnessUnit unit = reports::stiffnessUnit(found);
  render::PointChart chart;
  chart.title = "Compliance of P_{TCP} in a vertical plane through axis 1";
  chart.subtitle =
      fmt::format("{}; tool turned as in posture {}; {} from x_{{0}}", reports::asIs(campaign.name),
                  reports::asIs(slice.pose), fmt::format("{}°", reports::fixed(slice.azimuth / io::kDegree, 1)));
  render::ShapePanel panel;
  std::vector<double> stiffness;
  for (const workspace::SlicePlace& one : slice.places) {
    const double softest = softestIn(inPlane(one.at.model, slice.outward));
    if (softest > 0.0) stiffness.push_back(1.0 / (unit.size * softest));
  }
  const DrawnPlaces drawn = drawnPlaces(slice);
  const double scale = outlineScale(slice, drawn.apart);
  render::PointSeries springs = outline("by joint springs alone (K_{x})", render::colours::kNone);
  render::PointSeries centres = outline("", render::colours::kNone);  // nothing to see: what a pointer reads there
  centres.joined = false;
  std::vector<render::PointSeries> classes;
  const std::array<double, 3> bounds = stiffness.empty() ? std::array<double, 3>{} : classBounds(stiffness);
  for (std::size_t k = 0; k < kStiffnessColours.size(); ++k)
    classes.push_back(outline("softest " + classWords(bounds, k, unit), kStiffnessColours[k]));
  for (const workspace::SlicePlace* one : drawn.places) {
    const Eigen::Matrix2d model = inPlane(one->at.model, slice.outward);
    const double softest = softestIn(model);
    const render::PlotPoint centre{one->radius, one->height};
    if (!found.held.empty()) addEllipse(inPlane(one->at.springs, slice.outward), centre, scale, springs.points);
    const double own = softest > 0.0 ? 1.0 / (unit.size * softest) : 0.0;
    const auto k =
        static_cast<std::size_t>(std::count_if(bounds.begin(), bounds.end(), [&](double b) { return own >= b; }));
    addEllipse(model, centre, scale, classes[k].points);
    if (!(own > 0.0)) continue;
    centres.points.push_back(centre);
    centres.values.push_back({own});
  }
  // The arm in the slice's posture, seen at right angles to the plane.
  const render::ArmPose pose = bareArm(frames, robot::postureAt(frames.arm.arm, slice.q));
  render::PointSeries arm = outline("the arm in that posture", render::colours::kAxis);
  arm.mark = render::PointMark::disc;
  const double height = heightOfR0(frames);
  for (const Eigen::Vector3d& point : pose.joint_points)
    arm.points.push_back({point.dot(slice.outward), point.z() - height});
  panel.series.push_back(std::move(arm));
  panel.series.push_back(std::move(centres));
  panel.value_name = fmt::format("Softest in the plane ({})", unit.name);
  if (!springs.points.empty()) panel.series.push_back(std::move(springs));
  for (render::PointSeries& one : classes) {
    if (!one.points.empty()) panel.series.push_back(std::move(one));
  }
  centreInPicture(panel.series);
  panel.scale_bar = drawn.apart;
  const double move = scale > 0.0 ? drawn.apart / scale * 1000.0 : 0.0;  // by 1 kN, m
  // Of a soft arm a kilonewton is too much: the same by a tenth of it.
  const std::string words = unit.size < 1e6 ? fmt::format("{} by 100 N", reports::shownLength(0.1 * move, 3))
                                            : fmt::format("{} by 1 kN", reports::shownLength(move, 3));
  panel.scale_name =
      fmt::format("{} mm; as a move of P_{{TCP}}: {}", reports::fixed(drawn.apart / io::kMillimetre, 0), words);
  chart.shapes.push_back(std::move(panel));
  chart.note =
      "Each outline is where P_{TCP} moves under a force of one size in all directions of the plane. Places are within "
      "the joint limits; collisions are not looked at.";
  return chart;
}

render::PointChart stiffnessSliceChart(const reports::ReportCampaign& one) {
  return stiffnessSliceChart(one.campaign, one.identification.frames, *one.workspace);
}

reports::Figure describeStiffnessSlice(const reports::ReportCampaign& one) {
  const WorkspaceStiffness& found = *one.workspace;
  const reports::LinearStiffnessUnit unit = reports::stiffnessUnit(found);
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const workspace::SlicePlace& place : found.slice.places) {
    const double softest = softestIn(inPlane(place.at.model, found.slice.outward));
    if (softest <= 0.0) continue;
    least = std::min(least, 1.0 / (unit.size * softest));
    most = std::max(most, 1.0 / (unit.size * softest));
  }
  reports::Figure figure;
  figure.id = "stiffness-slice";
  figure.title = "Compliance of P_{TCP} over a slice of the workspace";
  figure.caption = fmt::format(
      "Large outlines give much. In its softest direction of the plane P_{{TCP}} is between {} and {}\u00a0{} stiff "
      "over these {} places.",
      reports::significant(least, 2), reports::significant(most, 2), unit.name, found.slice.places.size());
  figure.caption += drawnWords(found.slice.places.size(), drawnPlaces(found.slice).places.size(), "places");
  if (!found.held.empty())
    figure.caption += " Grey outlines are of the joint springs alone: what lies outside them is what else gives.";
  // What joint 1 moves is at right angles to the plane.
  std::vector<std::string> rigid;
  for (const int joint : found.unknown)
    if (joint > 0) rigid.push_back(reports::jointName(joint));
  if (!rigid.empty()) figure.caption += fmt::format(" Not known, and counted as rigid: {}.", fmt::join(rigid, ", "));
  figure.alt = "Outlines of the compliance on a grid of places in a vertical plane, with the arm.";
  return figure;
}

render::IntervalChart postureStiffnessChart(const reports::ReportCampaign& one) {
  const WorkspaceStiffness& found = *one.workspace;
  render::IntervalChart chart;
  chart.title = "Principal stiffnesses of P_{TCP} by posture";
  chart.subtitle = fmt::format("{}; whiskers: 95\u00a0% interval", reports::asIs(one.campaign.name));
  const reports::LinearStiffnessUnit unit = reports::stiffnessUnit(found);
  chart.y_title = fmt::format("Stiffness ({})", unit.name);
  chart.category_title = "Posture";
  chart.logarithmic = true;
  constexpr std::size_t kMostPostures = 30;
  const std::size_t drawn = std::min(found.postures.size(), kMostPostures);
  std::size_t most = 0;
  for (std::size_t i = 0; i < drawn; ++i) {
    chart.categories.push_back(reports::asIs(found.postures[i].pose));
    most = std::max(most, found.postures[i].of_model.size());
  }
  if (drawn < found.postures.size())
    chart.subtitle += fmt::format("; the first {} of {} postures", drawn, found.postures.size());
  const auto nameOf = [&](std::size_t k) { return k == 0 ? "softest" : k + 1 == most ? "stiffest" : "between"; };
  for (std::size_t k = 0; k < most; ++k) {
    render::IntervalSeries series{nameOf(k), render::colours::kSeries[k], {}};
    for (std::size_t i = 0; i < drawn; ++i) {
      const auto& principals = found.postures[i].of_model;
      if (k >= principals.size() || !(principals[k].compliance > 0.0)) {
        series.intervals.emplace_back();
        continue;
      }
      const identification::CoverageInterval interval = principals[k].stiffnessInterval();
      const double value = principals[k].stiffness() / unit.size;
      const double high = std::isfinite(interval.high) ? interval.high / unit.size : value;
      series.intervals.push_back({value, interval.low / unit.size, high, !std::isfinite(interval.high)});
      if (series.intervals.back().doubtful) chart.doubtful_name = "interval open above";
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

reports::Figure describePostureStiffness(const reports::ReportCampaign& one) {
  const WorkspaceStiffness& found = *one.workspace;
  reports::Figure figure;
  figure.id = "posture-stiffness";
  figure.title = "Principal stiffnesses of P_{TCP} by posture";
  const reports::LinearStiffnessUnit unit = reports::stiffnessUnit(found);
  const workspace::PointStiffness* softest = nullptr;
  for (const workspace::PointStiffness& place : found.postures) {
    if (place.of_model.empty()) continue;
    if (softest == nullptr || place.of_model.front().compliance > softest->of_model.front().compliance)
      softest = &place;
  }
  figure.caption =
      softest == nullptr
          ? std::string("No direction of P_{TCP} is free of joints of unknown stiffness.")
          : fmt::format("Softest is posture {}: {}\u00a0{} in its softest direction.", reports::asIs(softest->pose),
                        reports::significant(softest->of_model.front().stiffness() / unit.size, 3), unit.name);
  figure.alt = "Points with whiskers by posture: the softest and the stiffest direction on a logarithmic axis.";
  return figure;
}

}  // namespace stiffscope::app
