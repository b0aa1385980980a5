#include "core/identification/decoupled_partial_pose.h"

#include <algorithm>

#include "core/identification/estimate.h"
#include "core/numerics/parallel.h"

namespace stiffscope::identification {

namespace {

Eigen::Index armOf(const JointVector& compliance) { return robot::armJointsOf(static_cast<int>(compliance.size())); }

/// Sums of lengths, m.
struct LeakSums {
  double leak = 0.0, whole = 0.0;

  LeakSums& operator+=(const LeakSums& other) {
    leak += other.leak;
    whole += other.whole;
    return *this;
  }
};

}  // namespace

double wristLeak(const LoadedArm& arm, const Eigen::Vector3d& centre_at_zero, const JointVector& compliance) {
  JointVector wrist_only = compliance;
  wrist_only.head(armOf(compliance)).setZero();
  const auto sums = numerics::sumInBlocks<LeakSums>(arm.wrist.size(), [&](std::size_t i, LeakSums& sum) {
    // The wrist centre where the arm's geometry has it, so that only the axes' miss counts.
    const Eigen::Vector3d centre = modelledWrist(arm.geometry.arm, arm.cases[i], centre_at_zero);
    sum.leak += (pointRows(jacobianAxes(arm.cases[i]), centre, arm.torques[i]) * wrist_only).norm();
    sum.whole += arm.wrist[i].displacement().norm();
  });
  return sums.whole > 0.0 ? sums.leak / sums.whole : 0.0;
}

namespace {

robot::JointMask armOf(robot::JointMask unknown) {
  const auto arm = static_cast<std::size_t>(robot::armJointsOf(static_cast<int>(unknown.size())));
  std::fill(unknown.begin() + arm, unknown.end(), false);
  return unknown;
}
robot::JointMask wristOf(robot::JointMask unknown) {
  const auto arm = static_cast<std::size_t>(robot::armJointsOf(static_cast<int>(unknown.size())));
  std::fill(unknown.begin(), unknown.begin() + arm, false);
  return unknown;
}

JointVector armPartOf(JointVector compliance) {
  compliance.tail(robot::wristJointsOf(static_cast<int>(compliance.size()))).setZero();
  return compliance;
}

double variance(const std::vector<CaseEquations>& equations, const JointVector& compliance) {
  double sum = 0.0;
  Eigen::Index rows = 0;
  for (const CaseEquations& one : equations) {
    sum += (one.right - one.matrix.lazyProduct(compliance)).squaredNorm();
    rows += one.right.size();
  }
  return rows > 0 ? sum / static_cast<double>(rows) : 0.0;
}

/// A posture acts on the arm through P_wrist, and on the wrist through its reflectors and, the arm's model being
/// subtracted, through the arm: its uncertainty reaches the wrist's.
void setDecoupledScatter(const std::vector<NormalEquations>& wrist, const std::vector<NormalEquations>& reflectors,
                         const NormalEquations& wrist_sum, const NormalEquations& reflector_sum, double wrist_variance,
                         double reflector_variance, StiffnessEstimate& estimate) {
  const robot::JointMask arm_joints = armOf(estimate.identifiable), wrist_joints = wristOf(estimate.identifiable);
  const JointVector arm_only = armPartOf(estimate.compliance);
  const JointMatrix arm_inverse = inverseNormal(wrist_sum, arm_joints);
  const JointMatrix wrist_inverse = inverseNormal(reflector_sum, wrist_joints);
  const Eigen::Index joints = estimate.compliance.size();
  const JointMatrix carried = JointMatrix::Identity(joints, joints) - wrist_inverse * reflector_sum.matrix;
  const PostureGains arm_gain(wrist_sum, arm_joints), wrist_gain(reflector_sum, wrist_joints);
  GainOfEach by_wrist(joints, wrist.size()), by_reflectors(joints, wrist.size());
  std::vector<JointVector> influences(wrist.size());
  numerics::smallWorkOnAllCores(wrist.size(), [&](std::size_t p) {
    by_wrist[p] = carried * arm_gain.of(wrist[p].matrix);
    by_reflectors[p] = wrist_gain.of(reflectors[p].matrix);
    const JointVector wrist_left = wrist[p].right - wrist[p].matrix.lazyProduct(arm_only),
                      reflectors_left = reflectors[p].right - reflectors[p].matrix.lazyProduct(estimate.compliance);
    influences[p] = by_wrist[p].lazyProduct(wrist_left) + by_reflectors[p].lazyProduct(reflectors_left);
  });
  JointVector dof = JointVector::Zero(joints);
  numerics::onAllCores(
      static_cast<std::size_t>(joints),
      [&](std::size_t joint) {
        if (!estimate.identifiable[joint]) return;
        const int j = static_cast<int>(joint);
        dof[j] =
            matchedDof(combined(wrist_variance, influenceCovariance(by_wrist, wrist, arm_inverse, j),
                                reflector_variance, influenceCovariance(by_reflectors, reflectors, wrist_inverse, j)));
      },
      wrist.size() >= numerics::kWorthThreads);
  setScatter(std::move(influences), dof, estimate);
}

}  // namespace

JointVector solveDecoupled(const NormalEquations& wrist_sum, const NormalEquations& reflector_sum,
                           const robot::JointMask& unknown) {
  const JointVector arm = solveNormal(wrist_sum, armOf(unknown));
  if (reflector_sum.right.size() == 0) return arm;
  // A^T (b - A c_arm) = A^T b - (A^T A) c_arm: the arm's model subtracted, (37).
  const NormalEquations rest{reflector_sum.matrix, reflector_sum.right - reflector_sum.matrix * arm};
  return arm + solveNormal(rest, wristOf(unknown));  // (33), (38)
}

StiffnessEstimate decoupledPartialPose(const std::vector<CaseEquations>& wrist_equations,
                                       const std::vector<CaseEquations>& reflector_equations,
                                       const robot::JointMask& unknown) {
  StiffnessEstimate estimate;
  estimate.identifiable = unknown;
  const std::vector<NormalEquations> wrist = normalByPosture(wrist_equations),
                                     reflectors = normalByPosture(reflector_equations);
  const NormalEquations wrist_sum = sumOf(wrist), reflector_sum = sumOf(reflectors);
  estimate.compliance = solveDecoupled(wrist_sum, reflector_sum, unknown);
  setDecoupledScatter(wrist, reflectors, wrist_sum, reflector_sum,
                      variance(wrist_equations, armPartOf(estimate.compliance)),
                      variance(reflector_equations, estimate.compliance), estimate);
  estimate.condition = std::max(conditionNumber(wrist_equations, armOf(unknown)),
                                conditionNumber(reflector_equations, wristOf(unknown)));
  describeResiduals(reflector_equations, estimate);
  return estimate;
}

}  // namespace stiffscope::identification
