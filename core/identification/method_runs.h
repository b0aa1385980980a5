#pragma once

#include <functional>

#include "core/frames/geometry_calibration.h"
#include "core/identification/estimate.h"
#include "core/identification/identification.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope::identification {

// What all postures have in common, and no scatter between them shows, carried to the compliances by differences of the
// whole solution: J C J^T. Solutions here neglect K_c, which changes a derivative by as little as it changes the
// torques (about a hundredth).

// Some eighty solutions of the whole. A derivative is a mean over the postures, which preparation::kMostAveraged of a
// longer day give to some hundredths.

/// Compliances by one method from a loaded arm.
using ComplianceOf = std::function<JointVector(const LoadedArm&)>;

/// Of the compliances that `solve` gives in the swept geometry: by the axes as they were measured (AxesCovariance),
/// from which R0, links and the flange's place follow, and by the radii of the wrist sweep. The reflectors'
/// places at zero go along with R0, as if they were not turned back about the measured axes, and P_TCP's place in the
/// flange is kept: that overstates Complete Pose's part by up to two, of some thousandths of the whole.
struct SweptParts {
  JointMatrix frames, wrist;
};
std::vector<SweptParts> sweptParts(const campaign::Campaign& campaign, const frames::Frames& frames,
                                   const frames::LoadingGeometry& geometry, const std::vector<int>& steps,
                                   const std::vector<ComplianceOf>& solves);

/// Of the compliances in the calibrated geometry, by its covariance (GeometryCalibration::spread).
JointMatrix calibratedPart(const campaign::Campaign& campaign, const frames::GeometryCalibration& calibration,
                           const frames::WristCentre& wrist, const std::vector<int>& steps, const ComplianceOf& solve);

/// What the methods work on, and what they hand to each other.
struct MethodRuns {
  const campaign::Campaign& campaign;
  const IdentifyOptions& options;
  LoadedArm swept;           ///< the arm in the swept geometry; no cases where no sweep places the readings
  LoadedArm calibrated;      ///< in Partial Pose's geometry, once it has run and where `swept` has no cases
  robot::JointMask unknown;  ///< the joints whose compliances are solved for
};

/// Which joints the loads turn enough, judged in this arm's geometry: into `result` and `runs.unknown`.
void evaluateIdentifiabilityIn(const LoadedArm& arm, MethodRuns& runs, Identification& result);

/// Each solves and judges its method, or says in `reason` why it cannot be had and what would make it
/// available. In this order: Partial Pose judges the joints where no sweep gave a geometry to judge them in.
void runCompletePose(MethodRuns& runs, Identification& result);
void runPartialPose(MethodRuns& runs, Identification& result);
void runDecoupledPartialPose(MethodRuns& runs, Identification& result);

/// Adds what all postures share to the covariances of the methods that have run: scatter is theirs
/// already, the parts come from sweptParts.
void addSharedUncertainty(const MethodRuns& runs, Identification& result);

/// The L of the residual variances, m: feasible generalised least squares of Complete Pose. Displacements weigh by the
/// inverse variance of what they leave, rotations by theirs, so that L = s_d / s_r, s^2 the mean square of a block's
/// residuals at the compliances of that L; iterated from `start` to a fixed point. Both blocks have three rows a pose,
/// so the unknowns' degrees of freedom leave the ratio as it is. Empty where it does not settle between the shortest
/// and the longest length, or a block leaves nothing.
std::optional<double> residualVarianceLength(const std::vector<CaseEquations>& pose_rows,
                                             const robot::JointMask& unknown, double start);

/// Lengths at which Complete Pose is shown, from the curve of CharacteristicLength.
std::vector<LengthSensitivity> shownLengths(const CharacteristicLength& chosen);

/// How many subsets judge each of that many lengths: 500, fewer of very many postures, where the subsets hardly differ.
SubsetOptions subsetsOfALength(const SubsetOptions& asked, std::size_t postures, std::size_t lengths);

/// Complete Pose solved and judged at each length of `length_sensitivity`, and at the L of the residual variances
/// (`residual_length`), from the rows of its result. The rows stay those settled at its own L: what K_c and the middle
/// postures change with L is left out, a ten-thousandth of a share. `cases`: those that were solved.
void studyLengths(const std::vector<LoadCase>& cases, const IdentifyOptions& options, Identification& result);

}  // namespace stiffscope::identification
