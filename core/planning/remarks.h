#pragma once

namespace stiffscope::planning {

enum class RemarkId {
  // What was taken for granted.
  cell_in_flange,
  reflectors_on_ring,   ///< radius m, distance ahead of the flange m
  load_of_step,         ///< load step, force N
  load_where_measured,  ///< where it acts, flange axes m
  load_at_cell,         ///< the last joint's number
  tracker_not_placed,
  effects_as_known_now,
  noise_not_declared,  ///< standard deviation per coordinate m
  usual_effects,       ///< how far an effect usually moves the reflectors, rms m
  calibrated_before,   ///< postures that calibrated the arm, what the model left per coordinate m
  // What the standard deviations are of.
  sd_of_weighted_fit,
  // Why there is no plan.
  no_joint_seen,
};

}  // namespace stiffscope::planning
