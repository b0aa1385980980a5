#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

#include "core/campaign/campaign_names.h"
#include "core/input/units.h"

namespace stiffscope {

/// What a column holds. The first six are numbers with the unit of their name, the others names and counts.
enum class CellKind {
  millimetre,
  displacement_millimetre,
  degree,
  second,
  newton,
  newton_metre,
  axis,    ///< 1..6 in the file, 0..5 in memory
  step,    ///< 0, 1, 2...
  target,  ///< id of a declared target
  pose,
  nest,
  text
};

/// How a kind of number is written, and what is plausible: the limits only catch what cannot be meant,
/// such as a force in a column of angles.
struct NumberKind {
  double si_per_unit = 1.0;
  double limit = 0.0;  ///< largest magnitude, in the file's unit
  const char* expectation = "";
  int decimals = 0;  ///< written
};

// In the order of CellKind.
inline constexpr std::array<NumberKind, 6> kNumberKinds{{
    {kMillimetre, 200e3, "expected a coordinate in mm, within +-200 m", 4},
    {kMillimetre, 1e3, "expected a displacement from step 0 in mm, within +-1 m", 4},
    {kDegree, 720.0, "expected an angle in degrees, within +-720", 5},
    {1.0, std::numeric_limits<double>::infinity(), "expected a time in seconds", 1},
    {1.0, 1e6, "expected a force in N, within +-1e6", 3},
    {1.0, 1e6, "expected a moment in Nm, within +-1e6", 4},
}};

/// Throws std::out_of_range for a kind that is no number.
inline const NumberKind& numberKind(CellKind kind) { return kNumberKinds.at(static_cast<std::size_t>(kind)); }

/// Where a cell stands; the column as the header names it.
struct CellPlace {
  const std::string& file;
  std::size_t line;
  std::string_view column;
};

/// A cell as a number in SI and radians. Throws InputError where it is none, or not plausible.
double readNumberCell(CellKind kind, std::string_view cell, const CellPlace& place);

/// A cell that is kept as an index: axis, step, target, pose, nest. Throws InputError.
int readIndexCell(CellKind kind, std::string_view cell, const CellPlace& place, CampaignNames& names);

/// A cell that is kept as it is; throws InputError where it is empty.
std::string readTextCell(std::string_view cell, const CellPlace& place);

}  // namespace stiffscope
