#pragma once

namespace stiffscope::effects {

/// What a campaign lacks for an effect to be told. None carries a value.
enum class RemarkId {
  backlash_needs_loads_or_masses,
  bias_needs_two_loads,
  compensator_needs_masses,
  compensator_needs_positions,
  drift_needs_nests_or_timed_positions,
  frame_needs_masses_or_nests,
  frame_needs_sweeps_and_positions,
  geometry_needs_masses,
  geometry_needs_positions,
  hardening_needs_two_loads,
  hysteresis_needs_return_to_zero,
  rail_bending_needs_rail,
  rail_bending_needs_three_positions,
  target_needs_three_reflectors,
  tool_needs_reflectors_or_moments,
};

}  // namespace stiffscope::effects
