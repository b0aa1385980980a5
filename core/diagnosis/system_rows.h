#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/effects/arm_state.h"
#include "core/effects/effect_model.h"
#include "core/frames/arm_parameters.h"
#include "core/identification/load_case.h"

namespace stiffscope::diagnosis {

/// Derivatives of an unloaded state's absolute positions, modelled less measured, by the geometry's steps:
/// one row a coordinate of each reflector, one column one of ArmParameters.
///
/// To those of the rigid arm (frames::PlacedPosture) the sag is added: the own weight's torques tau change with axes
/// and bodies, and with them the sag and what effects in the model turn the joints by: d theta = (C + T) (d tau + K_c d
/// theta) + U d theta, T and U the slopes of these turns by torque and angle. Where effects in the model move bodies,
/// the axes' columns are by differences.
class PositionByGeometry {
 public:
  /// `centre`: about which the base's steps turn. Keeps references.
  PositionByGeometry(const frames::LoadingGeometry& geometry, const effects::LinearizationPoint& at,
                     const Eigen::Vector3d& centre);

  Eigen::MatrixXd of(const effects::ArmState& state) const;

 private:
  void addSag(const effects::ArmState& modelled, const frames::PlacedPosture& posture, Eigen::MatrixXd& columns) const;
  void addAxesByDifferences(const effects::ArmState& modelled, Eigen::MatrixXd& columns) const;

  const frames::LoadingGeometry& geometry_;
  const effects::LinearizationPoint& at_;
  frames::ArmParameters layout_;
  frames::PlacedArm arm_;
  std::vector<frames::LoadingGeometry> stepped_;  ///< by each step of an axis; empty where no effect moves bodies
};

/// Where the instrument stood that read a reflector, in R0, and by what its station's pose is uncertain at the
/// reflector, m^2 (R0 axes).
struct ReadFrom {
  Eigen::Vector3d from = campaign::kStationOfTracker;
  Eigen::Matrix3d pose_covariance = Eigen::Matrix3d::Zero();
};

/// The equations of one posture of the loading, unwhitened, in R0, m. Deflection rows: states after the
/// first, three a reflector; absolute rows: the first state. y = A c + geometry + effects + noise.
struct SystemRows {
  int pose = 0;
  effects::PostureStates states;
  Eigen::VectorXd displacement;  ///< loaded less unloaded, as measured
  JointRows by_compliance;       ///< of the displacement: K_c and the middle posture in
  Eigen::VectorXd position;      ///< measured less the rigid model's; empty without absolute points
  JointRows sag_by_compliance;
  Eigen::MatrixXi readings;  ///< over which each state's points are means, a row a state, a column a reflector
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 6>>
      by_wrench;                    ///< of each loaded state: displacement by its wrench
  std::vector<ReadFrom> read_from;  ///< of each reflector; empty on a day of one station
};

/// One unloaded posture of a sweep.
struct SweepRows {
  effects::ArmState state;
  Eigen::VectorXd position;
  JointRows sag_by_compliance;
  std::vector<ReadFrom> read_from;  ///< of each reflector; empty on a day of one station
};

/// Rows of the loading (or of `displacements`), in the order of poses. Reflectors that some step of a posture
/// lacks are left out of that posture; a posture without a loaded state is left out. What does not depend on the
/// geometry is gathered once for the many geometries by which their derivatives are found. Refers to the campaign.
class LoadingRows {
 public:
  explicit LoadingRows(const campaign::Campaign& campaign);

  std::vector<SystemRows> rows(const frames::LoadingGeometry& geometry, const effects::LinearizationPoint& at,
                               const effects::Corrections& corrections) const {
    return rows(geometry, at, corrections, 0, poses());
  }
  /// Those of the poses from `first` on, before `end`.
  std::vector<SystemRows> rows(const frames::LoadingGeometry& geometry, const effects::LinearizationPoint& at,
                               const effects::Corrections& corrections, std::size_t first, std::size_t end) const;

  std::size_t poses() const { return readings_.poses(); }

 private:
  const campaign::Campaign& campaign_;
  identification::LoadReadings readings_;
  std::vector<std::map<int, const campaign::State*>> states_;  // by pose and step
};

std::vector<SystemRows> loadingRows(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                    const effects::LinearizationPoint& at, const effects::Corrections& corrections);

/// Rows of circle and wrist sweeps; empty where they are in another frame than the loading.
std::vector<SweepRows> sweepRows(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                 const Eigen::Isometry3d& r0_from_points, const effects::LinearizationPoint& at);

/// How the compensator's torque on joint 2 changes as the joint turns, Nm/rad.
double compensatorSlope(const effects::LinearizationPoint& at, const JointVector& turned);

}  // namespace stiffscope::diagnosis
