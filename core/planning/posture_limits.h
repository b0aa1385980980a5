#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "core/campaign/joint_reading.h"
#include "core/robot/robot.h"

namespace stiffscope::planning {

/// What joint angles a person at the robot would keep to, rad.
struct JointRules {
  /// Limits of the joints, as the controller states them; infinite: none, but half a turn either way of the URDF's
  /// angle. Beyond the machine's last joint they play no part.
  JointVector low = JointVector::Constant(kMostJoints, -std::numeric_limits<double>::infinity());
  JointVector high = JointVector::Constant(kMostJoints, std::numeric_limits<double>::infinity());
  double limit_margin = 0.0873;  ///< 5 deg within the URDF's: room for compensation, and URDFs differ from controllers
};

/// The joint angles that postures may have: the URDF's limits less the margin, and the rules' limits on what the
/// controller states. A joint of its own sign or offset has these as limits of its angle. Where another joint's figure
/// is added, a limit on the figure is one on the difference of two angles: the box, as wide as all figures within their
/// limits make it, holds more than they allow, and `hold` is asked of every posture.
class PostureLimits {
 public:
  /// Throws InputError, naming the joint, where the box is empty.
  PostureLimits(const robot::Robot& arm, const std::vector<campaign::JointReading>& readings, const JointRules& rules);

  const PerJoint<robot::JointLimits>& box() const { return box_; }

  /// Whether the controller's figures of angles in the box keep their limits.
  bool hold(const JointVector& q) const;

 private:
  PerJoint<robot::JointLimits> box_;
  std::optional<campaign::JointConvention> convention_;  ///< where the box is more than the figures' limits
  JointVector low_, high_;                               ///< of figures, rad
};

}  // namespace stiffscope::planning
