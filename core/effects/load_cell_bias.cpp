#include "core/effects/load_cell_bias.h"

namespace stiffscope::effects {

namespace {

Eigen::MatrixXd byForces(const WorkingPoint& at, const ArmState& state, const Eigen::Vector3d& point,
                         const Eigen::Matrix3Xd& forces) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(state.rows(), forces.cols());
  if (!state.loaded) return columns;
  for (Eigen::Index k = 0; k < forces.cols(); ++k) {
    columns.col(k) = bySprings(at, state, {point, forces.col(k), Eigen::Vector3d::Zero()});
  }
  return columns;
}

Eigen::MatrixXd inCell(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  return byForces(at, posture[i], posture[i].load.point, posture[i].cell_axes);
}

Eigen::MatrixXd alongGravity(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  return byForces(at, state, state.load.point + state.flange.linear() * at.load_offset,
                  -at.r0_from_base_link.linear().col(2));
}

}  // namespace

EffectModel loadCellBias() {
  return {Effect::load_cell_bias,
          "constant in the cell's axes",
          {{"", {2e3, 2e3, 2e3}, false, "N"}},
          1,
          &inCell,
          nullptr};
}

EffectModel loadCellMissingWeight() {
  return {
      Effect::load_cell_bias, "constant along gravity", {{"", {2e3}, false, "N"}}, 1, &alongGravity, nullptr};
}

}  // namespace stiffscope::effects
