#pragma once

namespace stiffscope::identification {

/// Why methods, joints and postures are not to be had, and what to know before believing stiffnesses.
enum class RemarkId {
  // what a campaign lacks
  no_states,
  no_load_cell,
  no_readings_under_load,
  no_wrench,
  // why a method is not available
  displacements_not_placed,
  loading_not_placed,
  no_posture_in_both_states,
  no_joint_turned,
  flange_pose_not_everywhere,
  flange_pose_by_displacements,  ///< reflectors
  wrist_point_not_everywhere,
  wrist_centre_not_measured,  ///< why
  wrist_sweep_wanted,         ///< why there is no P_wrist, first and last of the wrist's axes
  wrist_sweep_wanted_too,     ///< why there are no positions, first and last of the wrist's axes
  wrist_is_offset,            ///< the first of its axes; how far apart the first two and the last two meet, m
  wrist_axes_apart,  ///< distances of consecutive wrist axes m, share of P_wrist's motion, most share, the first of
                     ///< those axes
  geometry_not_calibrated,      ///< why
  displacements_by_model_only,  ///< of the calibration: not done
  // why a joint is not identifiable
  points_on_axis,         ///< axis number, distance of the measured points rms m
  load_hangs,             ///< axis number, torque rms Nm, by a load along gravity rms Nm
  load_turns_too_little,  ///< axis number, torque rms Nm, least ratio, torque by the uncertainties rms Nm
  two_joints_combined,    ///< joint numbers a and b, r of the compliance c_a + r c_b that is seen
  joints_combined,        ///< joint numbers, steps of their compliances that together move nothing, the first 1
  // why a posture is left out
  no_state_of_step,
  no_reflector_in_both_states,
  back_at_zero,  ///< force N, the posture's largest N
  under_three_reflectors,
  no_wrist_point,
  disagrees,  ///< left per coordinate rms m, times that of the other postures
  in_step,    ///< why, load step: where several steps are used together
  // what to know before believing
  geometry_missed,   ///< unloaded positions missed by rms m
  implausible_load,  ///< force rms N, displacement rms m
  all_negative,
  residual_above_noise,  ///< residual per coordinate m, noise per coordinate m
  too_few_postures,      ///< load cases
  outlying_postures,     ///< names, left per coordinate rms of each m, of the others m, whether left out (1)
  mostly_noise,
  // why a method is shown first; methods by their number in Method
  shown_compensates_most,  ///< where (ShownFirst::Judged), method, methods that were judged, their held-out shares
  shown_as_good_as_most,   ///< where, method, the one that compensates most, by how much more, standard deviation of
                           ///< that over the subsets, methods that were judged, their held-out shares
  shown_alone,             ///< method
  shown_unjudged,          ///< method
  shown_as_in_the_paper,   ///< method
  shown_as_asked,          ///< method
  // why the gear of a joint is not measured by its two encoders, and what to know of it
  no_second_encoder,
  no_loaded_state,
  encoders_apart,            ///< joint number, median of |motor side - reported| rad
  too_few_encoder_postures,  ///< postures with two states, fewest
  loop_not_as_declared,      ///< joint number, whether the motor's side is held (1)
  sag_in_sweeps,             ///< largest sag taken off m
  sag_left_in,               ///< of sweeps: nothing of it is in their uncertainties
  sag_in_sweeps_weighed,     ///< the same, what could hide in it weighed
  sweep_above_noise,         ///< axis number, residual rms m, times the noise
  /// joint number, k from elsewhere and its standard uncertainty Nm/rad, its source, k of the day, ends of its interval
  known_stiffness_contradicted,
  // of a joint's stiffness
  negative,
  imprecise  ///< expanded uncertainty above about twice the value
};

}  // namespace stiffscope::identification
