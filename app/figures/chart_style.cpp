#include "app/figures/chart_style.h"

#include <fmt/format.h>

namespace stiffscope::app {

std::string drawnWords(std::size_t count, std::size_t most, const std::string& what) {
  return count <= most ? "" : fmt::format(" Drawn: {} of {} {}, spread evenly.", most, count, what);
}

}  // namespace stiffscope::app
