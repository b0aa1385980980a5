#pragma once

namespace stiffscope::toolpath {

enum class RemarkId {
  // Why there are no joint angles, or no load.
  not_reached,            ///< distance left m, angle left rad
  leaves_branch,          ///< joint number, the step it would make rad
  no_feed_direction,      ///< the tool moves along its axis, or not at all
  arm_does_not_rest,      ///< under its own weight
  fewer_than_six_joints,  ///< joints: a pose of a tool is six numbers
};

}  // namespace stiffscope::toolpath
