// The panels beside a scene: words and numbers in columns.
#include <algorithm>

#include "render/vtk/chart_frame.h"
#include "render/vtk/scene_stage.h"

namespace stiffscope {

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
  if (!layout.columns.empty())
    layout.width += static_cast<double>(layout.columns.size() - 1) * kColumnGap * u;
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
    canvas.text(row.cells[i], {right ? x + layout.columns[i] : x, y}, right ? AlignX::Right : AlignX::Left,
                AlignY::Centre, panelStyle(canvas));
    x += layout.columns[i] + kColumnGap * u;
  }
}

/// Returns where the panel ends. What would be lower than `bottom` is left out.
double paintPanel(Canvas& canvas, const ScenePanel& panel, const PanelLayout& layout, Spot corner,
                  double bottom) {
  const double line = kLine * canvas.unit();
  double y = corner.y + line / 2;
  if (!panel.title.empty() && y + line / 2 <= bottom) {
    canvas.text(panel.title, {corner.x, y}, AlignX::Left, AlignY::Centre, panelTitleStyle(canvas));
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

}  // namespace stiffscope
