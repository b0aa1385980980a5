#pragma once

#include "core/identification/estimate.h"
#include "core/identification/subsets.h"

namespace stiffscope::identification {

/// Postures drawn with replacement, as many as there are, and the method solved on each draw (Efron): a second way to
/// the spread of the compliances, which knows no normal distribution, no Student's t and no shared errors.
struct PostureBootstrap {
  std::vector<Vector6d> compliances;  ///< one a draw, in the order of the draws

  /// Percentile interval of a joint's compliance.
  CoverageInterval compliance(int joint, double coverage = kStatedCoverage) const;
  CoverageInterval stiffness(int joint, double coverage = kStatedCoverage) const {
    return stiffnessInterval(compliance(joint, coverage));
  }
};

struct PostureBootstrapOptions {
  int draws = 0;  ///< 0: none
  std::uint64_t seed = 1;
};

/// Draw i is seeded by (seed, i), so that the draws can be shared among all cores.
PostureBootstrap bootstrapPostures(const SubsetMethod& method, const PostureBootstrapOptions& options);

}  // namespace stiffscope::identification
