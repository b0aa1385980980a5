#pragma once

namespace stiffscope::compensation {

enum class RemarkId {
  // Why there are no commands.
  unloaded_arm_does_not_rest,
  loaded_arm_does_not_rest,
  posture_outside_limits,     ///< joint number, its angle rad, lower limit rad, upper limit rad
  command_outside_limits,     ///< joint number, the angle to command rad, lower limit rad, upper limit rad
  near_singularity,           ///< conditioning, least conditioning
  turns_joint_of_negative_k,  ///< joint number, torque Nm
  turns_joint_of_unknown_k,   ///< joint number, torque Nm
  steps_do_not_converge,
  // What commands are not to be believed.
  implausible_command,  ///< posture, joint number, turn rad
};

}  // namespace stiffscope::compensation
