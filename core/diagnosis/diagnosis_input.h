#pragma once

#include "core/diagnosis/fit.h"
#include "core/diagnosis/linear_system.h"
#include "core/identification/loaded_arm.h"
#include "core/identification/method_solution.h"
#include "core/preparation/prepare.h"
#include "metrology/remark.h"

namespace stiffscope::diagnosis {

/// What the diagnosis of a prepared campaign begins with: frames and stiffnesses found, the arm's geometry from the
/// sweeps or, without them, calibrated on the unloaded positions.
struct DiagnosisInput {
  campaign::Campaign campaign;
  preparation::DriftModel station;
  preparation::NoiseModel noise;
  frames::LoadingGeometry geometry;
  bool absolute = false, sweeps = false;
  SystemState state;
  double geometric_stiffness_share = 0.0;
  Remark reason;  ///< why there is no gap to look at; empty where there is
};

DiagnosisInput diagnosisInput(const preparation::PreparedCampaign& prepared);

/// Nests that show no motion by themselves still bound a drift: their rate, with its weight, takes part in the
/// fit as a reading of trackerDrift's parameters (readings move against what brings them back). Nothing where
/// there is no rate, or no absolute positions that a drift would move; nothing where the nests do show a
/// motion, which the readings are corrected for instead. Puts the sweeps' epoch between the first round and the
/// loading.
void boundDriftByNests(DiagnosisInput& start, SystemInput& input);

/// What the fit starts from: geometry and stiffnesses as identification has them; what the campaign's states
/// and load cases (one step, in that geometry) say of forces, torques and times.
SystemState startState(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                       const std::vector<identification::LoadCase>& cases);

/// Where the load itself pulls, from the declared point of the wrench, flange axes, m: the point d through
/// which all wrenches pass as nearly as can be, M = (R d) x F, by least squares over the cases. Directions
/// the readings do not settle stay at the declared point: each coordinate of d is expected within 0.3 m
/// beside readings of `moment_sigma` (Nm).
Eigen::Vector3d loadOffset(const robot::Robot& arm, const std::vector<identification::LoadCase>& cases,
                           double moment_sigma);

}  // namespace stiffscope::diagnosis
