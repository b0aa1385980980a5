#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/diagnosis/system_rows.h"
#include "core/diagnosis/system_state.h"
#include "core/effects/effect_model.h"
#include "core/numerics/normal_equations.h"

namespace stiffscope::diagnosis {

/// Where everything stands in the parameter vector: joint compliances, geometry steps, own-weight factors by
/// body (nuisances), then the effects' models in their order.
struct GapLayout {
  Eigen::Index geometry = 0, weights = 0, effects = 0, end = 0;
  std::vector<Eigen::Index> model_at;  ///< first parameter of each model

  Eigen::Index joints() const { return geometry; }  ///< compliances come first
  Eigen::Index bodies() const { return effects - weights; }
};

/// What is known of compliances by those identified.
ComplianceExpected complianceExpected(const JointVector& identified);

/// [A y]^T [A y] of the compliances alone.
using StiffnessNormal =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostJoints + 1, kMostJoints + 1>;

/// Whitened normal equations of one posture of the loading: [A y]^T [A y].
struct GapPosture {
  int pose = 0;
  effects::PostureStates states;
  Eigen::MatrixXd columns;  ///< unwhitened: position rows first, then deflection rows
  Eigen::VectorXd right;
  Eigen::Index position_rows = 0;
  Eigen::MatrixXi readings;  ///< as in SystemRows, with what its wrench does
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 6>> by_wrench;
  std::vector<ReadFrom> read_from;
  /// Covariance of these rows by readings, wrench and a station between its rounds, within each state: its block of the
  /// diagonal, one state's under another's.
  Eigen::MatrixXd noise;
  /// That of one loaded state's rows with another's: their unloaded readings are the same. Empty with one loaded state.
  Eigen::MatrixXd noise_across;
  Eigen::MatrixXd position_lower;  ///< Cholesky factor of that of the position rows, inflated
  numerics::LowerTriangle normal;
  StiffnessNormal stiffness_normal;  ///< normal equations of deflection rows alone, over the compliances

  /// Sum of the noise's variances of `rows` rows from `first` on, m^2.
  double noiseSquares(Eigen::Index first, Eigen::Index rows) const;
};

/// Equations of the sweeps, [A y], as they are read: three rows a reading.
struct SweepEquations {
  Eigen::MatrixXd rows;
  std::vector<Eigen::Vector3d> points;  ///< of the readings, in R0
  std::vector<ReadFrom> read_from;      ///< of the readings; empty on a day of one station
};

/// All equations of the gap at one point of linearisation.
struct LinearSystem {
  GapLayout layout;
  std::vector<GapPosture> postures;
  Eigen::MatrixXd sweeps;      ///< [A y]^T [A y] of the sweeps, and of what is known beforehand
  Eigen::MatrixXd beforehand;  ///< of what is known beforehand alone
  SweepEquations as_read;      ///< kept where they may be weighed again: tens of megabytes
  Eigen::Index sweep_rows = 0;
  Eigen::Index loading_rows = 0;
  double state_noise = 0.0;  ///< rms noise of one state's displacement, per coordinate, m
};

/// Effect parameters (all of them, zero where not) whose effect `state` already contains: in the unloaded
/// arm's places, in the displacements' equations. Empty: none.
struct ContainedEffects {
  Eigen::VectorXd in_positions, in_deflections;
};

/// Whether equations will be weighed again.
enum class Weighed { once, again };

/// Fills the equations. What `state` contains is added back: the right sides are those of whole effects, not
/// of the rest.
LinearSystem linearSystem(const SystemInput& input, const SystemState& state, const ContainedEffects& effects_now,
                          Weighed weighed = Weighed::once);

class GeometryColumns;

/// The same where equations are made round after round: with the columns of the geometry at places where they were made
/// already, see there.
LinearSystem linearSystem(const SystemInput& input, const SystemState& state, const ContainedEffects& effects_now,
                          GeometryColumns& by_geometry, Weighed weighed = Weighed::once);

/// Weighs the equations made at `state` anew, where since then nothing but variances has changed in it: its factors on
/// those of absolute positions, and the error of the model. Lets the sweeps' equations go.
void weighAgain(const SystemInput& input, const SystemState& state, LinearSystem& data);

/// 1 / bound^2 of each parameter of the models, in their order: what the data do not see is kept from running away.
Eigen::VectorXd priorsOf(const std::vector<effects::EffectModel>& models);

GapLayout gapLayout(const std::vector<effects::EffectModel>& models, const robot::Robot& arm, std::size_t targets);

}  // namespace stiffscope::diagnosis
