#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/calibration/held_out.h"

namespace stiffscope::calibration {

/// How well the fullest model predicts held-out postures from the reported joint angles and from the commanded ones. A
/// smaller model would judge by what it lacks, which is often larger than the difference of the angles.
struct AngleComparison {
  std::array<bool, 6> joints{};  ///< which have commanded angles in every unloaded posture
  double largest = 0.0;          ///< largest difference between the two, rad
  PositionErrors reported, commanded;
  /// Mean over the postures of how much larger the squared error with the reported angles is, over its own standard
  /// uncertainty: positive where the commanded ones fit better.
  double significance = 0.0;
  std::optional<JointAngles> better;  ///< empty: chance could have made the difference
};

/// The largest difference of the two kinds of angles in unloaded postures, rad; 0 where no joint has commanded ones.
double largestDifference(const campaign::Campaign& campaign);

/// What a calibration by one kind of angles makes of the day's readings, in their order.
struct HeldOutReadings {
  const std::vector<double>& weights;             ///< 0: rejected
  const std::vector<Eigen::Vector3d>& residuals;  ///< of the fullest model, held out; not a number: not predicted, m
};

/// A reading that both reject is left out. Neither `joints` nor `largest` is filled.
AngleComparison compareAngles(const UnloadedDay& day, const HeldOutReadings& reported,
                              const HeldOutReadings& commanded);

}  // namespace stiffscope::calibration
