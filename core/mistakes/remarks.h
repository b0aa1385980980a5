#pragma once

#include "metrology/remark.h"

namespace stiffscope::mistakes {

/// What there is to say of a suspected mistake; reports/words has the sentences. Joints and axes by their numbers from
/// 1, files, postures and reflectors by name; lengths in m, angles in rad.
enum class RemarkId {

  // Where it is.
  in_columns,    ///< columns, files
  in_files,      ///< files
  at_pose_in,    ///< posture, columns, file, line of its first row there
  at_sweep_of,   ///< axis, file, line
  in_urdf,       ///< nothing else
  in_cell,       ///< attribute of load_cell
  in_attribute,  ///< attribute, of which element
  in_robot,      ///< attribute of robot
  at_poses_in,   ///< first and last posture, columns, file

  // What would mend it: of joint angles and of the robot.
  both,                ///< remarks: one remedy, another, where that one
  turn_signs,          ///< joints, whether in all tables, so that the URDF may be wrong instead
  order_of_joints,     ///< joint that stands under each of q1_deg, q2_deg..
  add_joint,           ///< joint, the one whose reading is to be added, the sign with which
  shift_zero,          ///< joint, by which angle, whether in all tables
  angles_in,           ///< unit
  angles_of_row,       ///< whether of the row after; else of the row before
  angles_of_posture,   ///< the same of postures
  angles_exchanged,    ///< both postures
  readings_exchanged,  ///< both postures, of the loading
  angles_repeated,     ///< posture, the one whose angles it has
  angles_renumbered,   ///< in pairs: posture, the one in whose row its angles are; remark: in which order, or none
  rows_renumbered,     ///< the same of whole rows, wrenches and all
  order_reversed,      ///< nothing else
  order_moved_on,      ///< by how many rows, below zero: back
  order_as_texts,      ///< nothing else
  rows_lost,           ///< first posture of those whose angles are of another row, whether of the next posture's
  angles_backwards,    ///< axis
  sweeps_exchanged,    ///< both axes
  labels_exchanged,    ///< axis as labelled, axis that turns; in pairs
  origin_off,          ///< joint, by how much (base_link, m), unit directions in which the readings do not tell it
  origin_turned,       ///< joint, about which of base_link's axes, by which angle
  scale_off,           ///< of the points against the URDF, a share above one

  // Of points and reflectors.
  left_handed,         ///< nothing else
  axes_of_points,      ///< what stands for x, y, z
  points_in,           ///< unit
  robot_in,            ///< unit
  masses_in,           ///< unit, sum of the masses as read, kg
  table_scale_off,     ///< of one table against the others, a share above one
  other_station,       ///< displacement m, turn rad
  elsewhere,           ///< displacement m, turn rad: of one posture as a whole
  not_in_base,         ///< displacement m, turn rad
  reflectors_renamed,  ///< in pairs: what a reflector is called, what it is
  reflector_twice,     ///< two names of one reflector, largest distance m
  reflectors_on_line,  ///< least height of the triangle m, its longest side m

  // Of the load cell and its readings.
  turn_wrench_signs,  ///< columns
  order_of_wrench,    ///< columns, what stands for x, y, z in them
  moments_first,      ///< nothing else
  cell_left_handed,   ///< what stands for x, y, z
  turn_cell,          ///< axis, by which angle, rpy_deg that then is declared (rad), whether the axis is the parent's,
                      ///< the last joint's number
  cell_along_link,    ///< link to whose axes the wrench is parallel
  cell_not_along_link,  ///< link that is declared
  cell_turned_back,     ///< nothing else: the inverse of rpy_deg
  cell_angles_in,       ///< unit
  cell_not_turned,      ///< nothing else
  move_cell,            ///< point that is declared, point that mends, m
  wrench_in,            ///< which: forces, moments, wrenches; unit
  wrench_of_row,        ///< WrenchRow
  wrenches_exchanged,   ///< both postures
  wrenches_repeated,    ///< posture, the one whose wrenches it has
  steps_repeated,       ///< postures, step, the step whose wrench it has
  steps_exchanged,      ///< both steps, whether the points' rather than the wrenches'
  gravity_reversed,     ///< sag in parts of what masses and springs make of it
  step_scale_off,       ///< load step, factor of its wrench against the other steps
  weight_not_tared,     ///< mass kg, mean force N, what it leaves of the unloaded forces N

  // What shows it.
  misses_arm,          ///< rms before, after, m
  group_misses_arm,    ///< the same of one posture or sweep
  stated_pose_misses,  ///< poses of the controller: rms before, after, m
  loads_left,          ///< share left before, after
  off_gravity,         ///< rad before, after
  sag_against_load,    ///< factor before, after
  day_scatters,        ///< before, after: in parts of the declared noise
};

}  // namespace stiffscope::mistakes
