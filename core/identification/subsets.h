#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/identification/equations.h"
#include "core/identification/estimate.h"
#include "core/robot/robot.h"

namespace stiffscope::identification {

/// Equations b = A c of some points, three rows each, laid out so that all residuals of a block are computed at once: a
/// coordinate of all points stands together. Points that are not there have zeros.
struct alignas(64) PointBlock {
  static constexpr std::size_t kPoints = 8;
  double matrix[3][kMostJoints][kPoints] = {};  ///< A by coordinate, joint and point
  double right[3][kPoints] = {};                ///< b by coordinate and point, m
};

/// |b - A c| of each point, m; `norms`: kPoints a block. The same numbers with wide registers and without.
void residualNorms(std::span<const PointBlock> blocks, const JointVector& compliance, std::span<double> norms);

/// How much of the deflection a model takes away at some points: 1 - sum |residual| / sum |displacement|,
/// over postures (docs/method.md, What every method reports). Prepared for many evaluations.
class DeflectionJudge {
 public:
  DeflectionJudge() = default;
  /// `equations`: one a posture, three rows a point, positions only.
  explicit DeflectionJudge(const std::vector<CaseEquations>& equations);
  /// As of byPosture(equations) (estimate.h), without a copy of them.
  static DeflectionJudge byPosture(const std::vector<CaseEquations>& equations);

  std::size_t postures() const { return displacement_.size(); }

  /// Per posture: sum over its points of |displacement|, m.
  const std::vector<double>& displacement() const { return displacement_; }

  /// Per posture: sum over its points of |b - A c|, m.
  std::vector<double> residual(const JointVector& compliance) const;
  /// The same of some compliances, for each into its vector: quicker than one by one.
  void residuals(std::span<const JointVector> compliances, std::span<std::vector<double>* const> per_posture) const;

  /// Over all postures.
  double compensated(const JointVector& compliance) const;

  /// Points of a posture, for turning sums into means.
  int pointsOf(std::size_t posture) const { return points_[posture]; }

 private:
  /// `first`: of the equations of each posture, the first.
  DeflectionJudge(const std::vector<CaseEquations>& equations, const std::vector<std::size_t>& first);
  void addResidual(std::size_t from_block, std::size_t blocks, const JointVector& compliance,
                   std::vector<double>& per_posture) const;

  std::vector<PointBlock> blocks_;  // its points in the order of the equations
  std::vector<std::size_t> posture_of_point_;
  std::vector<int> points_;
  std::vector<double> displacement_;
};

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
  robot::JointMask unknown;
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
  /// One a subset, in the order of SubsetStudy::compliances: the fraction compensated on the postures it leaves out.
  std::vector<double> held_out;
  /// Per posture: what is left of its displacement (sum over its points, m), mean over the subsets that leave
  /// it out.
  std::vector<double> left_held_out;
};

struct SubsetStudy {
  int size = 0;                          ///< m
  int of = 0;                            ///< n
  bool every_subset = false;             ///< false: a sample
  std::vector<JointVector> compliances;  ///< one a subset, in a fixed order
  SubsetJudgement at_wrist, at_targets;
};

/// Solves the method on every subset (or a sample) from per-posture normal equations and judges each result
/// on the postures used, those held out, and all. Results do not depend on the number of threads.
SubsetStudy studySubsets(const SubsetMethod& method, const SubsetOptions& options = {});

/// Solves the method from the sums of the equations of the postures that take part; `reflectors` only for the decoupled
/// method.
JointVector solveSubset(const SubsetMethod& method, const NormalEquations& normal, const NormalEquations& reflectors);

/// A mean over subsets with the standard deviation of single subsets about it; NaN of fewer than two subsets. Of
/// subsets of half the postures the deviation is near the standard uncertainty of the mean by the choice of postures
/// (delete-d jackknife, Shao and Wu 1989).
struct MeanOverSubsets {
  double mean = std::numeric_limits<double>::quiet_NaN(), sd = std::numeric_limits<double>::quiet_NaN();
};

MeanOverSubsets meanOverSubsets(std::span<const double> values);

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

/// Postures drawn with replacement, as many as there are, and the method solved on each draw (Efron): a second way to
/// the spread of the compliances, which knows no normal distribution, no Student's t and no shared errors.
struct PostureBootstrap {
  std::vector<JointVector> compliances;  ///< one a draw, in the order of the draws

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
