#include "core/identification/describe_loads.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/identification/best_method.h"

namespace stiffscope {

double geometricStiffnessShare(const LoadedArm& arm, const Vector6d& compliance) {
  const auto plain = jointTorques(arm.cases);
  const auto full = jointTorquesWithGeometricStiffness(arm.geometry, arm.cases, compliance);
  double change = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    change += (full[i] - plain[i]).squaredNorm();
    whole += plain[i].squaredNorm();
  }
  return whole > 0.0 ? std::sqrt(change / whole) : 0.0;
}

void describeLoads(const Campaign& campaign, LoadedArm shown, Identification& result) {
  for (const WristMove& move : shown.wrist) result.wrist_displacement.push_back(move.displacement().norm());
  for (const LoadCase& load_case : shown.cases) {
    double sum = 0.0;
    for (const TargetMove& move : load_case.targets) sum += move.displacement().norm();
    result.target_displacement.push_back(sum / static_cast<double>(load_case.targets.size()));
    result.servo_change = std::max(result.servo_change, load_case.servo.cwiseAbs().maxCoeff());
  }
  result.noise = noiseShare(campaign, shown.geometry, shown.cases, shown.wrist, result.frames.wrist.radii,
                            result.frames.wrist.centre_at_zero_in_r0);
  const MethodResult& reference = result.of(bestMethod(result));
  if (reference.available) {
    result.geometric_stiffness_share = geometricStiffnessShare(shown, reference.estimate.compliance);
  }
  result.cases = std::move(shown.cases);
  result.wrist = std::move(shown.wrist);
}

}  // namespace stiffscope
