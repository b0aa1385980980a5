#include "app/view/sweep_material.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/figures/arm_pose.h"
#include "core/input/units.h"
#include "core/robot/kinematics.h"
#include "reports/page/html.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

/// The readings of one axis and one reflector, in the scene.
struct Circle {
  int axis = 0;
  int target = 0;
  std::vector<const CircleReading*> readings;
};

std::vector<Circle> circlesOf(const CircleSweeps& sweeps) {
  std::vector<Circle> circles;
  for (const CircleReading& reading : sweeps.rows) {
    auto found = std::find_if(circles.begin(), circles.end(), [&](const Circle& circle) {
      return circle.axis == reading.axis && circle.target == reading.target;
    });
    if (found == circles.end()) found = circles.insert(found, {reading.axis, reading.target, {}});
    found->readings.push_back(&reading);
  }
  return circles;
}

std::vector<SceneTrace> tracesOf(const Campaign& campaign, const std::vector<Circle>& circles, int axis,
                                 const Eigen::Isometry3d& scene_from_points) {
  std::vector<SceneTrace> traces;
  for (const Circle& circle : circles) {
    SceneTrace trace;
    trace.label = page::pointName(campaign.targets[static_cast<std::size_t>(circle.target)].id);
    trace.faint = circle.axis != axis;
    for (const CircleReading* reading : circle.readings)
      trace.points.push_back(scene_from_points * reading->point);
    traces.push_back(std::move(trace));
  }
  return traces;
}

std::string axisWords(const MeasuredAxis& axis) {
  if (!axis.measured) return "not measured: " + axis.reason;
  double arc = 0.0;
  for (const AxisCircle& circle : axis.fit.circles) arc = std::max(arc, circle.arc);
  return fmt::format("arc {}\u00b0, circles fitted to {}\u00a0\u00b5m rms", page::fixed(arc / kDegree, 0),
                     page::significant(1e6 * axis.fit.rms, 2));
}

}  // namespace

ViewMaterial sweepMaterial(const Campaign& campaign, const Frames& frames) {
  ViewMaterial material;
  material.campaign = campaign.name;
  if (!campaign.circle_sweeps) {
    material.lacking = "the campaign has neither loads nor circle sweeps to show";
    return material;
  }
  const auto r0_from_points = r0FromTable(frames, campaign.circle_sweeps->frame);
  if (!r0_from_points) {
    material.lacking =
        "the sweeps do not place R0 (axes 1 and 2 must be measured), so their readings cannot be shown on "
        "the arm";
    return material;
  }
  const Eigen::Isometry3d scene_from_points =
      Eigen::Translation3d(0.0, 0.0, heightOfR0(frames)) * *r0_from_points;
  const std::vector<Circle> circles = circlesOf(*campaign.circle_sweeps);
  for (int axis = 0; axis < 6; ++axis) {
    const auto of_axis = std::find_if(circles.begin(), circles.end(),
                                      [&](const Circle& circle) { return circle.axis == axis; });
    if (of_axis == circles.end()) continue;
    const CircleReading& middle = *of_axis->readings[of_axis->readings.size() / 2];
    ViewFrame frame;
    frame.scene.title = fmt::format("Circle sweep of axis {}", axis + 1);
    frame.scene.subtitle =
        fmt::format("{}; {}", page::asIs(campaign.name), axisWords(frames.axes[static_cast<std::size_t>(axis)]));
    frame.scene.poses = {bareArm(frames, postureAt(frames.arm.arm, middle.q))};
    frame.scene.traces = tracesOf(campaign, circles, axis, scene_from_points);
    frame.scene.trace_name = "tracker readings of this sweep, the others pale";
    frame.scene.frame_origin = {0.0, 0.0, heightOfR0(frames)};
    frame.name = fmt::format("axis-{}", axis + 1);
    frame.where = fmt::format("axis {}", axis + 1);
    frame.posture = axis;
    material.frames.push_back(std::move(frame));
  }
  return material;
}

}  // namespace stiffscope
