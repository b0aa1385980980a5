#pragma once

#include "core/planning/design.h"

namespace stiffscope::planning {

/// What random postures give, by the same rules and loads.
struct RandomPostures {
  int postures = 0;
  double log_determinant = 0.0;    ///< mean
  Vector6d sd = Vector6d::Zero();  ///< median, rad/Nm
  /// D-efficiency of the plan against them, exp((log det plan - log det random) / unknowns).
  double efficiency = 0.0;
};

/// Over `sets` random choices of `count` candidates that keep the exclusions, `known` counted in; efficiency
/// is left to whoever has a plan.
RandomPostures randomPostures(const DesignProblem& problem, int count, int sets, std::uint64_t seed);

}  // namespace stiffscope::planning
