#pragma once

#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope::campaign {

/// A controller's figures of six joints and the URDF's angles: q = M r + o, where row i of M has the sign of joint i on
/// the diagonal and a 1 at the joint whose figure is added (rad). Joints without a reading report q itself.
class JointConvention {
 public:
  explicit JointConvention(const std::vector<JointReading>& readings);

  /// False where different figures would give the same angles: joints added to each other in a circle.
  bool invertible() const;

  /// Of joints that do not report q itself the angle is rounded to 1e-9 deg.
  Vector6d angles(const Vector6d& figures) const;
  Vector6d figures(const Vector6d& angles) const;

  /// Angles of figures of which some may be blank (NaN): what is added of a blank one is of `beside`, figures of the
  /// same moment.
  Vector6d anglesBeside(const Vector6d& figures, const Vector6d& beside) const;

 private:
  Matrix6d matrix_ = Matrix6d::Identity();
  Vector6d offset_ = Vector6d::Zero();
};

/// Turns the controller's figures in all tables that have joint angles into the URDF's angles, and back; nothing where
/// the campaign has no joint readings.
void figuresToAngles(Campaign& campaign);
void anglesToFigures(Campaign& campaign);

}  // namespace stiffscope::campaign
