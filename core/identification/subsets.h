#pragma once

#include <cstdint>
#include <vector>

#include "core/identification/compensated_share.h"
#include "core/identification/equations.h"

namespace stiffscope::identification {

/// How to draw m of n postures.
struct SubsetOptions {
  int size = 0;                      ///< m; 0: the paper's share, 10 of 19, rounded
  std::uint64_t most_all = 250'000;  ///< all subsets up to this many, beyond it a sample
  std::uint64_t sample = 20'000;     ///< subsets drawn beyond it (fewer for very many postures)
  std::uint64_t seed = 1;            ///< of that sample
};

/// What a method needs to be solved on a subset of postures.
struct SubsetMethod {
  std::vector<NormalEquations> normal;      ///< a posture each; for the decoupled method those of P_wrist
  std::vector<NormalEquations> reflectors;  ///< only the decoupled method: those of the reflectors
  robot::JointMask unknown{};
  DeflectionJudge at_wrist;  ///< empty where P_wrist is not measured
  DeflectionJudge at_targets;
};

/// Mean compensated fraction over the subsets.
struct SubsetCompensation {
  double used = 0.0, held_out = 0.0, all = 0.0;
};

/// A method judged at one kind of point over the subsets.
struct SubsetJudgement {
  SubsetCompensation compensated;
  /// Per posture: what is left of its displacement (sum over its points, m), mean over the subsets that leave
  /// it out.
  std::vector<double> left_held_out;
};

struct SubsetStudy {
  int size = 0;                       ///< m
  int of = 0;                         ///< n
  bool every_subset = false;          ///< false: a sample
  std::vector<Vector6d> compliances;  ///< one a subset, in a fixed order
  SubsetJudgement at_wrist, at_targets;
};

/// Solves the method on every subset (or a sample) from per-posture normal equations and judges each result
/// on the postures used, those held out, and all. Results do not depend on the number of threads.
SubsetStudy studySubsets(const SubsetMethod& method, const SubsetOptions& options = {});

/// Solves the method from the sums of the equations of the postures that take part; `reflectors` only for the decoupled
/// method.
Vector6d solveSubset(const SubsetMethod& method, const NormalEquations& normal, const NormalEquations& reflectors);

/// The distribution of one joint's stiffness over the subsets: Table II.
struct StiffnessSpread {
  double mean = 0.0, sd = 0.0;  ///< of k = 1/c, the paper's; heavy-tailed where c comes near zero
  double median = 0.0;
  double low = 0.0, high = 0.0;  ///< 5 % and 95 % quantiles
  double quartile_low = 0.0, quartile_high = 0.0;
  double compliance_mean = 0.0, compliance_sd = 0.0;
  double share_negative = 0.0;
};

StiffnessSpread spreadOf(const SubsetStudy& study, int joint);

}  // namespace stiffscope::identification
