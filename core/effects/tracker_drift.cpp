#include "core/effects/all.h"

#include <cmath>

namespace stiffscope::effects {

// Readings wander with time: a rigid motion that grows with the time since the sweeps, rotation about the
// middle of the readings and shift, in rad and m over the whole of the loading.

namespace {

Eigen::MatrixXd trackerDriftOffset(const LinearizationPoint& at, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  if (!std::isfinite(state.time_s)) return Eigen::MatrixXd::Zero(state.rows(), 6);
  return (state.time_s - at.sweep_time) / at.time_span * at.byMovedInstrument(state);
}

Remark trackerDriftMissing(const CampaignContents& has) {
  if (!has.nests && (!has.times || !has.absolute)) return Remark(RemarkId::drift_needs_nests_or_timed_positions);
  return {};
}

std::vector<EffectModel> trackerDriftModels(const ModelScope&) {
  return {{.parts = {rigidMotionPart(0.05)}, .offset = &trackerDriftOffset}};
}

}  // namespace

const EffectRecord& trackerDrift() {
  static const EffectRecord record{.effect = Effect::tracker_drift,
                                   .nature = EffectNature::measurement,
                                   .missing = &trackerDriftMissing,
                                   .models = &trackerDriftModels};
  return record;
}

}  // namespace stiffscope::effects
