#include "core/identification/method_solution.h"

#include <utility>

#include "core/identification/arm_normal.h"
#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/partial_pose.h"
#include "core/identification/posture_influence.h"
#include "core/identification/working_noise.h"

namespace stiffscope {

StiffnessEstimate MethodSolution::estimate(const LoadedArm& arm, const PointEquations& equations) const {
  switch (method) {
    case Method::complete_pose:
      return completePose(poseEquations(arm, tcp_in_flange), length, unknown);
    case Method::decoupled_partial_pose:
      return decoupledPartialPose(equations.wrist, equations.reflectors, unknown);
    case Method::partial_pose:
      break;
  }
  const std::vector<NormalEquations> normal = normalByPosture(equations.reflectors);
  StiffnessEstimate estimate = partialPose(equations.reflectors, normal, unknown);
  // With several load steps a posture's rows share step 0: there the plain correction stands.
  const bool one_step = normal.size() == equations.reflectors.size();
  if (tracker != nullptr && one_step) {
    correctForNoise(normal, reflectorNoise(*tracker, arm, equations.reflectors), estimate);
  }
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

StiffnessEstimate MethodSolution::settledEstimate(LoadedArm& arm, bool finite_deflection, PointEquations* equations) const {
  settleArm(arm, finite_deflection, [this](const LoadedArm& now) { return compliance(now); });
  PointEquations settled;
  if (equations != nullptr || method == Method::decoupled_partial_pose) settled.wrist = wristPointEquations(arm);
  if (equations != nullptr || method != Method::complete_pose) settled.reflectors = reflectorEquations(arm);
  StiffnessEstimate estimated = estimate(arm, settled);
  if (equations != nullptr) *equations = std::move(settled);
  return estimated;
}

}  // namespace stiffscope
