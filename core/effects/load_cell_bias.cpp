#include "core/effects/all.h"

namespace stiffscope::effects {

// A constant force added to, or missing from, the readings of loaded states (not of unloaded ones or of
// returns to zero): the true force is the reading plus b. Constant in the cell's axes (an amplifier's zero),
// or constant along gravity (a shackle that hangs with the load and was not weighed). b in N, at most 2 kN.
// Bilinear with the compliances.

namespace {

Eigen::MatrixXd byForces(const LinearizationPoint& at, const ArmState& state, const Eigen::Vector3d& point,
                         const Eigen::Matrix3Xd& forces) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(state.rows(), forces.cols());
  if (!state.loaded) return columns;
  for (Eigen::Index k = 0; k < forces.cols(); ++k) {
    columns.col(k) = bySprings(at, state, {point, forces.col(k), Eigen::Vector3d::Zero()});
  }
  return columns;
}

Eigen::MatrixXd inCell(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  return byForces(at, posture[i], posture[i].load.point, posture[i].cell_axes);
}

Eigen::MatrixXd alongGravity(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  return byForces(at, state, state.load.point + state.flange.linear() * at.load_offset, at.down);
}

void correctForce(const JointVector&, LinearizationPoint&, Corrections& corrections, Eigen::VectorXd& own) {
  corrections.cell_force = own;
}

void correctWeight(const JointVector&, LinearizationPoint&, Corrections& corrections, Eigen::VectorXd& own) {
  corrections.missing_weight = own[0];
}

Remark loadCellBiasMissing(const CampaignContents& has) {
  if (has.load_steps < 2) return Remark(RemarkId::bias_needs_two_loads);
  return {};
}

std::vector<EffectModel> loadCellBiasModels(const ModelScope&) {
  return {{.shape = "constant in the cell's axes",
           .parts = {{"", {2e3, 2e3, 2e3}, false, "N", {"x", "y", "z"}}},
           .offset = &inCell,
           .correct = &correctForce},
          {.shape = "constant along gravity",
           .parts = {{"", {2e3}, false, "N"}},
           .offset = &alongGravity,
           .correct = &correctWeight}};
}

}  // namespace

const EffectRecord& loadCellBias() {
  static const EffectRecord record{.effect = Effect::load_cell_bias,
                                   .nature = EffectNature::measurement,
                                   .missing = &loadCellBiasMissing,
                                   .models = &loadCellBiasModels};
  return record;
}

}  // namespace stiffscope::effects
