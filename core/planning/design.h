#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/identification/equations.h"
#include "core/planning/candidates.h"

namespace stiffscope::planning {

/// Natural logarithm of the determinant of an information matrix over the joints of the mask; minus infinity
/// where it is singular.
double logDeterminant(const JointMatrix& information, const robot::JointMask& unknown);

/// Standard deviations of the compliances, rad/Nm: roots of the inverse's diagonal; infinite where it is
/// singular, not a number for a joint that is no unknown.
JointVector standardDeviations(const JointMatrix& information, const robot::JointMask& unknown);

/// What a design is judged by; larger is better. Without `reference`: logDeterminant (D-optimal). With it,
/// standard deviations s_j of the compliances that would be welcome: minus the logarithm of the 8-norm of
/// sd_j / s_j, nearly their largest, so that no joint pays for another (D-optimal designs trade a joint that
/// is hard to see for easy ones).
double designValue(const JointMatrix& information, const robot::JointMask& unknown,
                   const std::optional<JointVector>& reference);

/// The same from what a designer of many has at hand: logarithm of the determinant by Cholesky, and minus the
/// logarithm of the 8-norm of sd_j / s_j over the joints of the mask.
double choleskyLogDeterminant(const JointMatrix& matrix);
double balanceOf(const JointVector& sd, const JointVector& reference, const robot::JointMask& unknown);

struct DesignProblem {
  std::vector<JointMatrix> information;  ///< of each candidate
  JointMatrix known;                     ///< of what is measured already
  robot::JointMask unknown;
  /// Which candidates may not be chosen together (too near each other), by rows; and which not at all.
  std::vector<std::vector<char>> excludes;
  std::vector<char> barred;
  std::optional<JointVector> reference;  ///< as in designValue, rad/Nm

  /// Of so many joints: nothing measured, none of them an unknown yet.
  explicit DesignProblem(int joints)
      : known(JointMatrix::Zero(joints, joints)), unknown(static_cast<std::size_t>(joints), false) {}
};

struct ExchangeOptions {
  int starts = 4;                 ///< random ones: exchanges end in a local optimum
  std::vector<std::size_t> from;  ///< one start more, if not empty, before the random ones
  int most_passes = 60;
  std::uint64_t seed = 1;
};

struct Design {
  std::vector<std::size_t> chosen;  ///< in the order in which each next one adds most to the logarithm
  double log_determinant = 0.0;     ///< of `known` and all chosen
  int passes = 0;                   ///< over all starts
};

/// The best choice of `count` candidates by designValue, none twice: exchanges of each chosen one for the
/// candidate that raises it most, until no exchange does. V. V. Fedorov, Theory of Optimal Experiments, 1972,
/// in the form of R. D. Cook and C. J. Nachtsheim, Technometrics 22 (1980) 315. Fewer are chosen where the
/// exclusions leave no more.
Design exchangeDesign(const DesignProblem& problem, int count, const ExchangeOptions& options = {});

/// A random choice that keeps the exclusions.
std::vector<std::size_t> randomDesign(const DesignProblem& problem, int count, std::uint64_t seed);

/// Sum of `known` and of those chosen.
JointMatrix informationOf(const DesignProblem& problem, const std::vector<std::size_t>& chosen);

struct RefineOptions {
  double first_step = 0.35;              ///< rad (20 deg), halved until it is below `last_step`
  double last_step = 0.02;               ///< rad (1 deg): the optimum is flat below
  double least_separation = 0.0;         ///< rad, as in PlanOptions
  std::optional<JointVector> reference;  ///< as in designValue
};

/// Whether two postures are as good as one: no joint apart by `separation` (rad, whole turns aside), pulls
/// the same way. Joint 1 plays no part under a hanging load: it turns everything round the vertical.
bool alike(const PlanningArm& arm, const Candidate& a, const Candidate& b, double separation);

/// Moves one joint of one posture at a time, a step forth or back, wherever that raises designValue, keeps
/// the rules and keeps the postures apart, from each other and from `measured`: coordinate exchange, R. K.
/// Meyer and C. J. Nachtsheim, Technometrics 37 (1995) 60. What a finite list of candidates in that
/// many joints leaves open.
void refineDesign(const PlanningArm& arm, const PostureRules& rules, const JointMatrix& known,
                  const robot::JointMask& unknown, const std::vector<Candidate>& measured, const RefineOptions& options,
                  std::vector<Candidate>& chosen);

/// What random postures give, by the same rules and loads.
struct RandomPostures {
  int postures = 0;
  double log_determinant = 0.0;  ///< mean
  JointVector sd;                ///< median, rad/Nm; not a number where there are no sets
  /// D-efficiency of the plan against them, exp((log det plan - log det random) / unknowns).
  double efficiency = 0.0;
};

/// Over `sets` random choices of `count` candidates that keep the exclusions, `known` counted in; efficiency
/// is left to whoever has a plan.
RandomPostures randomPostures(const DesignProblem& problem, int count, int sets, std::uint64_t seed);

}  // namespace stiffscope::planning
