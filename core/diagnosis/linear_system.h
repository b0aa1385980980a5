#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/effects/all.h"
#include "core/effects/arm_state.h"
#include "core/effects/effect_model.h"
#include "core/frames/arm_geometry.h"
#include "core/numerics/normal_equations.h"
#include "core/preparation/station_course.h"
#include "metrology/measured_points.h"

namespace stiffscope::diagnosis {

/// Derivatives of an unloaded state's absolute positions, modelled less measured, by the geometry's steps:
/// one row a coordinate of each reflector, one column a step of GeometrySteps.
///
/// In a product of exponentials, moving axis j by a small motion xi moves what is beyond it by
/// M_{j-1} xi M_{j-1}^-1 - M_j xi M_j^-1, M_b the motion of body b; the base's steps move the readings, the
/// reflectors' steps turn with body 6. The own weight's torques tau change with axes and bodies, and with
/// them the sag and what effects in the model turn the joints by: d theta = (C + T) (d tau + K_c d theta) + U
/// d theta, T and U the slopes of these turns by torque and angle. Where effects in the model move bodies,
/// all of it is by differences.
class PositionByGeometry {
 public:
  /// `centre`: about which the base's steps turn. Keeps references.
  PositionByGeometry(const frames::LoadingGeometry& geometry, const effects::LinearizationPoint& at,
                     const Eigen::Vector3d& centre);

  Eigen::MatrixXd of(const effects::ArmState& state) const;

 private:
  void addAxes(const effects::ArmState& modelled, Eigen::MatrixXd& columns) const;
  void addAxesByDifferences(const effects::ArmState& modelled, Eigen::MatrixXd& columns) const;

  const frames::LoadingGeometry& geometry_;
  const effects::LinearizationPoint& at_;
  Eigen::Vector3d centre_;
  std::vector<frames::LoadingGeometry> stepped_;  ///< by each step of an axis; empty where no effect moves bodies
};

/// The equations of one posture of the loading, unwhitened, in R0, m. Deflection rows: states after the
/// first, three a reflector; absolute rows: the first state. y = A c + geometry + effects + noise.
struct SystemRows {
  int pose = 0;
  effects::PostureStates states;
  Eigen::VectorXd displacement;                            ///< loaded less unloaded, as measured
  Eigen::Matrix<double, Eigen::Dynamic, 6> by_compliance;  ///< of the displacement: K_c and the middle posture in
  Eigen::VectorXd position;  ///< measured less the rigid model's; empty without absolute points
  Eigen::Matrix<double, Eigen::Dynamic, 6> sag_by_compliance;
  int unloaded_readings = 0, loaded_readings = 0;  ///< means over these, per reflector and state
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 6>>
      by_wrench;  ///< of each loaded state: displacement by its wrench
};

/// One unloaded posture of a sweep.
struct SweepRows {
  effects::ArmState state;
  Eigen::VectorXd position;
  Eigen::Matrix<double, Eigen::Dynamic, 6> sag_by_compliance;
};

/// Rows of the loading (or of `displacements`), in the order of poses. Reflectors that some step of a posture
/// lacks are left out of that posture; a posture without a loaded state is left out.
std::vector<SystemRows> loadingRows(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                    const effects::LinearizationPoint& at, const effects::Corrections& corrections);

/// Rows of circle and wrist sweeps; empty where they are in another frame than the loading.
std::vector<SweepRows> sweepRows(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                 const Eigen::Isometry3d& r0_from_points, const effects::LinearizationPoint& at);

/// How the compensator's torque on joint 2 changes as the joint turns, Nm/rad.
double compensatorSlope(const effects::LinearizationPoint& at, const Vector6d& turned);

/// Where everything stands in the parameter vector: joint compliances, geometry steps, own-weight factors by
/// body (nuisances), then the effects' models in their order.
struct GapLayout {
  Eigen::Index geometry = 6, weights = 0, effects = 0, end = 0;
  std::vector<Eigen::Index> model_at;  ///< first parameter of each model
};

/// What is known of the six compliances before the gap is looked at, and how well (sd), rad/Nm: as
/// identification has them, give or take three times as much; where the load says nothing of a joint, half of
/// its weaker neighbour's, give or take as much. Without it a joint that no load turns takes any stiffness,
/// and what is computed with it anything.
struct ComplianceExpected {
  Vector6d value = Vector6d::Zero(), sd = Vector6d::Zero();  ///< sd 0: nothing is known
};

ComplianceExpected complianceExpected(const Vector6d& identified);

/// What the gap stands on, fixed for one diagnosis.
struct SystemInput {
  const campaign::Campaign& campaign;  ///< screened; the station's motion taken off where nests show it
  metrology::TrackerNoise noise;       ///< by the repeats where there are enough, else as declared
  double force_sigma = 0.0, moment_sigma = 0.0;
  std::vector<effects::EffectModel> models;
  bool absolute = false;  ///< unloaded absolute positions can be held against the arm
  bool sweeps = false;    ///< and the sweeps too
  ComplianceExpected expected;
  /// What nests say of trackerDrift's parameters: their values, and the inverse covariance of these.
  Vector6d drift = Vector6d::Zero();
  Matrix6d drift_weight = Matrix6d::Zero();
  const preparation::DriftModel* wandering = nullptr;  ///< of which the interpolated motion was taken off; null: none
};

/// Where one round of linearisation stands.
struct SystemState {
  frames::LoadingGeometry geometry;
  Eigen::Isometry3d r0_from_sweeps = Eigen::Isometry3d::Identity();
  effects::LinearizationPoint at;
  effects::Corrections corrections;
  double sweep_inflation = 1.0, position_inflation = 1.0;  ///< factors on the variances of absolute positions
  double model_error = 0.0;  ///< rms per coordinate of what no effect explains, at the largest load, m
};

/// Whitened normal equations of one posture of the loading: [A y]^T [A y].
struct GapPosture {
  int pose = 0;
  effects::PostureStates states;
  Eigen::MatrixXd columns;  ///< unwhitened: position rows first, then deflection rows
  Eigen::VectorXd right;
  Eigen::Index position_rows = 0;
  /// Covariance of these rows by readings, wrench and a station between its rounds, within each state: its block of the
  /// diagonal, one state's under another's.
  Eigen::MatrixXd noise;
  Eigen::MatrixXd position_lower;  ///< Cholesky factor of that of the position rows, inflated
  numerics::LowerTriangle normal;
  Eigen::Matrix<double, 7, 7> stiffness_normal;  ///< the same of deflection rows alone, over the compliances

  /// Sum of the noise's variances of `rows` rows from `first` on, m^2.
  double noiseSquares(Eigen::Index first, Eigen::Index rows) const;
};

/// All equations of the gap at one point of linearisation.
struct LinearSystem {
  GapLayout layout;
  std::vector<GapPosture> postures;
  Eigen::MatrixXd sweeps;  ///< [A y]^T [A y] of the sweeps, and of what is known beforehand
  Eigen::Index sweep_rows = 0;
  Eigen::Index loading_rows = 0;
  double state_noise = 0.0;  ///< rms noise of one state's displacement, per coordinate, m
};

/// Effect parameters (all of them, zero where not) whose effect `state` already contains: in the unloaded
/// arm's places, in the displacements' equations. Empty: none.
struct ContainedEffects {
  Eigen::VectorXd in_positions, in_deflections;
};

/// Fills the equations. What `state` contains is added back: the right sides are those of whole effects, not
/// of the rest.
LinearSystem linearSystem(const SystemInput& input, const SystemState& state, const ContainedEffects& effects_now);

GapLayout gapLayout(const std::vector<effects::EffectModel>& models, std::size_t targets);

}  // namespace stiffscope::diagnosis
