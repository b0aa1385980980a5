#include "core/cartesian_stiffness/posture_stiffness.h"

#include "core/statics/geometric_stiffness.h"

namespace stiffscope {

namespace {

/// The campaign's characteristic length; where Complete Pose had no flange poses to find it from, the one by
/// the arm's model.
double lengthOf(const Identification& result, const LoadingGeometry& geometry) {
  if (result.characteristic_length.condition > 0.0) return result.characteristic_length.length;
  std::vector<LoadCase> cases = result.cases;
  for (LoadCase& load_case : cases)
    load_case.flange_unloaded = flangeAt(geometry.arm, unloadedPosture(geometry.arm, load_case));
  return characteristicLength(cases, result.frames.tcp_in_flange).length;
}

}  // namespace

PostureStiffness postureStiffness(const LoadingGeometry& geometry, const StiffnessEstimate& estimate,
                                  const ArmPosture& posture, const Wrench& wrench,
                                  const Eigen::Vector3d& tcp_in_flange, double length) {
  PostureStiffness result;
  const Eigen::Vector3d point = flangeAt(geometry.arm, posture) * tcp_in_flange;
  const Matrix6d jacobian = jacobianAt(geometry.arm, posture, point);
  const ArmAxes axes = axesAt(geometry.arm, posture);
  const Matrix6d geometric =
      geometricStiffness(axes, wrench) + geometricStiffness(axes, posture, geometry.weight);
  result.conditioning = postureConditioning(jacobian, length);
  result.without_kc = cartesianStiffness(point, jacobian, estimate.compliance);
  result.with_kc = cartesianStiffness(point, jacobian, estimate.compliance, geometric);
  result.kc_share = geometricStiffnessShare(result.with_kc, result.without_kc);
  for (int joint = 0; joint < 6; ++joint) {
    if (!estimate.identifiable[static_cast<std::size_t>(joint)]) result.rigid_joints.push_back(joint);
  }
  return result;
}

std::vector<PostureStiffness> postureStiffnesses(const Campaign& campaign, const Identification& result,
                                                 Method method) {
  std::vector<PostureStiffness> postures;
  const MethodResult& solved = result.of(method);
  if (!solved.available || result.cases.empty()) return postures;
  const Eigen::Vector3d& tcp = result.frames.tcp_in_flange;
  const double length = lengthOf(result, solved.geometry);
  for (const LoadCase& load_case : result.cases) {
    postures.push_back(postureStiffness(solved.geometry, solved.estimate,
                                        unloadedPosture(solved.geometry.arm, load_case), load_case.wrench,
                                        tcp, length));
    postures.back().pose = campaign.pose_ids[static_cast<std::size_t>(load_case.pose)];
  }
  return postures;
}

}  // namespace stiffscope
