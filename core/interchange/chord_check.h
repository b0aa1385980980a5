#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope::interchange {

/// Where a reflector was read while the controller stated these figures.
struct PlacedReading {
  Vector6d figures = Vector6d::Zero();  ///< rad, as the controller states them
  int target = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m
};

/// How far distances between a reflector's places are from those of the nominal arm: root mean square of
/// |T_k c - T_l c| - s |p_k - p_l| over pairs of postures k, l, where T is base_from_flange and c the reflector on the
/// flange, fitted for each. No frame enters, so it judges figures, units and which readings belong to which posture
/// before anything else is known. nullopt where no reflector was read in six postures.
std::optional<double> chordMisfit(const robot::Robot& robot, const std::vector<campaign::JointReading>& convention,
                                  const std::vector<PlacedReading>& readings, double scale = 1.0);

/// What else the figures or the points could mean.
struct OtherMeaning {
  enum class Kind { sign, coupling, offset, unit };
  Kind kind = Kind::sign;
  int joint = 0;        ///< 0..5, of the first three kinds
  int plus = -1;        ///< 0..5, of a coupling
  double value = 0.0;   ///< sign; offset, rad; or the factor that points are to be multiplied by
  double misfit = 0.0;  ///< m
};

/// Tries each joint's other sign, each joint plus or without the one before it, offsets of a quarter and half a turn,
/// and other units of length, one at a time. Returns the one that fits best and those that fit as well (up to twice its
/// misfit), best first: of a spherical wrist the other sign of joint 5 is half a turn of joint 4. Empty where no
/// reflector was read in six postures.
std::vector<OtherMeaning> otherMeanings(const robot::Robot& robot,
                                        const std::vector<campaign::JointReading>& convention,
                                        const std::vector<PlacedReading>& readings);

}  // namespace stiffscope::interchange
