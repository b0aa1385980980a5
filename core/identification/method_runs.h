#pragma once

#include "core/identification/identification.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope::identification {

/// What the methods work on, and what they hand to each other.
struct MethodRuns {
  const campaign::Campaign& campaign;
  const IdentifyOptions& options;
  LoadedArm swept;             ///< the arm in the swept geometry; no cases where no sweep places the readings
  LoadedArm calibrated;        ///< in Partial Pose's geometry, once it has run and where `swept` has no cases
  robot::JointMask unknown{};  ///< the joints whose compliances are solved for
};

/// Which joints the loads turn enough, judged in this arm's geometry: into `result` and `runs.unknown`.
void evaluateIdentifiabilityIn(const LoadedArm& arm, MethodRuns& runs, Identification& result);

/// Each solves and judges its method, or says in `reason` why it cannot be had and what would make it
/// available. In this order: Partial Pose judges the joints where no sweep gave a geometry to judge them in.
void runCompletePose(MethodRuns& runs, Identification& result);
void runPartialPose(MethodRuns& runs, Identification& result);
void runDecoupledPartialPose(MethodRuns& runs, Identification& result);

/// Adds what all postures share to the covariances of the methods that have run (shared_uncertainty.h).
void addSharedUncertainty(const MethodRuns& runs, Identification& result);

}  // namespace stiffscope::identification
