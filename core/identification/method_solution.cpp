#include "core/identification/method_solution.h"

#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/partial_pose.h"
#include "core/identification/posture_influence.h"
#include "core/identification/working_noise.h"

namespace stiffscope {

namespace {

NormalEquations sumOf(const std::vector<CaseEquations>& equations) {
  NormalEquations sum;
  for (const CaseEquations& one : equations) sum += normalEquations(one);
  return sum;
}

}  // namespace

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
  // With several load steps a posture's rows share step 0: there the plain correction stands.
  const bool one_step = byPosture(equations).size() == equations.size();
  if (tracker != nullptr && one_step) correctForNoise(equations, reflectorNoise(*tracker, arm), estimate);
  return estimate;
}

Vector6d MethodSolution::compliance(const LoadedArm& arm) const {
  switch (method) {
    case Method::complete_pose: {
      NormalEquations sum;
      for (const CaseEquations& one : poseEquations(arm, tcp_in_flange)) sum += normalEquations(normalised(one, length));
      return solveNormal(sum, unknown);
    }
    case Method::decoupled_partial_pose:
      return solveDecoupled(sumOf(wristPointEquations(arm)), sumOf(reflectorEquations(arm)), unknown);
    case Method::partial_pose:
      break;
  }
  return solveNormal(sumOf(reflectorEquations(arm)), unknown);
}

std::vector<NormalEquations> normalByPosture(const std::vector<CaseEquations>& equations) {
  std::vector<NormalEquations> normal;
  for (const CaseEquations& one : byPosture(equations)) normal.push_back(normalEquations(one));
  return normal;
}

}  // namespace stiffscope
