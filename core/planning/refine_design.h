#pragma once

#include <vector>

#include "core/planning/candidates.h"
#include "core/planning/exchange_design.h"

namespace stiffscope {

struct RefineOptions {
  double first_step = 0.35;           ///< rad (20 deg), halved until it is below `last_step`
  double last_step = 0.02;            ///< rad (1 deg): the optimum is flat below
  double least_separation = 0.0;      ///< rad, as in PlanOptions
  std::optional<Vector6d> reference;  ///< as in designValue
};

/// Whether two postures are as good as one: no joint apart by `separation` (rad, whole turns aside), pulls
/// the same way. Joint 1 plays no part under a hanging load: it turns everything round the vertical.
bool alike(const PlanningArm& arm, const Candidate& a, const Candidate& b, double separation);

/// Moves one joint of one posture at a time, a step forth or back, wherever that raises designValue, keeps
/// the rules and keeps the postures apart, from each other and from `measured`: coordinate exchange, R. K.
/// Meyer and C. J. Nachtsheim, Technometrics 37 (1995) 60. What a finite list of candidates in six joints
/// leaves open.
void refineDesign(const PlanningArm& arm, const PostureRules& rules, const Matrix6d& known,
                  const JointMask& unknown, const std::vector<Candidate>& measured,
                  const RefineOptions& options, std::vector<Candidate>& chosen);

}  // namespace stiffscope
