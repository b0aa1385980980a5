#pragma once

#include <vector>

#include "core/frames/frames.h"
#include "core/identification/complete_pose.h"
#include "core/identification/equations.h"
#include "core/identification/estimate.h"
#include "core/identification/load_case.h"

namespace stiffscope::identification {

/// The arm under one load step, or several, in one geometry: what every method's equations are made from.
struct LoadedArm {
  frames::LoadingGeometry geometry;
  std::vector<LoadCase> cases;
  std::vector<WristMove> wrist;      ///< one a case; empty where P_wrist is not measured
  std::vector<JointVector> torques;  ///< one a case: J_w^T W, with K_c's share where a method has put it in

  bool hasFlangePoses() const;
};

/// Where reflectors in most postures give a flange pose, or P_wrist, a posture that lacks it is left out, so
/// that all methods see the same postures; `left_out` names it. Cases in the order of poses, then of `steps`,
/// which the readings have.
LoadedArm loadedArm(const campaign::Campaign& campaign, const LoadReadings& readings,
                    const frames::LoadingGeometry& geometry, const frames::WristCentre& wrist,
                    const std::vector<int>& steps, std::vector<LeftOutPosture>* left_out = nullptr);
LoadedArm loadedArm(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                    const frames::WristCentre& wrist, const std::vector<int>& steps,
                    std::vector<LeftOutPosture>* left_out = nullptr);

/// Equations of all cases: the reflectors', P_wrist's, the pose's at P_TCP.
std::vector<CaseEquations> reflectorEquations(const LoadedArm& arm);
std::vector<CaseEquations> wristPointEquations(const LoadedArm& arm);
std::vector<CaseEquations> poseEquations(const LoadedArm& arm, const Eigen::Vector3d& tcp_in_flange);

/// Those of an arm's points; no `wrist` where P_wrist is not measured.
struct PointEquations {
  std::vector<CaseEquations> wrist, reflectors;
};

/// The loads settled: torques (K_c, and the wrench turned with the flange where its turn is not measured) and
/// middle postures that the compliances imply which `compliance(arm)` gives, round by round; K_c is about a
/// hundredth, so two rounds leave a millionth. Without `finite_deflection` the unloaded arm's torques and
/// postures.
template <class Compliance>
void solveLoadedArm(LoadedArm& arm, bool finite_deflection, const Compliance& compliance) {
  for (LoadCase& load_case : arm.cases) {
    load_case.middle.reset();
    if (load_case.wrench_turns_with != 0) load_case.wrench = load_case.wrench_unturned;
  }
  arm.torques = jointTorques(arm.cases);
  constexpr int kRounds = 2;
  for (int round = 0; finite_deflection && round < kRounds; ++round) {
    updateLoadedConfiguration(arm.geometry, compliance(arm), arm.cases, arm.torques);
  }
}

// Normal equations of all cases of a loaded arm, summed as their rows are made: for where compliances alone are wanted,
// many times over.

/// Of reflectorEquations, wristPointEquations and poseEquations (loaded_arm.h).
NormalEquations reflectorNormal(const LoadedArm& arm);
NormalEquations wristNormal(const LoadedArm& arm);
PoseNormal poseNormal(const LoadedArm& arm, const Eigen::Vector3d& tcp_in_flange);

}  // namespace stiffscope::identification
