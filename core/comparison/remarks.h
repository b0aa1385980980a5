#pragma once

namespace stiffscope::comparison {

/// Which of the two campaigns a remark is of.
enum class When { before, after, both };

enum class RemarkId {
  // What says that the two machines are not one.
  other_joint_count,  ///< joints before, after
  axis_turned,        ///< axis number, turn rad
  axis_elsewhere,     ///< axis number, distance m
  other_name,         ///< name before, after
  flange_elsewhere,   ///< distance m, turn rad
  other_masses,       ///< of all links before kg, after kg
  other_balancers,    ///< number before, after
  // What else to know before believing the numbers.
  same_encoders,  ///< whether active
  encoders_swapped,
  few_correspond,          ///< postures that correspond, postures
  other_postures,          ///< postures that correspond: differences are of all postures of each
  difference_above_noise,  ///< residual of the difference per coordinate m, noise in it m
  // What to know before believing the change of a geometry.
  geometry_of_other_postures,  ///< postures that correspond
  effects_changed,             ///< probability of unchanged ones
  no_common_reflector,
  zero_1_with_base,
  zero_of_last_with_reflectors,  ///< the last joint's number, its axis'
  // Why something cannot be compared.
  nothing_comparable,  ///< why no deflection, why no stiffness
  of_one_campaign,     ///< When, what its identification says
  not_identifiable,    ///< When, why
  no_joint_in_both,
  no_posture_in_both,
  nothing_moved_before,
  wrist_not_measured,  ///< When
  // Why a posture has no counterpart.
  left_out,       ///< When, why
  not_measured,   ///< When
  no_load_state,  ///< When, load step
  other_angles,   ///< joint number, difference rad, limit rad
  other_load,     ///< difference N, force before N, after N, limit as a share of the larger
};

}  // namespace stiffscope::comparison
