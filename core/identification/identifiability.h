#pragma once

#include <vector>

#include "core/identification/equations.h"
#include "metrology/remark.h"

namespace stiffscope::identification {

/// What wrench, frames and angles are trusted to, for judging which joint the load really turns.
struct TrustLimits {
  double direction = 2e-3;         ///< rad: the load cell's axes against the arm's, one sigma
  double position = 0.2e-3;        ///< m: the load cell's point against the arm's axes, one sigma
  double hanging_within = 0.0873;  ///< rad (5 deg): forces this near gravity, rms, are a load that hangs
  double least_ratio = 3.0;        ///< a joint's torque must exceed this times its own uncertainty
};

/// Whether this data turns a joint enough for its compliance to be seen.
struct JointIdentifiability {
  bool identifiable = false;
  Remark reason;                 ///< why not
  double torque_rms = 0.0;       ///< over the load cases, Nm
  double trusted_rms = 0.0;      ///< of it, what a hanging load explains where the load hangs; else the same
  double uncertainty_rms = 0.0;  ///< what wrench, frame and angle uncertainty alone put there, Nm
};

struct Identifiability {
  PerJoint<JointIdentifiability> joints;
  bool load_hangs = false;
  double gravity_angle_rms = 0.0;  ///< between the forces and gravity, rad

  robot::JointMask mask() const;
};

/// A joint counts only if the load turns it by more than wrench, frame and angle uncertainty alone would.
/// Where every force lies along gravity the load hangs: only its part along gravity is trusted then, because
/// a slightly turned load cell or base would else put a little torque on a vertical axis and a number on its
/// stiffness (docs/method.md, What every method reports).
Identifiability evaluateTorques(const frames::LoadingGeometry& geometry, const std::vector<LoadCase>& cases,
                                const campaign::LoadCell& cell, const TrustLimits& limits = {});

/// The same, and what the measured points see of the joints that the load turns: neither is a joint identifiable whose
/// axis the measured points stand on, or whose column is a combination of others'. `equations`: positions only, one a
/// case, made with the cases' torques.
Identifiability evaluateIdentifiability(const frames::LoadingGeometry& geometry, const std::vector<LoadCase>& cases,
                                        const campaign::LoadCell& cell, const std::vector<CaseEquations>& equations,
                                        const TrustLimits& limits = {});

}  // namespace stiffscope::identification
