#pragma once

namespace stiffscope::frames {

/// Why axes, wrist centre and geometry are not measured, and what is known of the arm's own sag.
enum class RemarkId {
  // an axis
  no_circle_sweeps,    ///< of the whole campaign
  not_swept,           ///< the axis
  other_joints_moved,  ///< during its sweep
  coupled_joints,      ///< of the whole arm: a joint turns several axes, its sweep shows none of them by itself
  coupled_axes_not_placed,
  coupled_flange_level,
  coupled_axes_not_settling,
  earlier_axis_not_known,  ///< number of an axis that stood away from zero and is not measured
  // the wrist centre
  no_wrist_sweep,
  wrist_turns_arm,
  r0_not_in_frame_of_readings,
  wrist_sweep_in_other_frame,
  arm_moved_in_wrist_sweep,  ///< number of the last axis before the wrist
  wrist_reflectors_under_four,
  // the arm's own sag
  sag_without_stiffness,
  sag_without_masses,
  sag_taken_off,
  sag_by_known_stiffness,
  sag_allowed_for,  ///< standard uncertainty of a joint's turn by the own weight, rad
  // calibration of the geometry
  no_unloaded_positions,
  base_not_placed,
  too_few_positions,         ///< positions, parameters
  calibration_not_settling,  ///< what the solver says
  axis_parameter,            ///< axis number, which of it: 0, 1 place along u, v; 2, 3 direction along u, v
  base_against_reflectors,   ///< how many combinations of their places
  // equations of absolute unloaded positions
  no_absolute_readings,
  tracker_noise_not_declared,
  axis_not_measured,  ///< axis number, why
  loading_in_other_frame
};

}  // namespace stiffscope::frames
