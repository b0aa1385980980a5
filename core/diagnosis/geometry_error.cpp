#include "core/diagnosis/geometry_error.h"

#include <Eigen/Dense>
#include <algorithm>

#include "core/frames/arm_parameters.h"
#include "metrology/linear_algebra.h"
#include "metrology/lines.h"

namespace stiffscope::diagnosis {

namespace {

/// URDF axes in R0 by the rule of the campaign format.
robot::ArmAxes nominalIn(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry) {
  robot::ArmAxes axes = campaign.robot.axes_in_base_at_zero;
  for (metrology::Line& axis : axes) {
    axis = {geometry.r0_from_base_link * axis.point, geometry.r0_from_base_link.linear() * axis.direction};
  }
  return axes;
}

std::vector<JointVector> posturesOf(const campaign::Campaign& campaign) {
  std::vector<JointVector> postures;
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
  const std::vector<JointVector> postures = posturesOf(input.campaign);
  if (!input.absolute || postures.size() < 4) {
    error.reason = Remark(RemarkId::geometry_needs_positions);
    return error;
  }
  const frames::AxesAtStart nominal = frames::axesAtStart(nominalIn(input.campaign, state.geometry));
  const auto& found_axes = state.geometry.arm.axes_in_base_at_zero;
  std::vector<Eigen::Vector3d> targets;
  for (const auto& target : state.geometry.targets_at_zero) {
    if (target) targets.push_back(*target);
  }
  const auto found = targets;
  const auto count = static_cast<Eigen::Index>(targets.size());
  const auto rows = 3 * count * static_cast<Eigen::Index>(postures.size());
  Vector6d base = Vector6d::Zero();
  double zero = 0.0;
  const frames::ArmParameters steps(input.campaign.robot.axes());
  constexpr int kRounds = 5;
  for (int round = 0; round < kRounds; ++round) {
    const bool spring = state.at.compensator.size() > 0;  // its constant torque is a zero of joint 2
    const frames::PlacedArm arm(nominal, Eigen::Vector3d::Zero(), frames::AxesSteps::Zero(steps.axes()), base);
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(rows, 6 + 3 * count + 1);
    Eigen::VectorXd left(rows);
    Eigen::Index row = 0;
    for (const JointVector& q : postures) {
      const Eigen::Isometry3d truth = robot::postureAt(state.geometry.arm, q).motion.back();
      const frames::PlacedPosture model(arm, q + zero * JointVector::Unit(q.size(), 1));
      for (Eigen::Index t = 0; t < count; ++t, row += 3) {
        const auto k = static_cast<std::size_t>(t);
        const Eigen::Vector3d place = model.position(targets[k]);
        left.segment<3>(row) = truth * found[k] - place;
        columns.block<3, 6>(row, 0) = model.byBase(place);
        columns.block<3, 3>(row, 6 + 3 * t) = model.byTarget();
        if (spring) columns.col(6 + 3 * count).segment<3>(row) = model.byAngles(place).col(1);
      }
    }
    const Eigen::VectorXd step = leastSquaresSolution(columns, left);
    error.rms = (left - columns * step).norm() / std::sqrt(static_cast<double>(rows));
    base += step.head<6>();
    zero += step[6 + 3 * count];
    for (Eigen::Index t = 0; t < count; ++t) targets[static_cast<std::size_t>(t)] += step.segment<3>(6 + 3 * t);
  }
  for (std::size_t j = 0; j < found_axes.size(); ++j) {
    const metrology::Line& axis = nominal[j].line;
    const Eigen::Vector3d off = metrology::nearestPoint(found_axes[j], axis.point) - axis.point;
    error.largest_shift = std::max(error.largest_shift, (off - axis.direction * axis.direction.dot(off)).norm());
    error.largest_tilt = std::max(error.largest_tilt, axis.direction.cross(found_axes[j].direction).norm());
  }
  error.tested = true;
  return error;
}

}  // namespace stiffscope::diagnosis
