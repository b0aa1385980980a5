#pragma once

#include <cstddef>

namespace stiffscope::numerics {

/// One of `of` parts of a work of independent pieces: pieces index, index + of, ...
struct Shard {
  std::size_t index = 0, of = 1;

  bool has(std::size_t piece) const { return piece % of == index; }
};

}  // namespace stiffscope::numerics
