#include "reports/words/validation_words.h"

#include <fmt/format.h>
#include <cmath>

namespace stiffscope::reports {

std::string sizeWords(const validation::SizeClass& sizes) {
  if (sizes.least == 0.0) return fmt::format("below {:g}", sizes.below);
  if (std::isinf(sizes.below)) return fmt::format("{:g} and more", sizes.least);
  return fmt::format("{:g} to {:g}", sizes.least, sizes.below);
}

}  // namespace stiffscope::reports
