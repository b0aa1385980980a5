#pragma once

#include "core/identification/identification.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope {

/// How a method solves a loaded arm, once what it needs is known.
struct MethodSolution {
  Method method = Method::partial_pose;
  Eigen::Vector3d tcp_in_flange = Eigen::Vector3d::Zero();  ///< Complete Pose
  double length = 1.0;                                      ///< the same: the characteristic length, m
  JointMask unknown{};
  const Tracker* tracker = nullptr;  ///< Partial Pose: whose noise is the working model of the scatter; may be none

  StiffnessEstimate estimate(const LoadedArm& arm, const PointEquations& equations) const;

  /// The compliances alone, without their covariance and at a twentieth of the time.
  Vector6d compliance(const LoadedArm& arm) const;

  /// The same of the arm settled (settleArm) by this method's compliances; its `equations` then are given out where asked.
  StiffnessEstimate settledEstimate(LoadedArm& arm, bool finite_deflection, PointEquations* equations = nullptr) const;
  Vector6d settledCompliance(LoadedArm& arm, bool finite_deflection) const;
};

}  // namespace stiffscope
