#pragma once

#include <array>
#include <cstdint>

#include "core/simulation/spec.h"

// One machine in two states, measured on two days: what `compare` is judged on. Machines are those of the blind
// validation (drawMachine of core/validation/effect_draw.h), measured by the simulator, which shares no formula with
// the identification.

namespace stiffscope::simulated_pairs {

/// What the machine has besides joint springs, in both states alike.
enum class Hidden {
  nothing,
  bearings_and_links,      ///< every bearing 2.5 to 6 times as stiff as its joint, both long links 2 to 5 times
  bearings_links_and_base  ///< and a base 3 to 8 times as stiff as joint 2
};

/// A machine and its first day. `first_seed` and `pair` name the machine.
simulation::SimulationSpec firstDay(std::uint64_t first_seed, int pair, Hidden hidden);

/// Another day of that machine with joint compliances times `factors`: other noise, the tracker set up again half a
/// metre and a few degrees away, the taught postures reached to two thousandths of a degree.
simulation::SimulationSpec anotherDay(const simulation::SimulationSpec& first, const std::array<double, 6>& factors,
                                      std::uint64_t measurement = 2);

/// Of joint compliances: in every other pair joints 1 to 3 stiffened to 0.4 to 0.8 of their compliance, as double
/// encoders do; in the others one of the six softened to 1.05 to 1.5.
std::array<double, 6> drawnChange(std::uint64_t first_seed, int pair);

}  // namespace stiffscope::simulated_pairs
