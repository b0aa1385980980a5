#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/comparison/matched_postures.h"
#include "core/identification/identification.h"

namespace stiffscope::comparison {

/// A number with its standard uncertainty; both are of the number's unit.
struct Uncertain {
  double value = 0.0;
  double sd = 0.0;                              ///< not a number: none can be stated
  double dof = 0.0;                             ///< effective degrees of freedom of sd
  std::optional<double> stated = std::nullopt;  ///< U, where it is stated and not of Student's distribution

  /// U = t sd: 95 %, t of Student's distribution; or as stated. Not a number where sd is.
  double expanded() const;
};

/// Both states solved by one method from the same postures, where enough postures are in both. What the model of
/// joint springs misses is then the same in both: with b = A c + m + e, m the misfit of the machine in these postures,
///
///   c_a - c_b = N^-1 sum A_p^T (b_a,p - b_b,p) = true difference + N^-1 sum A_p^T (e_a,p - e_b,p),
///
/// so that m cancels to first order, as far as it is a displacement that both states add to that of their springs
/// (bearings, links, base). It does not where it acts through the springs themselves (friction and lost motion in the
/// joint that changed). Errors that scale a state's compliances (a load cell's gain) scale their difference.
struct PairedFit {
  explicit PairedFit(int of_joints)
      : joints(static_cast<std::size_t>(of_joints), false),
        before(JointVector::Zero(of_joints)),
        after(before),
        dof_before(before),
        dof_after(before),
        shared_before(before),
        shared_after(before) {}

  bool available = false;
  bool same_postures = false;  ///< false: each state from all of its own postures, and what differs does not cancel
  std::size_t postures = 0;    ///< that both were solved from; those that correspond, where not the same
  robot::JointMask joints;     ///< solved for in both: identifiable in both
  JointVector before, after;   ///< compliances, rad/Nm
  /// How each posture's errors move the compliances, g of StiffnessEstimate, before and after; a posture that only one
  /// state has is zero in the other.
  std::vector<std::array<JointVector, 2>> influences;
  JointVector dof_before, dof_after;  ///< of the scatter, each state's own
  JointVector shared_before, shared_after;

  /// w_b c_b + w_a c_a of one joint and its uncertainty: the scatter between postures, paired,
  ///   sum_p (w_b g_b,p + w_a g_a,p)^2,
  /// in which a misfit of both states cancels as it does in the value (with w_a = -w_b), and the variances of what all
  /// postures of a state share (frames, wrist radii, geometry: `shared_`), of the two states as independent of each
  /// other. They are where both measured their own; states that stand on one and the same sweep get more than is due.
  /// Degrees of freedom: of the scatter the smaller state's where postures are the same, else by Welch and
  /// Satterthwaite; what is shared counts as known.
  Uncertain combination(int joint, double weight_before, double weight_after) const;

  /// c_a - c_b, rad/Nm.
  Uncertain difference(int joint) const { return combination(joint, -1.0, 1.0); }
  /// 1 - c_a / c_b, to first order: the share of the compliance before that the state after no longer has.
  Uncertain shareTaken(int joint) const;
  /// Correlation of the scatter errors of c_b and c_a.
  double correlation(int joint) const;
};

/// Solves both on the postures that correspond where these are at least half of the postures of the state that has
/// fewer, and enough for an uncertainty; else on all postures of each. Complete Pose with one characteristic length
/// (the geometric mean), which else would be a difference of its own. Not available where the method is not in both, or
/// no joint is identifiable in both.
PairedFit pairedFit(const campaign::Campaign& before_campaign, const identification::Identification& before,
                    const campaign::Campaign& after_campaign, const identification::Identification& after,
                    identification::Method method, const MatchedPostures& matched);

/// Holm's (1979) correction of p-values for their number: of the i-th smallest of m, the largest of
/// min(1, (m - k + 1) p_k), k up to i. Entries that are not numbers are no tests and stay.
std::vector<double> holm(const std::vector<double>& p_values);

}  // namespace stiffscope::comparison
