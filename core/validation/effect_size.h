#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/robot/robot.h"
#include "core/simulation/machine.h"
#include "core/simulation/spec.h"

namespace stiffscope::validation {

/// How large an effect is, found by measuring the same machine with and without it, without noise.
///
/// Deflection. With d the displacements of all poses, later steps and targets, and A(w) the columns of
/// joint compliance, one a joint, for the wrenches w as they are read,
///   g = (d_with - A(w_with) c) - (d_without - A(w_without) c)
/// (c the true compliances; a wrong reading moves A, a wrong machine d), whitened by the declared tracker
/// noise of one state's displacement (mean of its repeats, less that of step 0) and projected off A(w_with):
/// `deflection` is the rms of what is left, a number of times that noise.
///
/// Positions. The difference of all unloaded readings (sweeps, wrist sweep, step 0), less one common rigid
/// motion and a shift of each target on the flange, which any analysis is free to fit: `positions` is the rms
/// of step 0's part over the noise of one state's position (repeats averaged) and, `nests` aside, the clean
/// machine's own departures from the nominal geometry, found in the same way, and where its carriage stands elsewhere
/// than a rail reports. What nests see is judged without those, because nests have none.
///
/// Of an arm on a rail points are those with the carriage at zero, by the positions that are reported.
struct EffectSize {
  double deflection = 0.0;
  double positions = 0.0;
  double nests = 0.0;  ///< positions over tracker noise alone
  /// On a day without a load (GeometrySizer): what the URDF misses the more, over what it misses of every machine.
  double geometry = 0.0;
  /// 1 - rms after / rms before of the displacements' residuals (plain, m) when the effect is known and taken
  /// out, the joints' compliances fitted both times to the other postures than the one judged, as a promise for
  /// postures that took no part is: without noise, and as it can be seen with the tracker's true noise in
  /// both. A residual is d - A c less the same of a machine that has nothing but the springs: finite turns, and what
  /// the own weight's torque changes as a soft arm gives, which an identification knows and A does not.
  double shrink = 0.0, shrink_seen = 0.0;
};

/// The machine without the effect, to compare with.
class EffectSizer {
 public:
  explicit EffectSizer(const simulation::SimulationSpec& clean);

  /// `with` is the same specification with the effect. Throws InputError where that machine does not stand.
  EffectSize measure(const simulation::SimulationSpec& with) const;

  /// The clean machine's own residual of displacements, in the same unit: bearings, finite rotations.
  double background() const { return background_; }

 private:
  /// Per pose, later step and target, three coordinates along and across the tracker's line of sight.
  struct Deflections {
    Eigen::VectorXd displacement;  ///< m
    Eigen::MatrixXd columns;       ///< times compliance, m
  };
  Deflections deflections(const campaign::Campaign& campaign) const;
  std::vector<Eigen::Index> identifiableBy(const Deflections& of) const;  ///< joints that noise does not hide
  Eigen::VectorXd leftOver(const Deflections& of, const Eigen::VectorXd& gap) const;  ///< m
  Eigen::VectorXd leftHeldOut(const Deflections& of,
                              const Eigen::VectorXd& gap) const;  ///< m; posture by posture
  double whitened(const Eigen::VectorXd& residual) const;         ///< rms
  double positionsLeft(const Eigen::VectorXd& difference) const;  ///< m
  void designPositions();
  /// What a carriage's reported position moves the arm by, in base_link, m; of an arm on no rail nothing.
  Eigen::Vector3d travel(double carriage) const;

  std::vector<Eigen::Index> pose_ends_;  ///< rows of the deflections, past the last of each pose
  Eigen::Matrix3d base_from_tracker_;
  Eigen::Vector3d station_in_base_;
  Eigen::Vector3d rail_in_base_ = Eigen::Vector3d::Zero();
  double true_noise_factor_ = 1.0;
  robot::Robot geometry_;  ///< true and rigid
  JointVector compliance_;
  campaign::Campaign reference_;
  Deflections undisturbed_;
  Eigen::VectorXd finite_;                  ///< d - A c of the springs alone, m
  std::vector<Eigen::Index> identifiable_;  ///< columns that are refitted
  Eigen::VectorXd displacement_sigma_;
  Eigen::VectorXd unloaded_, unloaded_sigma_;
  Eigen::Index first_of_step_0_ = 0;
  Eigen::HouseholderQR<Eigen::MatrixXd> nuisances_;  ///< whitened
  double position_noise_ = 0.0, geometry_background_ = 0.0, background_ = 0.0;
  double carriage_error_ = 0.0;  ///< m
};

/// How large an effect is on a day without a load, found by measuring the same machine with and without it, without
/// noise.
///
/// Positions. With p the mean readings of all postures and reflectors, and f(q) where the machine's true rigid arm
/// would show them at the joint angles as reported,
///   g = (p_with - f(q_with)) - (p_without - f(q_without)),
/// whitened by the declared noise of one position (mean of its repeats) and projected off the columns of a rigid
/// calibration: two offsets and two tilts of each axis, the robot's place, each reflector's place on the flange, with n
/// reflectors 30 + 3 n of a six-axis arm, by central differences of f; what of them the postures cannot tell apart is
/// left out by rank. `positions` is the rms of what is left per coordinate, in metres, over the rms of that noise.
/// Nothing here is the product's calibration: what judges it must not share its errors.
///
/// Geometry. The same g, projected off the robot's place and the reflectors' alone, over the hypot of the noise and
/// what the machine without the effect departs from its URDF, found in the same way.
///
/// The shrink is that of `positions`, plain rms: postures alternately fitted by the others, as a promise for postures
/// that took no part is; `shrink_seen` has the tracker's true noise in both, and what that does to the fit of geometry.
class GeometrySizer {
 public:
  explicit GeometrySizer(const simulation::SimulationSpec& clean);

  /// `with` is the same specification with the effect. Throws InputError where that machine does not stand.
  EffectSize measure(const simulation::SimulationSpec& with) const;

  /// What the machine without the effect departs from the calibrated geometry, in noises: nothing, but for rounding.
  double background() const { return background_; }

 private:
  /// Readings less the true rigid arm's at the reported angles, and those angles.
  struct Misfits {
    Eigen::VectorXd misfit;  ///< m, in sight axes of the reference
    std::vector<JointVector> q;
  };
  Misfits misfitsOf(const simulation::SimulationSpec& spec) const;
  Eigen::MatrixXd columnsAt(const std::vector<JointVector>& q) const;
  Eigen::VectorXd leftOver(const Eigen::MatrixXd& basis, const Eigen::VectorXd& gap) const;  ///< m
  Eigen::VectorXd leftHeldOut(const Eigen::VectorXd& gap) const;                             ///< m
  double noiseHeldOut() const;  ///< rms of noise in what is held out, m

  int axisParameters() const { return 4 * geometry_.axes(); }

  Eigen::Isometry3d tracker_from_base_;
  double true_noise_factor_ = 1.0;
  robot::Robot geometry_;  ///< true and rigid
  std::vector<Eigen::Vector3d> on_flange_;
  std::vector<int> pose_of_, target_of_;  ///< of each mean reading
  std::vector<Eigen::Matrix3d> sight_;    ///< of each
  Eigen::VectorXd sigma_, reference_;     ///< m
  Eigen::MatrixXd columns_;               ///< whitened, independent ones
  Eigen::MatrixXd basis_, frames_basis_;  ///< orthonormal: of all columns; of robot's and reflectors' places
  double noise_ = 0.0, background_ = 0.0, geometry_background_ = 0.0;
};

}  // namespace stiffscope::validation
