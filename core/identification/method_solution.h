#pragma once

#include "core/identification/identification.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope::identification {

/// How a method solves a loaded arm, once what it needs is known.
struct MethodSolution {
  Method method = Method::partial_pose;
  Eigen::Vector3d tcp_in_flange = Eigen::Vector3d::Zero();  ///< Complete Pose
  double length = 1.0;                                      ///< the same: the characteristic length, m
  robot::JointMask unknown;
  const campaign::Tracker* tracker =
      nullptr;  ///< Partial Pose: whose noise is the working model of the scatter; may be none

  StiffnessEstimate estimate(const LoadedArm& arm, const PointEquations& equations) const;

  /// The compliances alone, without their covariance and at a twentieth of the time.
  JointVector compliance(const LoadedArm& arm) const;

  /// The same of the arm settled (solveLoadedArm) by this method's compliances; its `equations` then are given out
  /// where asked.
  StiffnessEstimate solvedEstimate(LoadedArm& arm, bool finite_deflection, PointEquations* equations = nullptr) const;
  JointVector solvedCompliance(LoadedArm& arm, bool finite_deflection) const;
};

/// Frames from which the own weight's sag is taken off, and the loaded arm in them.
struct SolvedFrames {
  frames::Frames frames;
  LoadedArm arm;                         ///< in the swept geometry
  std::vector<LeftOutPosture> left_out;  ///< postures that cannot be used, with the reason
};

/// The own weight needs stiffnesses to be taken off the sweeps, and the stiffnesses need the sweeps: the two
/// are found in turns, from the rigid arm on; three rounds settle to 1e-4 of a stiffness, the first two of a
/// day of more than preparation::kMostAveraged postures by so many of them. Without known
/// masses, the rigid arm's frames.
SolvedFrames solveFrames(const campaign::Campaign& campaign, const std::vector<int>& steps,
                         const IdentifyOptions& options);

/// The springs that the own weight bends, from the loads: by the decoupled method where P_wrist is measured, else
/// Partial Pose; no compliance negative. The covariance is from the scatter between postures.
StiffnessEstimate sagStiffness(const campaign::Campaign& campaign, const IdentifyOptions& options, LoadedArm& arm);

/// The compliances of sagStiffness.
JointVector sagCompliance(const campaign::Campaign& campaign, const IdentifyOptions& options, LoadedArm& arm);

/// Rounds in which sag and stiffnesses are found in turns.
inline constexpr int kSagRounds = 3;

/// The loaded arm of the heaviest step where the campaign has what it takes; else the frames alone.
struct SolvedDay {
  std::optional<int> step;
  frames::Frames frames;
  LoadedArm arm;  ///< in the swept geometry; no cases without loads
};
SolvedDay solveDay(const campaign::Campaign& campaign);

}  // namespace stiffscope::identification
