#include "core/audit/sag_doubt.h"

#include <algorithm>
#include <cmath>

#include "core/identification/method_solution.h"
#include "core/numerics/resampling.h"
#include "core/robot/gravity_load.h"
#include "core/robot/kinematics.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::audit {

namespace {

/// Largest torque of the own weight in each joint over the circle sweeps, Nm.
JointVector largestTorques(const AuditInput& input) {
  const robot::Robot& arm = input.frames.arm.arm;
  JointVector torque = JointVector::Zero(arm.joints());
  if (!input.campaign.circle_sweeps) return torque;
  for (const campaign::CircleReading& reading : input.campaign.circle_sweeps->rows) {
    torque =
        torque.cwiseMax(robot::weightTorque(arm, robot::postureAt(arm, reading.q), input.frames.weight).cwiseAbs());
  }
  return torque;
}

/// Of the compliances by which the sag was taken off.
JointMatrix complianceCovariance(const AuditInput& input) {
  const JointVector& compliance = input.arm.geometry.compliance;
  const Eigen::Index joints = compliance.size();
  JointMatrix covariance = JointMatrix::Zero(joints, joints);
  if (input.step && !input.arm.cases.empty() && !input.model.loads_contradicted) {
    identification::LoadedArm arm = input.arm;
    const JointMatrix found = identification::sagStiffness(input.campaign, {}, arm).covariance;
    const double wider = numerics::spreadOfFew(std::max(2.0, static_cast<double>(arm.cases.size())));
    if (found.allFinite()) covariance = wider * wider * found;
  }
  constexpr double kFelt = 1.0;  // Nm: a vertical axis carries none
  const JointVector torque = largestTorques(input);
  for (Eigen::Index j = 0; j < joints; ++j) {
    if (covariance(j, j) <= 0.0 && torque[j] > kFelt)
      covariance(j, j) = std::pow(frames::kTurnByOwnWeight / torque[j], 2);
  }
  const JointVector by_masses = input.campaign.mass_sigma * compliance;
  covariance += by_masses * by_masses.transpose();
  return covariance;
}

}  // namespace

std::vector<AuditInput> underOtherSags(const AuditInput& input) {
  std::vector<AuditInput> others;
  if (!input.frames.sag_removed || input.arm.geometry.compliance.size() == 0) return others;
  const SymmetricEigen eigen = symmetricEigen(complianceCovariance(input));
  const Eigen::Index joints = eigen.values.size();
  constexpr double kNone = 1e-12;  // of the largest variance
  for (Eigen::Index k = 0; k < joints; ++k) {
    if (!(eigen.values[k] > kNone * eigen.values[joints - 1])) continue;
    const JointVector compliance = input.arm.geometry.compliance + std::sqrt(eigen.values[k]) * eigen.vectors.col(k);
    AuditInput& other = others.emplace_back(AuditInput{input.campaign});
    other.noise = input.noise;
    other.frames = frames::refineFrames(input.campaign, input.frames, compliance);
    other.rigid = frames::rigidPoints(input.campaign, frames::sagOf(input.frames, compliance));
  }
  return others;
}

double explainedBySag(const Eigen::VectorXd& left, const std::vector<Eigen::VectorXd>& moved) {
  if (moved.empty()) return 0.0;
  const auto directions = static_cast<Eigen::Index>(moved.size());
  Eigen::MatrixXd by_sag = Eigen::MatrixXd::Zero(left.size(), directions);
  for (Eigen::Index k = 0; k < directions; ++k) {
    const Eigen::VectorXd& other = moved[static_cast<std::size_t>(k)];
    if (other.size() == left.size()) by_sag.col(k) = other - left;
  }
  const Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(directions, directions) + by_sag.transpose() * by_sag;
  const Eigen::VectorXd right = by_sag.transpose() * left;
  return right.dot(Eigen::VectorXd(solvePositive(normal, Eigen::MatrixXd(right))));
}

}  // namespace stiffscope::audit
