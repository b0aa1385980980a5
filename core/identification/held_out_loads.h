#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/identification/identification.h"

namespace stiffscope::identification {

/// Where a force pulls: along gravity or against it, away from axis 1 or towards it, or round it, by its largest part.
enum class LoadDirection { down, up, outward, inward, sideways };
inline constexpr std::size_t kLoadDirections = 5;

/// `force` at `point`, R0, N and m; axis 1 runs along z of R0 through its origin.
LoadDirection directionOf(const Eigen::Vector3d& force, const Eigen::Vector3d& point, const Eigen::Vector3d& gravity);

/// Loads that took no part, predicted from the others.
struct HeldOutLoad {
  std::optional<int> step;                 ///< of a level: the load step
  std::optional<LoadDirection> direction;  ///< else of a direction
  int states = 0;
  double mean_force = 0.0;             ///< N
  std::optional<double> at_wrist;      ///< share of the deflection compensated; empty where P_wrist is not measured
  std::optional<double> at_targets;    ///< the same of the reflectors
  robot::JointMask not_by_the_others;  ///< joints that these loads turn and the others do not: taken as stiff
};

/// How far stiffnesses of some loads hold under others: shares 1 - sum |left| / sum |displacement|, as on held-out
/// postures (docs/method.md), in the frames and the geometry of `result`.
///
/// Levels: each load step but returns to zero by the steps of `result` without it; where that leaves none there is no
/// entry. Directions: of the steps of `result`, each direction with three states or more by the other directions; none
/// where all loads pull alike.
///
/// Of a day of more than preparation::kMostAveraged postures, so many of each load step, spread evenly, and a fifth of
/// that of each direction at least, or all there are: a mean over them is within a few thousandths of that of all.
struct HeldOutLoads {
  std::array<std::vector<HeldOutLoad>, 3> levels, directions;  ///< by Method
  std::array<int, kLoadDirections> states{};                   ///< of the steps of `result`, by direction
};

/// `result` from `campaign`. `as_read`: the same day before effects were taken off its readings, whose displacements
/// the shares are of; effects of the model are fitted to all loads.
HeldOutLoads heldOutLoads(const campaign::Campaign& campaign, const campaign::Campaign& as_read,
                          const IdentifyOptions& options, const Identification& result);

}  // namespace stiffscope::identification
