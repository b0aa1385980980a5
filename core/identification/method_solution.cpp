#include "core/identification/method_solution.h"

#include "core/identification/arm_normal.h"
#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/partial_pose.h"
#include "core/identification/posture_influence.h"
#include "core/identification/working_noise.h"

namespace stiffscope {

StiffnessEstimate MethodSolution::estimate(const LoadedArm& arm) const {
  switch (method) {
    case Method::complete_pose:
      return completePose(poseEquations(arm, tcp_in_flange), length, unknown);
    case Method::decoupled_partial_pose:
      return decoupledPartialPose(wristPointEquations(arm), reflectorEquations(arm), unknown);
    case Method::partial_pose:
      break;
  }
  const std::vector<CaseEquations> equations = reflectorEquations(arm);
  StiffnessEstimate estimate = partialPose(equations, unknown);
  const std::vector<NormalEquations> normal = normalByPosture(equations);
  // With several load steps a posture's rows share step 0: there the plain correction stands.
  const bool one_step = normal.size() == equations.size();
  if (tracker != nullptr && one_step) correctForNoise(normal, reflectorNoise(*tracker, arm, equations), estimate);
  return estimate;
}

Vector6d MethodSolution::compliance(const LoadedArm& arm) const {
  switch (method) {
    case Method::complete_pose:
      return solveNormal(poseNormal(arm, tcp_in_flange).at(length), unknown);
    case Method::decoupled_partial_pose:
      return solveDecoupled(wristNormal(arm), reflectorNormal(arm), unknown);
    case Method::partial_pose:
      break;
  }
  return solveNormal(reflectorNormal(arm), unknown);
}

Vector6d MethodSolution::settledCompliance(LoadedArm& arm, bool finite_deflection) const {
  settleArm(arm, finite_deflection, [this](const LoadedArm& now) { return compliance(now); });
  return compliance(arm);
}

StiffnessEstimate MethodSolution::settledEstimate(LoadedArm& arm, bool finite_deflection) const {
  settleArm(arm, finite_deflection, [this](const LoadedArm& now) { return compliance(now); });
  return estimate(arm);
}

}  // namespace stiffscope
