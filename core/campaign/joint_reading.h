#pragma once

#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope::campaign {

/// A controller's figures of a machine's joints and the URDF's angles: q = M r + o, where row i of M has the sign of
/// joint i on the diagonal and a 1 at the joint whose figure is added (rad). Joints without a reading report q itself.
class JointConvention {
 public:
  JointConvention(const std::vector<JointReading>& readings, int joints);

  /// False where different figures would give the same angles: joints added to each other in a circle.
  bool invertible() const;

  /// Of joints that do not report q itself the angle is rounded to 1e-9 deg.
  JointVector angles(const JointVector& figures) const;
  JointVector figures(const JointVector& angles) const;

  /// Angles of figures of which some may be blank (NaN): what is added of a blank one is of `beside`, figures of the
  /// same moment.
  JointVector anglesBeside(const JointVector& figures, const JointVector& beside) const;

 private:
  JointMatrix matrix_;
  JointVector offset_;
};

/// Turns the controller's figures in all tables that have joint angles into the URDF's angles, and back; nothing where
/// the campaign has no joint readings.
void figuresToAngles(Campaign& campaign);
void anglesToFigures(Campaign& campaign);

}  // namespace stiffscope::campaign
