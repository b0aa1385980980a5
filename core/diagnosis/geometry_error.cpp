#include "core/diagnosis/geometry_error.h"

#include <Eigen/Dense>
#include <algorithm>

#include "metrology/linear_algebra.h"
#include "metrology/lines.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::diagnosis {

namespace {

/// URDF axes in R0 by the rule of the campaign format.
robot::Robot nominalIn(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry) {
  robot::Robot robot = campaign.robot;
  for (metrology::Line& axis : robot.axes_in_base_at_zero) {
    axis = {geometry.r0_from_base_link * axis.point, geometry.r0_from_base_link.linear() * axis.direction};
  }
  return robot;
}

std::vector<Vector6d> posturesOf(const campaign::Campaign& campaign) {
  std::vector<Vector6d> postures;
  if (campaign.states) {
    for (const campaign::State& state : campaign.states->rows) {
      if (state.step == 0) postures.push_back(state.q);
    }
  }
  return postures;
}

}  // namespace

GeometryError geometryError(const SystemInput& input, const SystemState& state) {
  GeometryError error;
  error.limit = kGeometryTolerance;
  const std::vector<Vector6d> postures = posturesOf(input.campaign);
  if (!input.absolute || postures.size() < 4) {
    error.reason = Remark(RemarkId::geometry_needs_positions);
    return error;
  }
  const robot::Robot nominal = nominalIn(input.campaign, state.geometry);
  const auto& found_axes = state.geometry.arm.axes_in_base_at_zero;
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3d> targets;
  for (const auto& target : state.geometry.targets_at_zero) targets.push_back(target.value_or(Eigen::Vector3d::Zero()));
  const auto found = targets;
  const auto count = static_cast<Eigen::Index>(targets.size());
  const auto rows = 3 * count * static_cast<Eigen::Index>(postures.size());
  double zero = 0.0;
  constexpr int kRounds = 5;
  for (int round = 0; round < kRounds; ++round) {
    const bool spring = state.at.compensator.size() > 0;  // its constant torque is a zero of joint 2
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(rows, 6 + 3 * count + 1);
    Eigen::VectorXd left(rows);
    Eigen::Index row = 0;
    for (const Vector6d& q : postures) {
      const Eigen::Isometry3d truth = robot::postureAt(state.geometry.arm, q).motion[6];
      const robot::ArmPosture posture = robot::postureAt(nominal, q + zero * Vector6d::Unit(1));
      const Eigen::Isometry3d model = base * posture.motion[6];
      metrology::Line axis_2 = robot::axisAt(nominal, posture, 1);
      axis_2 = {base * axis_2.point, base.linear() * axis_2.direction};
      for (Eigen::Index t = 0; t < count; ++t, row += 3) {
        const auto k = static_cast<std::size_t>(t);
        const Eigen::Vector3d place = model * targets[k];
        left.segment<3>(row) = truth * found[k] - place;
        for (int axis = 0; axis < 3; ++axis) columns.block<3, 1>(row, axis) = Eigen::Vector3d::Unit(axis).cross(place);
        columns.block<3, 3>(row, 3).setIdentity();
        columns.block<3, 3>(row, 6 + 3 * t) = model.linear();
        if (spring) columns.col(6 + 3 * count).segment<3>(row) = axis_2.direction.cross(place - axis_2.point);
      }
    }
    const Eigen::VectorXd step = leastSquaresSolution(columns, left);
    error.rms = (left - columns * step).norm() / std::sqrt(static_cast<double>(rows));
    base = metrology::motionAbout(Eigen::Vector3d::Zero(), step.head<6>()) * base;
    zero += step[6 + 3 * count];
    for (Eigen::Index t = 0; t < count; ++t) targets[static_cast<std::size_t>(t)] += step.segment<3>(6 + 3 * t);
  }
  for (std::size_t j = 0; j < 6; ++j) {
    const metrology::Line& axis = nominal.axes_in_base_at_zero[j];
    const Eigen::Vector3d off = metrology::nearestPoint(found_axes[j], axis.point) - axis.point;
    error.largest_shift = std::max(error.largest_shift, (off - axis.direction * axis.direction.dot(off)).norm());
    error.largest_tilt = std::max(error.largest_tilt, axis.direction.cross(found_axes[j].direction).norm());
  }
  error.tested = true;
  return error;
}

}  // namespace stiffscope::diagnosis
