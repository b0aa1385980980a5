#include "render/vtk/scene_stage.h"

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkRenderer.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "render/ticks.h"
#include "render/vtk/arm_shape.h"
#include "render/vtk/canvas.h"
#include "render/vtk/chart_frame.h"

// The panels beside a scene: words and numbers in columns.

// What stands at the points of a scene: the base frame's axes, labels, the ring around the picked one.

// The flat parts of the picture of an arm: what stands around it, the floor, the scale.

namespace stiffscope::render {

/// Sets labels beside their spots, where they cover neither each other nor what is reported as taken.
class LabelPlacer {
 public:
  LabelPlacer(Canvas& canvas, const Box& room) : canvas_(canvas), room_(room) {}

  void take(const Box& box) { taken_.push_back(box); }
  /// Takes a band along the line.
  void takeLine(Spot from, Spot to, double width);
  /// Writes `text` next to `spot`, `clearance` pixels from it at least, where least is covered; a thin line
  /// leads to it when it had to go far.
  void place(const std::string& text, Spot spot, double clearance, const TextStyle& style);

 private:
  double coverage(const Box& box) const;

  Canvas& canvas_;
  Box room_;
  std::vector<Box> taken_;
};

void LabelPlacer::takeLine(Spot from, Spot to, double width) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const int pieces = std::max(1, static_cast<int>(length / width));
  for (int i = 0; i <= pieces; ++i) {
    const double share = static_cast<double>(i) / pieces;
    const Spot at{std::lerp(from.x, to.x, share), std::lerp(from.y, to.y, share)};
    take({at.x - width / 2, at.y - width / 2, at.x + width / 2, at.y + width / 2});
  }
}

double LabelPlacer::coverage(const Box& box) const {
  double covered = 0;
  for (const Box& other : taken_) {
    if (!box.overlaps(other)) continue;
    covered += (std::min(box.right, other.right) - std::max(box.left, other.left)) *
               (std::min(box.bottom, other.bottom) - std::max(box.top, other.top));
  }
  const bool inside =
      box.left >= room_.left && box.right <= room_.right && box.top >= room_.top && box.bottom <= room_.bottom;
  return inside ? covered : covered + 1e6;
}

void LabelPlacer::place(const std::string& text, Spot spot, double clearance, const TextStyle& style) {
  const Spot extent = canvas_.measure(text, style);
  constexpr std::array<Spot, 8> kSides = {
      {{1, -0.6}, {-1, -0.6}, {1, 0.6}, {-1, 0.6}, {1, 0}, {-1, 0}, {0, -1}, {0, 1}}};
  Box best;
  double best_distance = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const double distance : {1.0, 1.8, 3.0, 4.5, 6.5}) {
    for (const Spot& side : kSides) {
      const double reach = clearance * distance;
      const double x = spot.x + side.x * (reach + extent.x / 2);
      const double y = spot.y + side.y * (reach + extent.y / 2);
      const Box box{x - extent.x / 2, y - extent.y / 2, x + extent.x / 2, y + extent.y / 2};
      // A little covered nearby is better than nothing far away.
      const double cost = coverage(box) + 4 * (distance - 1) * canvas_.unit();
      if (cost < least) {
        least = cost;
        best = box;
        best_distance = distance;
      }
    }
  }
  if (best_distance > 2) {
    const Spot end{std::clamp(spot.x, best.left, best.right), std::clamp(spot.y, best.top, best.bottom)};
    canvas_.line(spot, end, style.colour, canvas_.unit());
  }
  // A rim of paper sets the letters off from the arm.
  TextStyle rim = style;
  rim.colour = canvas_.palette().paper;
  for (const Spot& side : kSides) {
    canvas_.text(text, {best.left + 1.5 * side.x, best.top + 1.5 * side.y}, AlignX::left, AlignY::top, rim);
  }
  canvas_.text(text, {best.left, best.top}, AlignX::left, AlignY::top, style);
  take(best);
}

namespace {

constexpr double kMark = 10, kMarkGap = 7, kColumnGap = 14, kLine = 20, kApart = 18;  // pixels at 1200 x 700

TextStyle panelTitleStyle(const Canvas& canvas) { return {14 * canvas.unit(), true, canvas.palette().ink}; }
TextStyle panelStyle(const Canvas& canvas) { return {13 * canvas.unit(), false, canvas.palette().ink}; }

struct PanelLayout {
  double mark = 0;              ///< room of the patches before the rows
  std::vector<double> columns;  ///< their widths
  double width = 0;
};

PanelLayout layoutOf(const Canvas& canvas, const ScenePanel& panel) {
  const double u = canvas.unit();
  PanelLayout layout;
  for (const ScenePanel::Row& row : panel.rows) {
    if (row.mark) layout.mark = (kMark + kMarkGap) * u;
    layout.columns.resize(std::max(layout.columns.size(), row.cells.size()), 0.0);
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      layout.columns[i] = std::max(layout.columns[i], canvas.measure(row.cells[i], panelStyle(canvas)).x);
    }
  }
  layout.width = layout.mark;
  for (const double column : layout.columns) layout.width += column;
  if (!layout.columns.empty()) layout.width += static_cast<double>(layout.columns.size() - 1) * kColumnGap * u;
  layout.width = std::max(layout.width, canvas.measure(panel.title, panelTitleStyle(canvas)).x);
  return layout;
}

void paintRow(Canvas& canvas, const ScenePanel& panel, const ScenePanel::Row& row, const PanelLayout& layout,
              double left, double y) {
  const double u = canvas.unit();
  if (row.mark) canvas.fill({left, y - kMark / 2 * u, left + kMark * u, y + kMark / 2 * u}, *row.mark);
  double x = left + layout.mark;
  for (std::size_t i = 0; i < row.cells.size(); ++i) {
    const bool right = panel.numbers && i > 0;
    canvas.text(row.cells[i], {right ? x + layout.columns[i] : x, y}, right ? AlignX::right : AlignX::left,
                AlignY::centre, panelStyle(canvas));
    x += layout.columns[i] + kColumnGap * u;
  }
}

/// Returns where the panel ends. What would be lower than `bottom` is left out.
double paintPanel(Canvas& canvas, const ScenePanel& panel, const PanelLayout& layout, Spot corner, double bottom) {
  const double line = kLine * canvas.unit();
  double y = corner.y + line / 2;
  if (!panel.title.empty() && y + line / 2 <= bottom) {
    canvas.text(panel.title, {corner.x, y}, AlignX::left, AlignY::centre, panelTitleStyle(canvas));
    y += 1.1 * line;
  }
  for (const ScenePanel::Row& row : panel.rows) {
    if (y + line / 2 > bottom) break;
    paintRow(canvas, panel, row, layout, corner.x, y);
    y += line;
  }
  return y - line / 2;
}

}  // namespace

void takePanels(Canvas& canvas, Box& free, const std::vector<ScenePanel>& panels) {
  if (panels.empty()) return;
  std::vector<PanelLayout> layouts;
  double widest = 0;
  for (const ScenePanel& panel : panels) {
    layouts.push_back(layoutOf(canvas, panel));
    widest = std::max(widest, layouts.back().width);
  }
  const double left = free.right - widest;
  double top = free.top;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    top = paintPanel(canvas, panels[i], layouts[i], {left, top}, free.bottom) + kApart * canvas.unit();
  }
  free.right = left - kApart * canvas.unit();
}

namespace {

bool inRoom(const SceneStage& stage, const Eigen::Vector3d& point) {
  const Spot spot = stage.projection.spotOf(point);
  return spot.x >= stage.room.left && spot.x <= stage.room.right && spot.y >= stage.room.top &&
         spot.y <= stage.room.bottom;
}

/// Radius of the balls of the targets on the picture.
double ballPixels(const SceneStage& stage, const ArmPose& pose) {
  return ArmProportions(pose).target_radius * stage.projection.pixelsPerMetre();
}

void takeArm(LabelPlacer& labels, const SceneStage& stage, const ArmPose& pose) {
  const ArmProportions proportions(pose);
  const auto take = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius) {
    labels.takeLine(stage.projection.spotOf(from), stage.projection.spotOf(to),
                    std::max(4.0, 2 * radius * stage.projection.pixelsPerMetre()));
  };
  double along = 0;
  for (std::size_t i = 1; i < pose.joint_points.size(); ++i) {
    take(pose.joint_points[i - 1], pose.joint_points[i], proportions.radiusAt(along));
    along += (pose.joint_points[i] - pose.joint_points[i - 1]).norm();
  }
  for (const ScenePoint& target : pose.targets) take(pose.joint_points.back(), target.position, proportions.tip_radius);
}

void paintTriad(Canvas& canvas, const SceneStage& stage, LabelPlacer& labels) {
  const double length = 70 * stage.unit / stage.projection.pixelsPerMetre();
  const Spot origin = stage.projection.spotOf(stage.scene.frame_origin);
  const char* names[] = {"x_{0}", "y_{0}", "z_{0}"};
  for (int i = 0; i < 3; ++i) {
    const Spot tip = stage.projection.spotOf(stage.scene.frame_origin + length * Eigen::Vector3d::Unit(i));
    // An axis seen end on has no direction to draw.
    if (std::hypot(tip.x - origin.x, tip.y - origin.y) < 12 * stage.unit) continue;
    drawArrow(canvas, origin, tip, stage.surface.palette.ink, 2 * stage.unit, 10 * stage.unit);
    labels.takeLine(origin, tip, 6 * stage.unit);
    labels.place(names[i], tip, 4 * stage.unit, labelStyle(canvas));
  }
}

void paintLoad(Canvas& canvas, const SceneStage& stage, const ArmPose& pose, LabelPlacer& labels) {
  const Spot from = stage.projection.spotOf(pose.load->at), tip = stage.projection.spotOf(loadTip(pose));
  // A load seen end on has no direction to draw.
  if (std::hypot(tip.x - from.x, tip.y - from.y) < 12 * stage.unit) return;
  const double head = 22 * stage.unit, width = 6 * stage.unit, rim = 4 * stage.unit;
  drawArrow(canvas, from, tip, stage.surface.palette.paper, width + rim, head + rim);
  drawArrow(canvas, from, tip, stage.surface.palette.ink, width, head);
  labels.takeLine(from, tip, head);
  TextStyle style = labelStyle(canvas);
  style.bold = true;
  labels.place(pose.load->label, tip, 8 * stage.unit, style);
}

void paintRing(Canvas& canvas, const SceneStage& stage, const Eigen::Vector3d& point) {
  const Spot centre = stage.projection.spotOf(point);
  const double radius = std::max(15 * stage.unit, 1.4 * ballPixels(stage, stage.scene.poses.front()));
  constexpr int kPieces = 40;
  const auto at = [&](int i) {
    const double angle = 2 * M_PI * i / kPieces;
    return Spot{centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
  };
  for (const auto& [colour, width] : {std::pair{canvas.palette().paper, 5.0}, std::pair{canvas.palette().ink, 2.5}}) {
    for (int i = 0; i < kPieces; ++i) canvas.line(at(i), at(i + 1), colour, width * stage.unit);
  }
}

}  // namespace

void paintLabels(Canvas& canvas, const SceneStage& stage) {
  if (stage.scene.picked) paintRing(canvas, stage, *stage.scene.picked);
  LabelPlacer labels(canvas, stage.room);
  const auto kinds = vectorKinds(stage.scene);
  forEachPoint(stage.scene, [&](const ScenePoint& point, const ArmPose&) {
    const Spot spot = stage.projection.spotOf(point.position);
    const double r = std::max(8 * stage.unit, ballPixels(stage, stage.scene.poses.front()));
    labels.take({spot.x - r, spot.y - r, spot.x + r, spot.y + r});
    for (const VectorKind& kind : kinds) {
      if (!(point.*kind.vector)) continue;
      const Eigen::Vector3d drawn = stage.magnification * kind.factor * *(point.*kind.vector);
      labels.takeLine(spot, stage.projection.spotOf(point.position + drawn), 12 * stage.unit);
    }
  });
  // The axes stand on the arm's foot and so do their labels; those of the points keep clear of the arm.
  paintTriad(canvas, stage, labels);
  for (const ArmPose& pose : stage.scene.poses) {
    if (!pose.ghost) takeArm(labels, stage, pose);
  }
  for (const ArmPose& pose : stage.scene.poses) {
    if (drawsLoad(pose)) paintLoad(canvas, stage, pose, labels);
  }
  forEachPoint(stage.scene, [&](const ScenePoint& point, const ArmPose& pose) {
    if (pose.ghost || point.label.empty() || !inRoom(stage, point.position)) return;
    TextStyle style = labelStyle(canvas);
    style.bold = true;
    const double clearance = std::max(11 * stage.unit, ballPixels(stage, pose) + 4 * stage.unit);
    labels.place(point.label, stage.projection.spotOf(point.position), clearance, style);
  });
  for (const SceneTrace& trace : stage.scene.traces) {
    if (trace.faint || trace.points.empty() || trace.label.empty()) continue;
    if (!inRoom(stage, trace.points.back())) continue;
    labels.place(trace.label, stage.projection.spotOf(trace.points.back()), 11 * stage.unit, labelStyle(canvas));
  }
}

namespace {

// Vectors and ghosts are nearly flat: their colour is what counts.
constexpr double kArmAmbient = 0.55;
constexpr double kFlatAmbient = 0.86;

Eigen::Vector3d lightOf(const ViewAxes& axes) {
  return (-0.45 * axes.right + 0.65 * axes.up + 0.7 * axes.to_viewer).normalized();
}

void show(vtkRenderer& layer, const SceneStage& stage, const Mesh& mesh) {
  stage.projection.setCamera(layer, stage.surface.size);
  layer.AddActor(mesh.actor());
}

}  // namespace

void addArmsTo(vtkRenderer& layer, const SceneStage& stage, bool ghosts) {
  Mesh mesh(lightOf(stage.axes), ghosts ? kFlatAmbient : kArmAmbient);
  for (const ArmPose& pose : stage.scene.poses) {
    if (pose.ghost == ghosts) addArm(mesh, pose, stage.surface.palette);
  }
  show(layer, stage, mesh);
}

void addVectorsTo(vtkRenderer& layer, const SceneStage& stage, const VectorKind& kind) {
  Mesh mesh(lightOf(stage.axes), kFlatAmbient);
  const double metres = stage.unit / stage.projection.pixelsPerMetre();
  const double factor = stage.magnification * kind.factor;
  forEachPoint(stage.scene, [&](const ScenePoint& point, const ArmPose&) {
    if (!(point.*kind.vector)) return;
    const Eigen::Vector3d tip = point.position + factor * *(point.*kind.vector);
    mesh.addArrow(point.position, tip, kind.width / 2 * metres, kind.head * metres, kind.colour);
  });
  show(layer, stage, mesh);
}

void addDotsTo(vtkRenderer& layer, const SceneStage& stage) {
  Mesh mesh(lightOf(stage.axes), kFlatAmbient);
  const Palette& palette = stage.surface.palette;
  const double metres = stage.unit / stage.projection.pixelsPerMetre();
  for (const ArmPose& pose : stage.scene.poses) {
    if (!pose.wrist) continue;
    mesh.addSphere(pose.wrist->position, 6 * metres, paler(palette.wrist, pose.ghost ? 0.6 : 1, palette.paper));
  }
  for (const SceneTrace& trace : stage.scene.traces) {
    const Colour colour = paler(palette.measured, trace.faint ? 0.35 : 1, palette.paper);
    for (const auto& point : trace.points) mesh.addDot(point, (trace.faint ? 3 : 4) * metres, colour);
  }
  show(layer, stage, mesh);
}

namespace {

std::string lengthText(double metres) {
  return metres < 1e-4 ? shortNumber(metres * 1e6) + " \u00b5m" : shortNumber(metres * 1e3) + " mm";
}

}  // namespace

SceneLayout paintSurroundings(Canvas& canvas, const ArmScene& scene) {
  Box free = canvas.all();
  takeMargin(canvas, free);
  takeHeader(canvas, free, scene.title, scene.subtitle);
  std::vector<LegendEntry> legend;
  constexpr std::array kKeys{Key::thick_arrow, Key::thin_arrow, Key::medium_arrow};
  const auto kinds = vectorKinds(scene);
  const bool others = hasVectors(scene, kinds[0]) || hasVectors(scene, kinds[1]);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (!hasVectors(scene, kinds[i])) continue;
    const bool alone = kinds[i].factor == 1 || !others;
    const std::string longer = alone ? "" : fmt::format(", {} times longer", shortNumber(kinds[i].factor));
    legend.push_back({kKeys[i], kinds[i].colour, kinds[i].name.empty() ? "" : kinds[i].name + longer});
  }
  if (!scene.traces.empty()) legend.push_back({Key::point, canvas.palette().measured, scene.trace_name});
  takeLegend(canvas, free, legend);
  takeNote(canvas, free, scene.note);
  const double top = free.bottom - 26 * canvas.unit();
  Box room{free.left, free.top, free.right, top - 6 * canvas.unit()};
  takePanels(canvas, room, scene.panels);
  return {room, {free.left, top, free.right, free.bottom}};
}

void paintFloor(Canvas& canvas, const SceneStage& stage) {
  const FloorGrid floor = floorOf(stage.scene);
  const auto line = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    canvas.line(stage.projection.spotOf(from), stage.projection.spotOf(to), stage.surface.palette.grid,
                1.25 * stage.unit);
  };
  for (int i = floor.x_first; i <= floor.x_last; ++i) line(floor.at(i, floor.y_first), floor.at(i, floor.y_last));
  for (int j = floor.y_first; j <= floor.y_last; ++j) line(floor.at(floor.x_first, j), floor.at(floor.x_last, j));
}

namespace {

/// One reference arrow from `left` on with its words; returns where it ends.
double paintReference(Canvas& canvas, const SceneStage& stage, double factor, const VectorKind& look,
                      const std::string& what, Spot left) {
  const double pixels_per_deflection = factor * stage.projection.pixelsPerMetre();
  const double reference = roundDown125(150 * stage.unit / pixels_per_deflection);
  const Spot tip{left.x + reference * pixels_per_deflection, left.y};
  drawArrow(canvas, left, tip, look.colour, look.width * stage.unit, look.head * stage.unit);
  const std::string text = fmt::format("{}   {} \u00d7 {}", lengthText(reference), what, factorText(factor));
  const Spot at{tip.x + 10 * stage.unit, left.y};
  canvas.text(text, at, AlignX::left, AlignY::centre, labelStyle(canvas));
  return at.x + canvas.measure(text, labelStyle(canvas)).x;
}

}  // namespace

void paintScale(Canvas& canvas, const SceneStage& stage, const Box& strip) {
  auto kinds = vectorKinds(stage.scene);
  const bool residual = hasVectors(stage.scene, kinds[2]);
  const bool others = hasVectors(stage.scene, kinds[0]) || hasVectors(stage.scene, kinds[1]);
  if (!residual && !others && !stage.scene.traces.empty()) return;
  double left = strip.left;
  if (others || !residual) {
    kinds[0].colour = stage.surface.palette.ink;  // stands for measured and predicted ones
    left = paintReference(canvas, stage, stage.magnification, kinds[0], "vectors", {left, strip.middleY()});
    left += 40 * stage.unit;
  }
  if (residual && (!others || kinds[2].factor != 1)) {
    paintReference(canvas, stage, stage.magnification * kinds[2].factor, kinds[2], "residual", {left, strip.middleY()});
  }
}

const Palette& paletteOf(const ArmScene& scene) { return scene.dark ? kDarkPalette : kLightPalette; }

std::array<VectorKind, 3> vectorKinds(const ArmScene& scene) {
  const Palette& palette = paletteOf(scene);
  return {{{&ScenePoint::measured, palette.measured, kMeasuredWidth, kMeasuredHead, 1, scene.measured_name},
           {&ScenePoint::predicted, palette.predicted, kPredictedWidth, kPredictedHead, 1, scene.predicted_name},
           {&ScenePoint::residual, palette.residual, kResidualWidth, kResidualHead, scene.residual_factor,
            scene.residual_name}}};
}

bool hasVectors(const ArmScene& scene, const VectorKind& kind) {
  bool any = false;
  forEachPoint(scene, [&](const ScenePoint& point, const ArmPose&) { any = any || (point.*kind.vector); });
  return any;
}

}  // namespace stiffscope::render
