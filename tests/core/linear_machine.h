#pragma once
#include "core/identification/complete_pose.h"
#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/partial_pose.h"
#include "core/identification/equations.h"
#include "tests/core/simulated_lab.h"

namespace stiffscope {

/// Load cases of a machine with linear joint springs: each joint turned by c times its torque, both by the
/// tests' own kinematics; reflectors, flange and wrist carried along by finite turns.
struct LinearMachine {
  ChainArm chain = exampleChain();
  Vector6d compliance = exampleCompliance();
  std::vector<Eigen::Vector3d> targets_in_flange{{0.28, 0.05, 0.12}, {-0.17, 0.27, 0.08}, {-0.1, -0.3, 0.21}};
  Eigen::Vector3d wrench_in_flange{0.02, -0.05, 0.3};  ///< where the wrench acts
  frames::LoadingGeometry geometry;
  std::vector<identification::LoadCase> cases;
  std::vector<double> radii;
  Eigen::Vector3d wrist_at_zero;

  /// Scales forces and moments: the turns' second order falls with it.
  explicit LinearMachine(int postures, double load_scale = 1e-4, std::uint64_t seed = 3) {
    geometry.arm = chain.robot();
    const Eigen::Isometry3d flange_at_zero = chain.flangeAt(Vector6d::Zero());
    wrist_at_zero = chain.framesAt(Vector6d::Zero())[4].translation();
    for (const Eigen::Vector3d& target : targets_in_flange) {
      geometry.targets_at_zero.push_back(flange_at_zero * target);
      radii.push_back((flange_at_zero * target - wrist_at_zero).norm());
    }
    Noise noise(seed);
    for (int pose = 0; pose < postures; ++pose) {
      const Eigen::Vector3d force = load_scale * 1500.0 * noise.normal3(),
                            moment = load_scale * 300.0 * noise.normal3();
      add(somePosture(noise), force, moment);
    }
  }

  void add(const Vector6d& q, const Eigen::Vector3d& force, const Eigen::Vector3d& moment) {
    const Eigen::Isometry3d before = chain.flangeAt(q);
    const Eigen::Vector3d point = before * wrench_in_flange;
    const Vector6d turned = q + compliance.cwiseProduct(chain.torqueOf(q, 6, point, force, moment));
    const Eigen::Isometry3d after = chain.flangeAt(turned);
    identification::LoadCase one;
    one.pose = static_cast<int>(cases.size());
    one.step = 1;
    one.q = one.q_sagged = q;
    one.axes = robot::axesAt(geometry.arm, robot::postureAt(geometry.arm, q));
    one.wrench = {point, force, moment};
    for (std::size_t k = 0; k < targets_in_flange.size(); ++k) {
      one.targets.push_back(
          {static_cast<int>(k), before * targets_in_flange[k], after * targets_in_flange[k], 1, 1});
    }
    one.absolute = true;
    one.flange_unloaded = before;
    one.flange_loaded = after;
    cases.push_back(one);
  }

  std::vector<Vector6d> torques() const { return identification::jointTorques(cases); }

  std::vector<identification::CaseEquations> reflectorEquations() const {
    std::vector<identification::CaseEquations> equations;
    const auto torque = torques();
    for (std::size_t i = 0; i < cases.size(); ++i)
      equations.push_back(identification::partialPoseEquations(cases[i], torque[i]));
    return equations;
  }
  std::vector<identification::CaseEquations> poseEquations(const Eigen::Vector3d& tcp_in_flange = {0, 0, 0}) const {
    std::vector<identification::CaseEquations> equations;
    const auto torque = torques();
    for (std::size_t i = 0; i < cases.size(); ++i) {
      equations.push_back(identification::completePoseEquations(cases[i], tcp_in_flange, torque[i]));
    }
    return equations;
  }
  identification::WristMove wristMoveOf(const identification::LoadCase& one) const {
    return identification::wristMove(one, radii, identification::modelledWrist(geometry.arm, one, wrist_at_zero)).value();
  }
  std::vector<identification::CaseEquations> wristEquationsOfAll() const {
    std::vector<identification::CaseEquations> equations;
    const auto torque = torques();
    for (std::size_t i = 0; i < cases.size(); ++i) {
      equations.push_back(identification::wristEquations(cases[i], wristMoveOf(cases[i]), torque[i]));
    }
    return equations;
  }
};

inline constexpr robot::JointMask kAllJoints{true, true, true, true, true, true};

/// Largest relative error of the compliances of `joints`.
inline double worstError(const Vector6d& found, const Vector6d& truth, const robot::JointMask& joints = kAllJoints) {
  double worst = 0.0;
  for (int j = 0; j < 6; ++j) {
    if (joints[static_cast<std::size_t>(j)]) worst = std::max(worst, std::abs(found[j] / truth[j] - 1.0));
  }
  return worst;
}

}  // namespace stiffscope
