#include "render/backend.h"
#include "render/vtk/offscreen_picture.h"
#include "render/vtk/painters.h"

// The entry of the module: what the loader in render/backend.cpp looks for.

namespace stiffscope::render {

namespace {

class VtkBackend : public Backend {
 public:
  Image draw(const GroupedBarChart& chart, Size size) override { return drawGroupedBars(chart, size); }
  Image draw(const SpreadChart& chart, Size size) override { return drawSpreads(chart, size); }
  Image draw(const IntervalChart& chart, Size size) override { return drawIntervals(chart, size); }
  Image draw(const PointChart& chart, Size size) override { return drawPoints(chart, size); }
  Image draw(const DotRowChart& chart, Size size) override { return drawDotRows(chart, size); }
  Image draw(const ArmScene& scene, Size size) override { return drawArmScene(scene, size); }
};

}  // namespace

}  // namespace stiffscope::render

// The name must be that of kBackendSymbol.
extern "C" __attribute__((visibility("default"))) stiffscope::render::Backend* stiffscope_render_backend_8() {
  static stiffscope::render::VtkBackend backend;
  return &backend;
}
