#include "core/identification/geometric_stiffness_cost.h"

namespace stiffscope::identification {

std::vector<GeometricStiffnessCost> geometricStiffnessCosts(const Identification& result, Method method) {
  std::vector<GeometricStiffnessCost> costs;
  const MethodResult& solved = result.of(method);
  if (!solved.available) return costs;
  const JointVector& compliance = solved.estimate.compliance;
  const std::vector<JointVector> plain = jointTorques(result.cases);
  const std::vector<JointVector> full = jointTorquesWithGeometricStiffness(solved.geometry, result.cases, compliance);
  for (std::size_t i = 0; i < result.cases.size(); ++i) {
    const LoadCase& load_case = result.cases[i];
    const robot::ArmAxes& axes = jacobianAxes(load_case);
    GeometricStiffnessCost cost;
    double whole = 0.0;
    for (const TargetMove& move : load_case.targets) {
      const Eigen::Vector3d point = jacobianPoint(load_case, move.unloaded, move.loaded);
      cost.at_targets += (pointRows(axes, point, full[i] - plain[i]) * compliance).norm();
      whole += (pointRows(axes, point, full[i]) * compliance).norm();
    }
    if (whole > 0.0) cost.share = cost.at_targets / whole;
    cost.at_targets /= static_cast<double>(load_case.targets.size());
    costs.push_back(cost);
  }
  return costs;
}

}  // namespace stiffscope::identification
