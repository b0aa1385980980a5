#pragma once

#include <string>

#include "metrology/remark.h"

namespace stiffscope::audit {

/// What the checks have to say; reports/words has the sentences. Joints and axes by their numbers from 1, postures,
/// reflectors and rows (FILE:LINE) by name. `more` are remarks that go on with the sentence, often none.
enum class RemarkId {

  // Where something is.
  at_axis,             ///< axis
  at_axis_row,         ///< axis, row
  at_axes,             ///< both axes
  at_axis_and_pair,    ///< axis, both reflectors
  at_reflector,        ///< reflector, axis
  at_reflectors,       ///< remarks at_reflector
  at_moved_reflector,  ///< reflector, row
  at_pose,             ///< posture
  at_state,            ///< posture, load step
  at_time,             ///< s
  at_loading,
  at_tracker,
  at_load_cell,

  // What a pass needs, and no check tells.
  unknown_if_it_identifies,
  unknown_size,
  unknown_worth_of_readings,
  unknown_load_cell,
  unknown_arm,
  unknown_worth_unloaded,
  too_few_to_calibrate,  ///< coordinates read, parameters of the geometry

  // time_order, completeness.
  steps_follow,
  steps_out_of_order,      ///< remarks step_too_early, state_during; or one of the next two alone
  rows_of_other_postures,  ///< file, postures moved, of how many; the first, the one read at its time; whether as
                           ///< sorted as text
  step_too_early,          ///< row, posture, step, step before whose end it begins
  state_during,            ///< row, posture, step, step during which it was taken
  clocks_apart,            ///< file, other file, by how much its times are ahead of that one's in s, rows out of order
  all_there,               ///< postures
  missing,                 ///< remarks: the four below
  step_not_read,           ///< posture, step
  no_row_in_states,        ///< posture, step
  too_few_readings,        ///< posture, step, readings, of how many, reflector
  posture_not_read,        ///< posture

  // repeatability_along, repeatability_across, noise_declared, rigid_tool.
  repeats_scatter,  ///< whether along the beam, one sigma in m, in parts of what is declared, whether beyond the limit
  repeats_scatter_little,
  repeats_rounded,     ///< last digit of the readings, m
  noise_borne_out,     ///< times, remarks: the eight below
  noise_too_large,     ///< the same
  noise_too_small,     ///< the same
  noise_explained,     ///< the same: a mistake that is suspected makes it
  repeats_along_show,  ///< of what is declared, as the next
  repeats_across_show,
  nests_show,
  sweep_shows,  ///< axis, of what is declared
  short_sweeps_show,
  returns_show,
  unloaded_cell_shows,
  lever_shows,
  declare_tracker_noise,    ///< along, across: by what to multiply what is declared
  declare_load_cell_noise,  ///< the same, of all figures
  take_step_0_off,          ///< drift over the day, N and Nm; hours between its first reading and its last
  unloaded_scatter,         ///< before, after: in parts of the declared noise
  distances_keep_too_well,  ///< their rms in parts of the declared noise
  distance_changes,         ///< both reflectors, m, state, more
  distances_scatter,        ///< in parts of the noise
  reflectors_exchanged,     ///< row, state, reflectors in pairs: what it is called, what it is; states in a row, last
                            ///< of them, whether from there on to the last of all
  no_one_reflector,
  reflector_moves,  ///< reflector, rms change of its distances in m: under load, without

  // station_drift, nest_moved.
  station_moved,   ///< m, rad, when in s, more
  station_drifts,  ///< m, s
  station_jumps,   ///< when, s
  motion_taken_off,
  motion_not_taken_off,  ///< why (remark)
  nests_left,            ///< in parts of the noise, more
  nest_moved,            ///< nest, m
  nests_not_mended,
  nests_too_near,      ///< two nests, m: closer than the smallest reflector is thick
  of_station,          ///< name, remark
  stations_left,       ///< in parts of the noise, more
  station_at_arm,      ///< name, nests in common, largest standard uncertainty at the arm: m, rad
  nest_read_apart,     ///< nest, station, m
  reading_read_apart,  ///< row, nest, station, m
  stations_not_mended,

  // circle_arc, circle_count, sweep_angles, circle_residual, axis_agreement, reflector_on_axis, link_lengths.
  arc_known,  ///< axis, arc rad, direction rad, place m, at the reach m, reach m, more
  wide_not_enough,
  short_arc,        ///< times as uncertain, as over an arc of rad, whether it still suffices
  smallest_circle,  ///< readings
  angle_stays,      ///< axis, turn of its reflectors rad
  angle_and_turn,   ///< axis, reported turn rad, that of its reflectors rad, whether impossible
  on_circles,
  off_circles,          ///< remarks axis_off_circles, more
  axis_off_circles,     ///< axis, rms m, in parts of the noise
  one_reading_off,      ///< axis, row
  runs_along_sweep,     ///< axes
  reflectors_agree,     ///< in parts of the difference's sd
  reflectors_disagree,  ///< in parts of the difference's sd
  well_off_axes,
  on_axis,              ///< remarks reflector_near_axis
  reflector_near_axis,  ///< at_reflector, radius m
  axes_apart,           ///< both axes, distance m, in the URDF m, whether impossible

  // wrist_sphere, wrist_axes_meet.
  wrist_residuals,    ///< rms m, of it without the axes' missing each other m, in parts of the noise, more
  wrist_reading_off,  ///< row
  wrist_axes_miss,    ///< of each two that follow each other: distance, its sd, m; more; the first axis of them
  wrist_meets_apart,  ///< the first of its axes; how far apart the first two and the last two meet, m
  wrist_leak,         ///< share of the displacement; first and last joint of the wrist
  decoupling_needs_one_point,

  // rail_straight, rail_scale, rail_direction.
  rail_leaves,    ///< along it and across it, rms m; from and to which position, m; farthest reading m
  rail_travels,   ///< true travel over the reported, its sd
  rail_runs,      ///< angle to the URDF's direction, rad
  rail_reversed,  ///< the same, beyond a quarter of a turn

  // frame_moved, unloaded_positions, joint_read_back.
  loading_shifted,  ///< shift in R0 m, turn rad, explained share of the misfit, more
  tracker_or_robot_moved,
  moved_meanwhile,           ///< remarks: the next three
  station_moved_meanwhile,   ///< posture, displacement in R0 m, turn rad, explained share of the misfit
  station_drifts_meanwhile,  ///< displacement from the first posture to the last in R0 m, turn rad, explained share
  tool_moved_meanwhile,      ///< posture, displacement m, turn rad, explained share of the misfit
  positions_miss,            ///< positions, rms as read m, rms as fitted m, in parts of what is left open, more
  positions_impossible,
  geometry_does_not_carry,
  zero_since_sweeps,  ///< joint, rad to be added, explained share of the misfit
  angles_agree,
  angles_stale,  ///< remarks joint_off
  joint_off,     ///< row, posture, joint, rad

  // servo_change, return_to_zero.
  angle_changes,  ///< joint, posture, step, whether beyond the limit
  no_angle_changes,
  comes_back,        ///< in parts of the noise, farthest m, its posture, its step, more
  do_not_come_back,  ///< remarks posture_off, of how many postures
  posture_off,       ///< posture, m

  // tare, gravity_direction, moment_lever, load_size.
  unloaded_reading,  ///< mean force N and moment Nm, more
  not_tared,
  zero_drifts,        ///< over the day, N and Nm; hours
  one_pose_off,       ///< posture, in sigma
  force_off_gravity,  ///< rms, on average, farthest, rad; posture of the farthest, more
  cell_rope_or_base,
  moments_of_force,  ///< lever m, rms left Nm, more
  lever_too_long,
  worst_state,  ///< row, posture, step
  signs_mend,   ///< components of the moment, whether of all states
  load_moves,   ///< rms N, rms m

  // posture_set.
  joint_identifiable,      ///< joint, rms Nm by the load, uncertainty Nm
  joint_not_identifiable,  ///< joint, why (remark)
  joint_missing,           ///< joint, why (remark)
  no_joint_identified,     ///< remarks joint_missing
  joints_identified,       ///< postures, load step, joints, condition number, remarks joint_missing
  effects_apart,           ///< ids of effects
  effects_alike,           ///< ids of effects
  effects_not_testable,    ///< ids of effects

  // arm_model, load_model.
  readings_agree,       ///< median distance m
  readings_contradict,  ///< median distance m, how many mistakes would mend it, the check that explains it or nothing
  springs_agree,        ///< share left
  springs_contradict,   ///< share left, how many mistakes would mend it, the check that explains it or nothing
};

/// What controller_poses has to say.
enum class ControllerRemarkId {
  controller_states,        ///< postures, rms m, farthest m, more
  poses_mended,             ///< how many mistakes would mend it
  turns_otherwise,          ///< rms of positions alone m
  poses_of_other_geometry,  ///< rms that fitted axes leave m
  poses_sag,                ///< rms that axes and compliances leave m
  poses_unexplained,        ///< rms that fitted axes leave m
  poses_of_other_arm,
  accuracy_not_seen,
  accuracy_as_declared,
  accuracy_undeclared,
  declared_nominal,
  joints_not_compared,  ///< joints
};

/// Where the limit of a check comes from.
enum class LimitId {
  chi_square,               ///< degrees of freedom
  chi_square_and_states,    ///< degrees of freedom
  chi_square_and_postures,  ///< degrees of freedom
  chi_square_held_axes,     ///< degrees of freedom; first and last axis of the wrist
  chi_square_of_axes,
  chi_square_of_pairs,  ///< pairs of reflectors
  chi_square_of_tare,
  chi_square_of_displacement,
  chi_square_of_shift,
  chi_square_of_motion,
  factor_of_two,    ///< degrees of freedom that are needed
  normal_deviates,  ///< how many
  student_between_postures,
  places_or_chance,           ///< by_chance
  third_of_places_or_chance,  ///< by_chance
  order_of_format,
  what_most_have,
  arc_practice,  ///< arcs below which it warns and fails, rad; tolerance at the arm's reach, trusted place, m
  circle_redundancy,
  turns_as_reported,
  reflector_radius,
  built_to_drawing,
  centre_of_wrist,             ///< of no wrist that is made to have one
  leak_that_decoupling_bears,  ///< first and last joint of the wrist
  places_or_sweeps,
  trusted_places,
  travels_as_reported,
  rails_are_laid,
  turn_at_lever,  ///< longest lever, m
  load_cell_axes,
  arms_stiffness,  ///< softest and stiffest arm, N/m
  condition_practice,
  machines_off_drawing,
  machines_leave,  ///< share that every simulated effect leaves at most
  controllers_compute,
};

/// What a check that does not run, or a result that is not there, would need.
enum class MissingId {
  no_sweeps,
  tracker_not_declared,
  no_loads,
  loading_not_in_r0,
  no_step_with_force,
  no_posture_to_identify_from,
  load_cell_noise_not_stated,
  no_unloaded_states,
  no_compared_postures,
  load_does_not_hang,
  no_load_cell_readings,
  no_displacement_under_force,
  few_loaded_states,
  one_kind_scatters,
  too_few_to_judge_tracker,  ///< degrees of freedom that are needed
  too_few_to_judge_load_cell,
  no_moments,
  forces_on_one_line,
  few_nests_or_rounds,
  no_nest_to_spare,
  no_load_states,
  no_states_nor_loading,
  no_readings_of_states,
  no_unloading,
  no_compared_postures_in_geometry,
  sag_not_known,
  few_unloaded_postures,    ///< how many, how many are needed
  few_postures_to_compare,  ///< how many are needed
  axis_not_measured,        ///< axis, why (remark)
  no_neighbouring_axes,
  no_sweep_below_whole_turn,
  no_two_reflectors_off_axis,
  no_two_reflectors_in_states,
  few_wrist_readings,
  wrist_axes_not_swept,  ///< first and last
  no_rail_sweep,
  no_readings_of_arm,
  few_loads_of_model,
  no_controller_poses,
  few_controller_poses,  ///< how many, how many are needed
};

}  // namespace stiffscope::audit
