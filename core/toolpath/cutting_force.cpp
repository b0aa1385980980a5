#include "core/toolpath/tool_path.h"

#include <cmath>
#include <numbers>

namespace stiffscope::toolpath {

CuttingForce meanCuttingForce(const Cutting& cutting) {
  using std::numbers::pi;
  const double engaged = std::acos(1.0 - 2.0 * cutting.width / cutting.diameter);
  const double start = cutting.up ? 0.0 : pi - engaged, exit = cutting.up ? engaged : pi;
  const auto between = [&](auto of) { return of(exit) - of(start); };
  const double cosines = between([](double phi) { return std::cos(2.0 * phi); });
  const double sines = between([](double phi) { return 2.0 * phi - std::sin(2.0 * phi); });
  const double cosine = between([](double phi) { return std::cos(phi); });
  const double unit = cutting.specific_force * cutting.depth * cutting.feed;
  CuttingForce found;
  found.force << unit / (8.0 * pi) * (cosines - cutting.radial_ratio * sines),
      unit / (8.0 * pi) * (sines + cutting.radial_ratio * cosines), unit / (2.0 * pi) * cutting.axial_ratio * cosine;
  found.torque = cutting.specific_force * cutting.depth * cutting.width * cutting.feed / (2.0 * pi);
  return found;
}

}  // namespace stiffscope::toolpath
