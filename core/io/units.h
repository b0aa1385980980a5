#pragma once

#include <numbers>

// Factors from the units that people and files use to SI. `mm * kMillimetre` is a length in metres.

namespace stiffscope::io {

inline constexpr double kMillimetre = 1e-3;
inline constexpr double kMicrometre = 1e-6;
inline constexpr double kSquareCentimetre = 1e-4;
inline constexpr double kLitre = 1e-3;
inline constexpr double kBar = 1e5;
inline constexpr double kDegree = std::numbers::pi / 180.0;

}  // namespace stiffscope::io
