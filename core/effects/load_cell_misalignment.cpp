#include "core/effects/load_cell_misalignment.h"

namespace stiffscope::effects {

namespace {

Eigen::MatrixXd offset(const WorkingPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  Eigen::MatrixXd columns(state.rows(), 3);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = state.cell_axes.col(k);
    columns.col(k) =
        bySprings(at, state, {state.load.point, axis.cross(state.load.force), axis.cross(state.load.moment)});
  }
  return columns;
}

}  // namespace

EffectModel loadCellMisalignment() {
  return {Effect::load_cell_misalignment, "", {{"", {0.3, 0.3, 0.3}, false, "rad"}}, 1, &offset, nullptr};
}

}  // namespace stiffscope::effects
