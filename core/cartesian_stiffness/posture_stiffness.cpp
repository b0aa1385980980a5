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

PostureStiffnesses::PostureStiffnesses(const Campaign& campaign, const Identification& result, Method method)
    : campaign_(campaign), result_(result), solved_(result.of(method)), size_(solved_.available ? result.cases.size() : 0) {
  if (size_ > 0) length_ = lengthOf(result, solved_.geometry);
}

PostureStiffness PostureStiffnesses::at(std::size_t load_case) const {
  const LoadCase& one = result_.cases[load_case];
  PostureStiffness posture = postureStiffness(solved_.geometry, solved_.estimate, unloadedPosture(solved_.geometry.arm, one),
                                              one.wrench, result_.frames.tcp_in_flange, length_);
  posture.pose = campaign_.pose_ids[static_cast<std::size_t>(one.pose)];
  return posture;
}

}  // namespace stiffscope
