#include "core/identification/partial_pose.h"

#include "core/identification/estimate.h"

namespace stiffscope::identification {

CaseEquations partialPoseEquations(const LoadCase& load_case, const JointVector& torque) {
  CaseEquations equations;
  const auto rows = static_cast<Eigen::Index>(3 * load_case.targets.size());
  equations.posture = load_case.pose;
  equations.matrix.resize(rows, torque.size());
  equations.right.resize(rows);
  const robot::ArmAxes& axes = jacobianAxes(load_case);
  Eigen::Index row = 0;
  for (const TargetMove& move : load_case.targets) {
    equations.matrix.middleRows<3>(row) = pointRows(axes, jacobianPoint(load_case, move.unloaded, move.loaded), torque);
    equations.right.segment<3>(row) = move.displacement();
    row += 3;
  }
  return equations;
}

StiffnessEstimate partialPose(const std::vector<CaseEquations>& equations, const robot::JointMask& unknown) {
  return partialPose(equations, normalByPosture(equations), unknown);
}

StiffnessEstimate partialPose(const std::vector<CaseEquations>& equations, const std::vector<NormalEquations>& normal,
                              const robot::JointMask& unknown) {
  StiffnessEstimate estimate;
  estimate.identifiable = unknown;
  const NormalEquations sum = sumOf(normal);
  estimate.compliance = solveNormal(sum, unknown);
  estimate.condition = conditionNumber(equations, unknown);
  setScatterOfOneStage(normal, sum, estimate);
  describeResiduals(equations, estimate);
  return estimate;
}

}  // namespace stiffscope::identification
