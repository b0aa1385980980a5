#include "core/effects/all.h"

namespace stiffscope::effects {

// The tracker, or the robot, moved between the frame sweeps and the loading: every reading of the loading is
// shifted by a small rigid motion, rotation about the middle of the readings (rad), then shift (m). It shows
// in absolute positions, not in the sweeps; a deflection does not see it.

namespace {

Eigen::MatrixXd frameErrorOffset(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  return state.pose < 0 ? Eigen::MatrixXd::Zero(state.rows(), 6) : at.byMovedInstrument(state);
}

void frameErrorCorrect(const JointVector&, LinearizationPoint&, Corrections& corrections, Eigen::VectorXd& own) {
  corrections.frame = own;
}

Remark frameErrorMissing(const CampaignContents& has) {
  if (!has.weights && !has.nests) return Remark(RemarkId::frame_needs_masses_or_nests);
  if (has.weights && (!has.absolute || !has.sweeps)) return Remark(RemarkId::frame_needs_sweeps_and_positions);
  return {};
}

std::vector<EffectModel> frameErrorModels(const ModelScope&) {
  return {{.parts = {rigidMotionPart(0.1)}, .offset = &frameErrorOffset, .correct = &frameErrorCorrect}};
}

}  // namespace

const EffectRecord& frameError() {
  static const EffectRecord record{.effect = Effect::frame_error,
                                   .nature = EffectNature::measurement,
                                   .missing = &frameErrorMissing,
                                   .models = &frameErrorModels};
  return record;
}

}  // namespace stiffscope::effects
