#pragma once

#include <optional>

#include "core/identification/identify.h"

namespace stiffscope {

/// The equations of one method in its own geometry, a posture each, at known compliances (K_c, middle posture).
struct MethodRows {
  std::vector<CaseEquations> solved;   ///< what the method solves first: pose (normalised), reflectors, P_wrist
  std::vector<CaseEquations> targets;  ///< the reflectors', which the decoupled method solves second
  std::vector<CaseEquations> wrist;    ///< P_wrist's; empty where not measured
};

/// Of `method` in `result`, whose frames, length and compliances stand, from the readings of `campaign`.
MethodRows methodRows(const Campaign& campaign, const Identification& result, Method method);

/// rows + sum_k step_k (moved_k - rows): equations that change with further parameters, to first order. All must have the
/// same postures and points.
class MovingRows {
 public:
  MovingRows(MethodRows at, std::vector<MethodRows> moved);

  /// False where a moved campaign does not have the same postures and points: then nothing moves.
  bool movable() const { return movable_; }
  std::size_t postures() const { return at_.targets.size(); }
  MethodRows at(const Eigen::VectorXd& steps) const;

 private:
  MethodRows at_;
  std::vector<MethodRows> moved_;  ///< less `at_`
  bool movable_ = true;
};

}  // namespace stiffscope
