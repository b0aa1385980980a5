#pragma once

#include "render/arm_scene.h"
#include "render/dot_row_chart.h"
#include "render/grouped_bar_chart.h"
#include "render/interval_chart.h"
#include "render/point_chart.h"
#include "render/spread_chart.h"

namespace stiffscope::render {

/// What draws the pictures; lives in the module with VTK. Not for users: they call `render`.
class Backend {
 public:
  virtual ~Backend() = default;
  virtual Image draw(const GroupedBarChart& chart, Size size) = 0;
  virtual Image draw(const SpreadChart& chart, Size size) = 0;
  virtual Image draw(const IntervalChart& chart, Size size) = 0;
  virtual Image draw(const PointChart& chart, Size size) = 0;
  virtual Image draw(const DotRowChart& chart, Size size) = 0;
  virtual Image draw(const ArmScene& scene, Size size) = 0;
};

/// The one symbol that is looked up in the module. Its number goes up whenever Backend or the data structures
/// change, so that a module left over from another version is refused instead of misread.
inline constexpr const char* kBackendSymbol = "stiffscope_render_backend_8";
using BackendFunction = Backend*();

}  // namespace stiffscope::render
