#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/diagnosis/arm_state.h"
#include "core/diagnosis/effect_model.h"

namespace stiffscope {

/// What is corrected before the effects' equations are made: estimates of the effects in the model, so that
/// the next linear step starts where the last one ended.
struct Corrections {
  Eigen::Vector3d load_point = Eigen::Vector3d::Zero();  ///< m, flange axes
  Eigen::Vector3d cell_turn = Eigen::Vector3d::Zero();   ///< rad, about the cell's axes
  Eigen::Vector3d cell_force = Eigen::Vector3d::Zero();  ///< N, in the cell's axes, in loaded states
  double missing_weight = 0.0;                           ///< N, along gravity, in loaded states
  Vector6d frame = Vector6d::Zero();  ///< shift of the loading's readings, as frameError has it
};

/// The equations of one posture of the loading, unwhitened, in R0, m. Deflection rows: states after the
/// first, three a reflector; absolute rows: the first state. y = A c + geometry + effects + noise.
struct GapRows {
  int pose = 0;
  PostureStates states;
  Eigen::VectorXd displacement;  ///< loaded less unloaded, as measured
  Eigen::Matrix<double, Eigen::Dynamic, 6>
      by_compliance;         ///< of the displacement: K_c and the middle posture in
  Eigen::VectorXd position;  ///< measured less the rigid model's; empty without absolute points
  Eigen::Matrix<double, Eigen::Dynamic, 6> sag_by_compliance;
  int unloaded_readings = 0, loaded_readings = 0;  ///< means over these, per reflector and state
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 6>>
      by_wrench;  ///< of each loaded state: displacement by its wrench
};

/// One unloaded posture of a sweep.
struct SweepRows {
  ArmState state;
  Eigen::VectorXd position;
  Eigen::Matrix<double, Eigen::Dynamic, 6> sag_by_compliance;
};

/// Rows of the loading (or of `displacements`), in the order of poses. Reflectors that some step of a posture
/// lacks are left out of that posture; a posture without a loaded state is left out.
std::vector<GapRows> loadingRows(const Campaign& campaign, const LoadingGeometry& geometry,
                                 const WorkingPoint& at, const Corrections& corrections);

/// Rows of circle and wrist sweeps; empty where they are in another frame than the loading.
std::vector<SweepRows> sweepRows(const Campaign& campaign, const LoadingGeometry& geometry,
                                 const Eigen::Isometry3d& r0_from_points, const WorkingPoint& at);

/// How the compensator's torque on joint 2 changes as the joint turns, Nm/rad.
double compensatorSlope(const WorkingPoint& at, const Vector6d& turned);

}  // namespace stiffscope
