#pragma once

#include "core/identification/identification.h"
#include "core/identification/loaded_arm.h"

namespace stiffscope::identification {

/// What the loads did, whatever the method: load cases, displacements of P_wrist and of the reflectors,
/// change of the reported angles, the noise's share, and that of K_c at the compliances of the method
/// shown first. `shown`: the arm in the swept geometry, else in the calibrated one.
void describeLoads(const campaign::Campaign& campaign, LoadedArm shown, Identification& result);

/// Root mean square change of the joint torques by K_c at these compliances, relative to J_w^T W.
double geometricStiffnessShare(const LoadedArm& arm, const JointVector& compliance);

/// Identifies by all three methods from one load step. Never throws for what the data lacks: a method that
/// cannot be had says why. Throws InputError where the campaign has no load states at all.
///
/// The own weight needs stiffnesses to be taken off the sweeps, and the stiffnesses need the sweeps: the two
/// are found in turns, from the rigid arm on; three rounds settle to 1e-4 of a stiffness.
Identification identify(const campaign::Campaign& campaign, const IdentifyOptions& options = {});

/// The options for values alone: no subsets, no bootstrap, no outliers sought.
IdentifyOptions valuesOnly(IdentifyOptions options = {});

/// The options for estimates alone (IdentifyOptions::estimates_only).
IdentifyOptions estimatesOnly(IdentifyOptions options = {});

/// The frames alone: with the own weight taken off where the campaign has what identifies the stiffnesses, else by
/// those that it knows, and what others may do in the uncertainties (frames::refineByKnownStiffness).
frames::Frames solvedFrames(const campaign::Campaign& campaign);

/// The result for a campaign without loads (core/identification/load_case.h, whatLoadsLack): its frames, step
/// 0, no load case, and for every method and joint what is missing.
Identification framesAlone(const campaign::Campaign& campaign);

}  // namespace stiffscope::identification
