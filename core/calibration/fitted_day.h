#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/calibration/fitted_arm.h"

namespace stiffscope::calibration {

/// The arm and its readings at some values of all parameters.
class FittedDay {
 public:
  /// Keeps references to both.
  FittedDay(const UnloadedDay& day, const ArmFit& fit);

  const frames::PlacedArm& arm() const { return arm_; }
  const Eigen::Vector3d& station() const { return station_; }

  /// As reported, and what the effects turn the joints besides, rad.
  Vector6d anglesOf(const Posture& posture) const;
  ReflectorAt reflector(const frames::PlacedPosture& placed, const Reading& reading) const;
  /// Measured less modelled, in base_link, m.
  Eigen::Vector3d residual(const Posture& posture, const Reading& reading, const ReflectorAt& at) const;
  /// L^-1 of the residual's covariance L L^T: the tracker's, and what the model leaves beyond it.
  Eigen::Matrix3d whitening(const Reading& reading) const;
  /// Of where a reading is modelled by (steps, sizes): 3 rows; those of the axes are zero without `axes`.
  void derivatives(const Posture& posture, const frames::PlacedPosture& placed, const ReflectorAt& at, bool axes,
                   Eigen::Ref<Eigen::MatrixXd> columns) const;

 private:
  const ArmFit& fit_;
  frames::PlacedArm arm_;
  Eigen::Vector3d station_;
  std::vector<const EffectTerm*> terms_;
};

/// Measured less modelled of every reading of a day, in the order of the day, in base_link, m.
std::vector<Eigen::Vector3d> residualsOf(const UnloadedDay& day, const ArmFit& fit);

/// Equations of the readings about a fit: whitened residuals and their derivatives by (steps, sizes of `fit`), a block
/// of rows a posture; only readings of weight above 0.
struct PostureEquations {
  Eigen::MatrixXd by_parameters;  ///< 3 rows a reading, by `fit.free`
  Eigen::MatrixXd by_angles;      ///< by the joint angles, 6 columns
  Eigen::MatrixXd by_motion;      ///< by a turn about the base origin (3) and a shift (3) of all that is seen
  Eigen::VectorXd residual;
  std::vector<int> targets;                ///< of each reading
  std::vector<Eigen::Matrix3d> whitening;  ///< of each reading
  std::vector<Eigen::Vector3d> positions;  ///< of each reading, as modelled
};
PostureEquations equationsOf(const UnloadedDay& day, const ArmFit& fit, std::size_t posture, std::size_t first_reading);

/// Whitened columns of terms in a posture, a column a term.
Eigen::MatrixXd columnsOf(const UnloadedDay& day, const ArmFit& fit, std::size_t posture,
                          const PostureEquations& equations, const std::vector<EffectTerm>& terms);

}  // namespace stiffscope::calibration
