#pragma once

#include <cstddef>
#include <string>

namespace stiffscope {

/// Why `given` readings cannot make a shape that takes `needed`; empty where they are enough, and for none at
/// all, which has a reason of its own (LocalPoints::flaw).
inline std::string tooFewReadings(std::size_t needed, std::size_t given) {
  if (given == 0 || given >= needed) return {};
  return std::to_string(needed) + " readings or more are needed, " + std::to_string(given) +
         (given == 1 ? " is" : " are") + " given";
}

}  // namespace stiffscope
