#pragma once

#include <array>
#include <vector>

#include "core/identification/identification.h"

namespace stiffscope::identification {

/// One method on one load step.
struct StepEstimate {
  int step = 0;
  double mean_force = 0.0;  ///< N
  StiffnessEstimate estimate;
};

/// Whether a joint's stiffness depends on the load.
struct LoadDependence {
  /// 1/k at the heaviest step less that at the lightest, relative to the lightest, and its standard uncertainty.
  double change = 0.0, change_sd = 0.0;
  double dof = 0.0;       ///< of change_sd, Student
  double p_change = 1.0;  ///< of that change, Student
  double p_linear = 1.0;  ///< of all steps having the same compliance
};

/// A method's stiffness step by step.
struct StepsOfMethod {
  std::vector<StepEstimate> steps;  ///< the lightest first; empty where the method is unavailable
  PerJoint<LoadDependence> joints;
};

/// Every load step on its own, in the frames and the calibrated geometry that all have in common. The steps of a
/// posture share the unloaded readings, and steps share frames: differences are judged by the differences of the
/// postures' influences, in which what is shared drops out. `p_linear` is the F test of a clustered covariance
/// (Pustejovsky and Tipton 2018, HTZ): (nu - q + 1) / (nu q) d^T V^-1 d with q contrasts and the postures' effective
/// degrees nu.
struct StepStudy {
  std::array<StepsOfMethod, 3> methods;  ///< by Method
};

/// `result` from `campaign` by `options`; all load steps but returns to zero. Empty with fewer than two.
StepStudy studySteps(const campaign::Campaign& campaign, const IdentifyOptions& options, const Identification& result);

}  // namespace stiffscope::identification
