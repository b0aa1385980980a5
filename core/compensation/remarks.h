#pragma once

namespace stiffscope::compensation {

enum class RemarkId {
  // Why there are no commands.
  unloaded_arm_does_not_rest,
  loaded_arm_does_not_rest,
  posture_outside_limits,     ///< joint number, its angle rad, lower limit rad, upper limit rad
  command_outside_limits,     ///< joint number, the angle to command rad, lower limit rad, upper limit rad
  follower_outside_limits,    ///< name of an axis that follows others, its angle, lower and upper limit, rad
  balancer_outside_stroke,    ///< number of the balancer, its length m
  near_singularity,           ///< conditioning, least conditioning
  turns_joint_of_negative_k,  ///< joint number, torque Nm
  turns_joint_of_unknown_k,   ///< joint number, torque Nm
  steps_do_not_converge,
  load_far_beyond,      ///< load over the largest that identified, most that is predicted
  posture_far_beyond,   ///< joint number, its angle, least and largest angle that identified, rad; most beyond, rad
  uncertainty_unknown,  ///< too few postures
  uncertain_as_itself,  ///< U of the deflection of P_TCP m, its size m
  // What to know of a posture with commands.
  load_beyond,     ///< load over the largest that identified
  torque_beyond,   ///< joint number, its torque by the load Nm, the largest that identified Nm
  posture_beyond,  ///< joint number, its angle, least and largest angle that identified, rad
  uncertain,       ///< U of the deflection of P_TCP m, its size m
  turn_left,       ///< angle that the commands leave of the flange's turn rad, about x0, y0, z0 rad
  // What to know of all commands for a machine that has not six joints.
  position_first,  ///< joints, fewer than six
  least_turns,     ///< joints, more than six
  // What commands are not to be believed.
  implausible_command,  ///< posture, joint number, turn rad
};

}  // namespace stiffscope::compensation
