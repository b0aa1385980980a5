#pragma once

#include "core/robot/kinematics.h"

namespace stiffscope::robot {

struct SpringEquilibrium {
  JointVector angles;    ///< rad
  bool settled = false;  ///< within the change asked for
};

/// Joint angles of an arm on its springs, q + c tau(angles), by fixed-point iteration from q: the deflection
/// is small against the posture, so each step leaves about a hundredth of the last change. Ends where a step
/// changes no angle by `least_change`, rad, or more.
template <class TorqueAt>
SpringEquilibrium springEquilibrium(const JointVector& q, const JointVector& compliance, int most_steps,
                                    double least_change, const TorqueAt& torqueAt) {
  SpringEquilibrium found{q};
  for (int step = 0; step < most_steps && !found.settled; ++step) {
    const JointVector next = q + compliance.cwiseProduct(torqueAt(found.angles));
    found.settled = (next - found.angles).cwiseAbs().maxCoeff() < least_change;
    found.angles = next;
  }
  return found;
}

}  // namespace stiffscope::robot
