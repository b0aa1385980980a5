#pragma once

#include <ceres/rotation.h>
#include <ceres/sized_cost_function.h>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/frames/arm_geometry.h"
#include "core/robot/robot.h"
#include "metrology/remark.h"

namespace stiffscope::frames {

/// One reflector in the unloaded state of one posture: the mean of its readings, in the frame of the loading
/// table.
struct UnloadedPosition {
  int pose = 0;
  int target = 0;
  Vector6d q = Vector6d::Zero();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  int readings = 0;
};

/// Of step 0, in the order of poses, then targets. Empty without `loading` or `states`.
std::vector<UnloadedPosition> unloadedPositions(const campaign::Campaign& campaign);

/// Where the base stands in the loading's readings, and the reflectors on the flange, found from postures
/// alone where no sweep places R0: a start for the calibration.
struct BaseFromPostures {
  Eigen::Isometry3d points_from_base = Eigen::Isometry3d::Identity();
  std::vector<std::optional<Eigen::Vector3d>> targets_at_zero;
};

/// The rotations of the reflector triangle from the first posture to each other one are those of the flange
/// seen from another frame: their rotation vectors, brought onto each other, give the base's direction; the
/// rest is linear. Empty with fewer than three reflectors common to three postures, or with rotations about
/// one axis only.
std::optional<BaseFromPostures> baseFromPostures(const LoadingGeometry& geometry,
                                                 const std::vector<UnloadedPosition>& positions,
                                                 std::size_t target_count);

/// Result of calibrating geometry, base and tool points on unloaded absolute positions.
struct GeometryCalibration {
  bool done = false;
  Remark reason;             ///< why not
  LoadingGeometry geometry;  ///< the calibrated one; its compliance is that of the start
  /// The geometry moved along each column of a root S of its covariance C = S S^T: by (J^T J)^-1 of the whitened
  /// residuals, times chi^2 over degrees of freedom where that is above one, or no tracker is declared.
  std::vector<LoadingGeometry> spread;
  double rms_before = 0.0;  ///< plain, per coordinate, m: the starting geometry
  double rms_after = 0.0;
  int positions = 0;          ///< unloaded reflector positions used
  int parameters = 0;         ///< that were estimated
  std::vector<Remark> fixed;  ///< parameters that the data cannot see, kept at their start
};

/// Partial Pose's first step (Wu, Klimchik et al.; paper IV.B): the four parameters of each joint axis, the
/// pose of the base in the loading's readings and the reflectors' places, by least squares on where the
/// reflectors stand unloaded in all postures (step 0), with the own weight's sag at `start.compliance` in the
/// model; weighted by the tracker's covariance where it is declared. Solved by Ceres (Levenberg-Marquardt,
/// automatic derivatives). Parameters that the positions do not see (the axes can be shifted against base and
/// tool) are found from the rank of the Jacobian, fixed and named. Not done, with the reason: without
/// absolute unloaded points, with fewer positions than parameters, or where the base's place can neither be
/// taken from the sweeps nor from three or more reflectors.
GeometryCalibration calibrateGeometry(const campaign::Campaign& campaign, const LoadingGeometry& start);

/// Estimated numbers, as steps from the start: per axis shift_u, shift_v (m), tilt_u, tilt_v (rad); the
/// base's small motion, rotation vector then translation, in the readings' frame; the reflectors' places at
/// zero (m).
struct CalibrationParameters {
  std::array<double, 24> axes{};
  std::array<double, 6> base{};
  std::vector<std::array<double, 3>> targets;
};

struct CalibrationStart {
  std::array<metrology::Line, 6> axes;
  std::array<Eigen::Vector3d, 6> across_u, across_v;
  Eigen::Isometry3d points_from_base;
};

/// Residual: measured minus modelled place of one reflector, in the readings' frame, whitened.
struct PositionResidual {
  const CalibrationStart& start;
  Vector6d q;  // with the sag in
  Eigen::Vector3d measured;
  Eigen::Matrix3d whiten;

  /// A point turned about a joint's axis by its angle, the axis moved by its four numbers `own`.
  template <class T>
  Eigen::Matrix<T, 3, 1> turned(int joint, const T* own, const Eigen::Matrix<T, 3, 1>& x) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const auto j = static_cast<std::size_t>(joint);
    const Vector point =
        start.axes[j].point.cast<T>() + start.across_u[j].cast<T>() * own[0] + start.across_v[j].cast<T>() * own[1];
    const Vector direction = (start.axes[j].direction.cast<T>() + start.across_u[j].cast<T>() * own[2] +
                              start.across_v[j].cast<T>() * own[3])
                                 .normalized();
    const Vector from = x - point;
    const double cosine = std::cos(q[joint]), sine = std::sin(q[joint]);
    return point + from * T(cosine) + direction.cross(from) * T(sine) +
           direction * (direction.dot(from) * T(1.0 - cosine));
  }

  /// A point of the arm's base in the readings' frame, that moved by `base`.
  template <class T>
  Eigen::Matrix<T, 3, 1> placed(const T* base, const Eigen::Matrix<T, 3, 1>& x) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Vector at_start =
        start.points_from_base.linear().cast<T>() * x + start.points_from_base.translation().cast<T>();
    Vector moved;
    ceres::AngleAxisRotatePoint(base, at_start.data(), moved.data());
    return moved + Vector(base[3], base[4], base[5]);
  }

  template <class T>
  bool operator()(const T* axes, const T* base, const T* target, T* residual) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    Vector x(target[0], target[1], target[2]);
    // Innermost turn first: exp(xi_1 q_1) ... exp(xi_6 q_6) x.
    for (int joint = 5; joint >= 0; --joint) x = turned(joint, axes + 4 * joint, x);
    Eigen::Map<Vector>(residual, 3) = whiten.cast<T>() * (measured.cast<T>() - placed(base, x));
    return true;
  }
};

/// PositionResidual with its derivatives by axes, base and target. A joint's turn depends on that axis's four numbers
/// and on the point that it turns, so each is differentiated by those seven alone and the chain is multiplied out from
/// the base to the target: a tenth of the work of carrying all 33 derivatives through every step.
class PositionCost : public ceres::SizedCostFunction<3, 24, 6, 3> {
 public:
  explicit PositionCost(PositionResidual residual) : residual_(std::move(residual)) {}

  const PositionResidual& residual() const { return residual_; }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;

 private:
  PositionResidual residual_;
};

}  // namespace stiffscope::frames
