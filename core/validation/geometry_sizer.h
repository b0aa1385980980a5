#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/robot/robot.h"
#include "core/simulation/spec.h"
#include "core/validation/effect_size.h"

namespace stiffscope::validation {

/// How large an effect is on a day without a load, found by measuring the same machine with and without it, without
/// noise.
///
/// Positions. With p the mean readings of all postures and reflectors, and f(q) where the machine's true rigid arm
/// would show them at the joint angles as reported,
///   g = (p_with - f(q_with)) - (p_without - f(q_without)),
/// whitened by the declared noise of one position (mean of its repeats) and projected off the columns of a rigid
/// calibration: two offsets and two tilts of each of six axes, the robot's place, each reflector's place on the flange,
/// 30 + 3 n, by central differences of f; what of them the postures cannot tell apart is left out by rank. `positions`
/// is the rms of what is left per coordinate, in metres, over the rms of that noise. Nothing here is the product's
/// calibration: what judges it must not share its errors.
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
    std::vector<Vector6d> q;
  };
  Misfits misfitsOf(const simulation::SimulationSpec& spec) const;
  Eigen::MatrixXd columnsAt(const std::vector<Vector6d>& q) const;
  Eigen::VectorXd leftOver(const Eigen::MatrixXd& basis, const Eigen::VectorXd& gap) const;  ///< m
  Eigen::VectorXd leftHeldOut(const Eigen::VectorXd& gap) const;                             ///< m
  double noiseHeldOut() const;  ///< rms of noise in what is held out, m

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
