#include "app/figures/evenly_drawn.h"

#include <fmt/format.h>

#include <algorithm>

namespace stiffscope {

std::vector<std::size_t> evenlyDrawn(std::size_t count, std::size_t most) {
  std::vector<std::size_t> drawn(std::min(count, most));
  for (std::size_t k = 0; k < drawn.size(); ++k) drawn[k] = k * count / drawn.size();
  return drawn;
}

std::string drawnWords(std::size_t count, std::size_t most, const std::string& what) {
  return count <= most ? "" : fmt::format(" Drawn: {} of {} {}, spread evenly.", most, count, what);
}

}  // namespace stiffscope
