#pragma once

#include "core/identification/identify.h"
#include "render/colours.h"

namespace stiffscope {

/// The paper's colours: CP red, PP blue, DPP green.
inline Colour colourOf(Method method) {
  constexpr std::array<Colour, 3> kByMethod{colours::kCp, colours::kPp, colours::kDpp};
  return kByMethod[static_cast<std::size_t>(method)];
}

}  // namespace stiffscope
