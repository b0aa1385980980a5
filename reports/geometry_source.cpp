#include "reports/geometry_source.h"

#include <algorithm>

namespace stiffscope {

const char* sourceOf(const Frames& frames, std::initializer_list<std::size_t> axes) {
  const auto measured = static_cast<std::size_t>(
      std::count_if(axes.begin(), axes.end(), [&](std::size_t axis) { return frames.axes[axis].measured; }));
  if (measured == axes.size()) return "sweeps";
  return measured == 0 ? "nominal" : "partly nominal";
}

std::string sourceMark(const Frames& frames, std::initializer_list<std::size_t> axes) {
  const std::string source = sourceOf(frames, axes);
  return source == "sweeps" ? std::string() : " (" + source + ")";
}

}  // namespace stiffscope
