#pragma once

#include "core/effects/effect_model.h"
#include "core/frames/arm_geometry.h"

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

}  // namespace stiffscope::diagnosis
