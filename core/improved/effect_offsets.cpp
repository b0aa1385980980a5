#include "core/improved/effect_offsets.h"

#include "core/improved/effect_nature.h"
#include "core/improved/improved_arm.h"

namespace stiffscope {

namespace {

/// Which effects shift readings, the others act through the wrench or the frame.
bool shiftsReadings(Effect effect) { return effect == Effect::target_motion || effect == Effect::tracker_drift; }

bool hasMachine(const EffectFit& effects) {
  for (const ChosenModel& one : effects.fit.set.models) {
    if (natureOf(effects.input->models[one.model].effect) == EffectNature::machine) return true;
  }
  return false;
}

}  // namespace

PostureOffsets::PostureOffsets(const EffectFit& effects, const Eigen::VectorXd& parameters, const PostureStates& posture,
                               Which which)
    : effects_(effects), parameters_(parameters), posture_(posture), which_(which) {
  if (!which.machine || !hasMachine(effects)) return;
  const GapState& state = effects.fit.state;
  const ImprovedArm with(effects, parameters, state.geometry, state.at.compliance);
  const ImprovedArm springs(effects, Eigen::VectorXd::Zero(parameters.size()), state.geometry, state.at.compliance);
  for (std::size_t s = 0; s < posture.size(); ++s) {
    ToolLoad load{{}, posture[s].load.force, posture[s].load.moment};
    const auto restOf = [&](const ImprovedArm& arm) {
      if (s > 0) load.point_at_zero = with_.front().inverse() * posture[s].load.point;
      return arm.toolMotion(posture, s, s > 0 ? &load : nullptr);
    };
    const auto one = restOf(with), other = restOf(springs);
    if (!one || !other) {
      with_.clear(), without_.clear();
      return;
    }
    with_.push_back(*one), without_.push_back(*other);
  }
}

std::vector<Eigen::Vector3d> PostureOffsets::linear(int target, const Eigen::Vector3d& place, bool machine) const {
  PostureStates states = posture_;
  for (ArmState& state : states) state.targets = {target}, state.points = {place};
  std::vector<Eigen::Vector3d> offsets(states.size(), Eigen::Vector3d::Zero());
  const GapLayout& layout = effects_.fit.data.layout;
  for (const ChosenModel& one : effects_.fit.set.models) {
    const EffectModel& model = effects_.input->models[one.model];
    const bool wanted = machine ? natureOf(model.effect) == EffectNature::machine : shiftsReadings(model.effect);
    if (!wanted) continue;
    const Eigen::VectorXd own = parameters_.segment(layout.model_at[one.model] - layout.effects,
                                                    static_cast<Eigen::Index>(model.parameters()));
    for (std::size_t s = 0; s < states.size(); ++s)
      offsets[s] += model.columns(effects_.fit.state.at, states, s) * own;
  }
  return offsets;
}

std::vector<Eigen::Vector3d> PostureOffsets::byMachine(const Eigen::Vector3d& place) const {
  std::vector<Eigen::Vector3d> offsets;
  const Eigen::Vector3d at_zero = with_.front().inverse() * place;
  for (std::size_t s = 0; s < with_.size(); ++s) offsets.push_back(with_[s] * at_zero - without_[s] * at_zero);
  return offsets;
}

std::vector<Eigen::Vector3d> PostureOffsets::of(int target, const Eigen::Vector3d& place) const {
  std::vector<Eigen::Vector3d> offsets(posture_.size(), Eigen::Vector3d::Zero());
  const auto add = [&](const std::vector<Eigen::Vector3d>& more) {
    for (std::size_t s = 0; s < offsets.size(); ++s) offsets[s] += more[s];
  };
  if (which_.readings) add(linear(target, place, false));
  if (which_.machine) add(with_.empty() ? linear(target, place, true) : byMachine(place));
  return offsets;
}

}  // namespace stiffscope
