#include "core/identification/decoupled_partial_pose.h"

#include <algorithm>

namespace stiffscope {

namespace {

JointMask armOf(const JointMask& unknown) {
  return {unknown[0], unknown[1], unknown[2], false, false, false};
}
JointMask wristOf(const JointMask& unknown) {
  return {false, false, false, unknown[3], unknown[4], unknown[5]};
}

}  // namespace

Vector6d solveDecoupled(const NormalEquations& wrist_sum, const NormalEquations& reflector_sum,
                        const JointMask& unknown) {
  const Vector6d arm = solveNormal(wrist_sum, armOf(unknown));
  // A^T (b - A c_arm) = A^T b - (A^T A) c_arm: the arm's model subtracted, (37).
  const NormalEquations rest{reflector_sum.matrix, reflector_sum.right - reflector_sum.matrix * arm};
  return arm + solveNormal(rest, wristOf(unknown));
}

StiffnessEstimate decoupledPartialPose(const std::vector<CaseEquations>& wrist_equations,
                                       const std::vector<CaseEquations>& reflector_equations,
                                       const JointMask& unknown) {
  StiffnessEstimate estimate;
  estimate.identifiable = unknown;
  NormalEquations wrist_sum, reflector_sum;
  for (const CaseEquations& one : wrist_equations) wrist_sum += normalEquations(one);
  for (const CaseEquations& one : reflector_equations) reflector_sum += normalEquations(one);
  estimate.compliance = solveDecoupled(wrist_sum, reflector_sum, unknown);

  // A posture acts on the arm through P_wrist, and on the wrist through its reflectors and through the arm.
  Vector6d arm_only = estimate.compliance;
  arm_only.tail<3>().setZero();
  std::vector<Vector6d> influences;
  for (std::size_t p = 0; p < wrist_equations.size(); ++p) {
    const Vector6d arm = influence(wrist_equations[p], wrist_sum, arm_only, armOf(unknown));
    const Vector6d reflectors =
        influence(reflector_equations[p], reflector_sum, estimate.compliance, wristOf(unknown));
    const Vector6d through_arm =
        solveNormal({reflector_sum.matrix, reflector_sum.matrix * arm}, wristOf(unknown));
    influences.push_back(arm + reflectors - through_arm);
  }
  estimate.covariance = scatterCovariance(influences, unknown);
  estimate.condition = std::max(conditionNumber(wrist_equations, armOf(unknown)),
                                conditionNumber(reflector_equations, wristOf(unknown)));
  describeResiduals(reflector_equations, estimate);
  return estimate;
}

}  // namespace stiffscope
