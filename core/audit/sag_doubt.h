#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/audit/audit_input.h"

// The sweeps are judged with the own weight's sag taken off, by springs that the loads show no better than their size
// allows. What of a misfit is a sag that is off by as much as it is uncertain, is no fault of the sweeps.

namespace stiffscope::audit {

/// The sweeps measured once more, each time with the compliances off by one standard uncertainty in another direction
/// of their covariance, so that the changes are independent of each other. Of the inputs campaign, noise, frames and
/// rigid are there, no more. Empty where no sag was taken off.
///
/// Springs that the loads give have the covariance of their identification, widened as Student's t is for as few
/// postures, and the stated uncertainty of the masses; springs that they do not give, and all where the loads
/// contradict the model, turn by frames::kTurnByOwnWeight.
std::vector<AuditInput> underOtherSags(const AuditInput& input);

/// Of the sum of squares of `left`, residuals in parts of the noise, what u takes off in min |left + D u|^2 + |u|^2, D
/// the changes from `left` to each of `moved`: the residuals under other sags. What remains is chi-square with as many
/// degrees of freedom as before, since each number u that is found is known beforehand as well.
double explainedBySag(const Eigen::VectorXd& left, const std::vector<Eigen::VectorXd>& moved);

}  // namespace stiffscope::audit
