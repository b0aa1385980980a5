#include "core/identification/posture_stiffness.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <vector>

#include "core/robot/geometric_stiffness.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::identification {

PostureConditioning postureConditioning(const Jacobian& jacobian, double length) {
  Jacobian normalised = jacobian;
  normalised.topRows<3>() /= length;
  const Eigen::VectorXd singular = singularValues(normalised);
  constexpr double kRounding = 1e-14;  // of the largest: nothing is left of the least
  PostureConditioning result;
  const Eigen::Index last = singular.size() - 1;
  if (singular[last] <= kRounding * singular[0]) {
    result.kappa = result.kappa_two = std::numeric_limits<double>::infinity();
    return result;
  }
  result.kappa = singular.norm() * singular.cwiseInverse().norm() / static_cast<double>(singular.size());
  result.kappa_two = singular[0] / singular[last];
  result.dexterity = 1.0 / result.kappa;
  return result;
}

namespace {

/// The campaign's characteristic length; where Complete Pose had no flange poses to find it from, the one by
/// the arm's model.
double lengthOf(const Identification& result, const frames::LoadingGeometry& geometry) {
  if (result.characteristic_length.condition > 0.0) return result.characteristic_length.length;
  std::vector<LoadCase> cases = result.cases;
  for (LoadCase& load_case : cases)
    load_case.flange_unloaded = robot::flangeAt(geometry.arm, unloadedPosture(geometry.arm, load_case));
  return characteristicLength(cases, result.frames.tcp_in_flange).length;
}

}  // namespace

PostureStiffness postureStiffness(const frames::LoadingGeometry& geometry, const StiffnessEstimate& estimate,
                                  const robot::ArmPosture& posture, const robot::Wrench& wrench,
                                  const Eigen::Vector3d& tcp_in_flange, double length) {
  PostureStiffness result;
  const Eigen::Vector3d point = robot::flangeAt(geometry.arm, posture) * tcp_in_flange;
  const Jacobian jacobian = robot::jacobianAt(geometry.arm, posture, point);
  const robot::ArmAxes axes = robot::axesAt(geometry.arm, posture);
  const JointMatrix geometric =
      robot::geometricStiffness(axes, wrench) + robot::geometricStiffness(axes, posture, geometry.weight);
  result.conditioning = postureConditioning(jacobian, length);
  result.without_kc = robot::cartesianStiffness(point, jacobian, estimate.compliance);
  result.with_kc = robot::cartesianStiffness(point, jacobian, estimate.compliance, geometric);
  result.kc_share = robot::geometricStiffnessShare(result.with_kc, result.without_kc);
  for (int joint = 0; joint < estimate.joints(); ++joint) {
    if (!estimate.identifiable[static_cast<std::size_t>(joint)]) result.rigid_joints.push_back(joint);
  }
  return result;
}

PostureStiffnesses::PostureStiffnesses(const campaign::Campaign& campaign, const Identification& result, Method method)
    : campaign_(campaign),
      result_(result),
      solved_(result.of(method)),
      size_(solved_.available ? result.cases.size() : 0) {
  if (size_ > 0) length_ = lengthOf(result, solved_.geometry);
}

PostureStiffness PostureStiffnesses::at(std::size_t load_case) const {
  const LoadCase& one = result_.cases[load_case];
  PostureStiffness posture =
      postureStiffness(solved_.geometry, solved_.estimate, unloadedPosture(solved_.geometry.arm, one), one.wrench,
                       result_.frames.tcp_in_flange, length_);
  posture.pose = campaign_.pose_ids[static_cast<std::size_t>(one.pose)];
  return posture;
}

std::size_t postureCount(const Identification& result) {
  std::vector<int> poses;
  poses.reserve(result.cases.size());
  for (const LoadCase& one : result.cases) poses.push_back(one.pose);
  std::sort(poses.begin(), poses.end());
  return static_cast<std::size_t>(std::unique(poses.begin(), poses.end()) - poses.begin());
}

}  // namespace stiffscope::identification
