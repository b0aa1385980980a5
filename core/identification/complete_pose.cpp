#include "core/identification/complete_pose.h"

#include <algorithm>

#include "core/identification/estimate.h"
#include "core/numerics/parallel.h"
#include "core/robot/kinematics.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::identification {

CaseEquations completePoseEquations(const LoadCase& load_case, const Eigen::Vector3d& tcp_in_flange,
                                    const JointVector& torque) {
  const Eigen::Isometry3d &before = *load_case.flange_unloaded, &after = *load_case.flange_loaded;
  const Eigen::AngleAxisd rotation(after.linear() * before.linear().transpose());
  const Eigen::Vector3d unloaded = before * tcp_in_flange, loaded = after * tcp_in_flange;
  CaseEquations equations;
  equations.matrix =
      robot::jacobianAt(jacobianAxes(load_case), jacobianPoint(load_case, unloaded, loaded)) * torque.asDiagonal();
  equations.posture = load_case.pose;
  equations.right.resize(6);
  equations.right << loaded - unloaded, rotation.angle() * rotation.axis();
  return equations;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> poseByReflectors(const frames::LoadingGeometry& geometry,
                                                          const LoadCase& load_case,
                                                          const Eigen::Vector3d& tcp_in_flange) {
  using metrology::crossMatrix;
  const auto known = [&](const TargetMove& move) {
    return geometry.targets_at_zero[static_cast<std::size_t>(move.target)].has_value();
  };
  const auto middle = [](const TargetMove& move) -> Eigen::Vector3d { return 0.5 * (move.unloaded + move.loaded); };
  const auto count = static_cast<double>(std::count_if(load_case.targets.begin(), load_case.targets.end(), known));
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const TargetMove& move : load_case.targets) {
    if (known(move)) centre += middle(move) / count;
  }
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const TargetMove& move : load_case.targets) {
    const Eigen::Matrix3d arm = crossMatrix(middle(move) - centre);
    if (known(move)) inertia -= arm * arm;
  }
  const Eigen::Matrix3d inverse = inertia.inverse();
  const Eigen::Vector3d tcp =
      0.5 * (*load_case.flange_unloaded * tcp_in_flange + *load_case.flange_loaded * tcp_in_flange);
  Eigen::Matrix<double, 6, Eigen::Dynamic> map =
      Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, static_cast<Eigen::Index>(3 * load_case.targets.size()));
  Eigen::Index at = 0;
  for (const TargetMove& move : load_case.targets) {
    if (known(move)) {
      const Eigen::Matrix3d rotation = inverse * crossMatrix(middle(move) - centre);
      map.block<3, 3>(0, at) = Eigen::Matrix3d::Identity() / count - crossMatrix(tcp - centre) * rotation;
      map.block<3, 3>(3, at) = rotation;
    }
    at += 3;
  }
  return map;
}

CaseEquations normalised(const CaseEquations& pose_equations, double characteristic_length) {
  CaseEquations scaled = pose_equations;
  scaled.matrix.topRows<3>() /= characteristic_length;
  scaled.right.head<3>() /= characteristic_length;
  return scaled;
}

StiffnessEstimate completePose(const std::vector<CaseEquations>& pose_equations, double characteristic_length,
                               const robot::JointMask& unknown) {
  StiffnessEstimate estimate;
  estimate.identifiable = unknown;
  std::vector<CaseEquations> scaled(pose_equations.size()), displacements(pose_equations.size());
  numerics::smallWorkOnAllCores(pose_equations.size(), [&](std::size_t i) {
    const CaseEquations& one = pose_equations[i];
    scaled[i] = normalised(one, characteristic_length);
    displacements[i] = {one.matrix.topRows<3>(), one.right.head<3>(), one.posture};
  });
  const std::vector<NormalEquations> normal = normalByPosture(scaled);
  const NormalEquations sum = sumOf(normal);
  estimate.compliance = solveNormal(sum, unknown);
  estimate.condition = conditionNumber(scaled, unknown);
  setScatterOfOneStage(normal, sum, estimate);
  describeResiduals(displacements, estimate);
  return estimate;
}

void PoseNormal::add(const CaseEquations& pose_equations) {
  displacements.add(pose_equations.matrix.topRows<3>(), pose_equations.right.head<3>());
  rotations.add(pose_equations.matrix.bottomRows<3>(), pose_equations.right.tail<3>());
}

PoseNormal& PoseNormal::operator+=(const PoseNormal& other) {
  displacements += other.displacements;
  rotations += other.rotations;
  return *this;
}

NormalEquations PoseNormal::at(double characteristic_length) const {
  const double weight = 1.0 / (characteristic_length * characteristic_length);
  NormalEquations sum;
  sum.matrix = weight * displacements.matrix + rotations.matrix;
  sum.right = weight * displacements.right + rotations.right;
  return sum;
}

}  // namespace stiffscope::identification
