#include "core/effects/all.h"

namespace stiffscope::effects {

// The load cell is turned against its declared axes by a small rotation w (the cell's axes, rad, at most 0.3):
// force and moment are in truth (I + w x) of what was read. Bilinear with the compliances.

namespace {

Eigen::MatrixXd loadCellMisalignmentOffset(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  Eigen::MatrixXd columns(state.rows(), 3);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = state.cell_axes.col(k);
    columns.col(k) =
        bySprings(at, state, {state.load.point, axis.cross(state.load.force), axis.cross(state.load.moment)});
  }
  return columns;
}

void loadCellMisalignmentCorrect(const JointVector&, LinearizationPoint&, Corrections& corrections,
                                 Eigen::VectorXd& own) {
  corrections.cell_turn = own;
}

std::vector<EffectModel> loadCellMisalignmentModels(const ModelScope&) {
  const EffectPart turn{"", {0.3, 0.3, 0.3}, false, "rad", {"turn about x", "turn about y", "turn about z"}};
  return {{.parts = {turn}, .offset = &loadCellMisalignmentOffset, .correct = &loadCellMisalignmentCorrect}};
}

}  // namespace

const EffectRecord& loadCellMisalignment() {
  static const EffectRecord record{.effect = Effect::load_cell_misalignment,
                                   .nature = EffectNature::measurement,
                                   .models = &loadCellMisalignmentModels};
  return record;
}

}  // namespace stiffscope::effects
