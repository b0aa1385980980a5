#include "core/improved/taken_off.h"

#include <fmt/format.h>

#include <map>

#include "core/identification/without_postures.h"
#include "core/improved/corrected_wrenches.h"
#include "core/improved/effect_nature.h"
#include "core/improved/shifted_readings.h"

namespace stiffscope {

namespace {

Vector6d frameMotion(const EffectFit& effects, const Eigen::VectorXd& parameters) {
  for (const ChosenModel& one : effects.fit.set.models) {
    if (effects.input->models[one.model].effect != Effect::frame_error) continue;
    const GapLayout& layout = effects.fit.data.layout;
    return parameters.segment<6>(layout.model_at[one.model] - layout.effects);
  }
  return Vector6d::Zero();
}

void leaveOutUnknown(const EffectFit& effects, Campaign& campaign, std::vector<std::string>* left_out) {
  std::vector<OutlyingPosture> without;
  for (const State& row : campaign.states->rows) {
    const auto known = [&](const GapPosture& one) { return one.pose == row.pose; };
    const auto& postures = effects.fit.data.postures;
    if (row.step == 0 || std::any_of(postures.begin(), postures.end(), known)) continue;
    if (!without.empty() && without.back().posture == row.pose) continue;
    without.emplace_back();
    without.back().posture = row.pose;
    if (left_out == nullptr) continue;
    left_out->push_back(
        fmt::format("pose {}: no reflector read in all its load steps, so the effects cannot be taken off",
                    campaign.pose_ids[static_cast<std::size_t>(row.pose)]));
  }
  if (!without.empty()) campaign = withoutPostures(campaign, without);
}

}  // namespace

Campaign withoutEffects(const Campaign& campaign, const EffectFit& effects, const Eigen::VectorXd& parameters,
                        TakenOff which, std::vector<std::string>* left_out) {
  Campaign result = campaign;
  if (effects.fit.set.models.empty()) return result;
  leaveOutUnknown(effects, result, left_out);
  correctWrenches(effects, parameters, result);
  ShiftOptions options;
  options.which.machine = which != TakenOff::measurement;
  options.frame = frameMotion(effects, parameters);
  options.sweeps = which == TakenOff::everything;
  shiftReadings(effects, parameters, options, result);
  return result;
}

}  // namespace stiffscope
