#include "core/extended_model/effect_offsets.h"

#include <algorithm>

#include "core/effects/elastic_arm.h"
#include "core/effects/gravity_equilibrium.h"
#include "core/extended_model/effect_fit.h"

namespace stiffscope::extended_model {

namespace {

/// Whether the effect shifts readings: other faults of the measurement act through the wrench or the frame.
bool shiftsReadings(const effects::EffectModel& model) {
  return effects::natureOf(model.effect) == effects::EffectNature::measurement && !model.correct;
}

bool hasMachine(const EffectFit& effects) {
  return std::any_of(
      effects.fit.set.models.begin(), effects.fit.set.models.end(), [&](const diagnosis::ChosenModel& one) {
        return effects::natureOf(effects.input->models[one.model].effect) == effects::EffectNature::machine;
      });
}

}  // namespace

PostureOffsets::PostureOffsets(const EffectFit& effects, const effects::PostureStates& posture, Which which)
    : effects_(effects), posture_(posture), which_(which) {
  if (!which.machine || !hasMachine(effects)) return;
  const diagnosis::SystemState& state = effects.fit.state;
  const effects::ElasticArm with(state.geometry, state.at.compliance, state.at,
                                 machineEffects(effects, effects.parameters()));
  const effects::ElasticArm springs(state.geometry, state.at.compliance, state.at, {});
  effects::PostureStates states = posture;
  for (std::size_t s = 0; s < posture.size(); ++s) {
    effects::ToolLoad load{{}, posture[s].load.force, posture[s].load.moment};
    const auto restOf = [&](const effects::ElasticArm& arm) {
      if (s > 0) load.point_at_zero = with_.front().inverse() * posture[s].load.point;
      return arm.toolMotion(states, s, s > 0 ? &load : nullptr);
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
  effects::PostureStates states;
  std::vector<Eigen::Vector3d> offsets(posture_.size(), Eigen::Vector3d::Zero());
  for (const diagnosis::ChosenModel& one : effects_.fit.set.models) {
    const effects::EffectModel& model = effects_.input->models[one.model];
    const bool wanted =
        machine ? effects::natureOf(model.effect) == effects::EffectNature::machine : shiftsReadings(model);
    if (!wanted) continue;
    if (states.empty()) {
      states = posture_;
      for (effects::ArmState& state : states) state.targets = {target}, state.points = {place};
    }
    const Eigen::VectorXd own = effects_.parametersOf(one);
    for (std::size_t s = 0; s < states.size(); ++s) offsets[s] += model.columns(effects_.fit.state.at, states, s) * own;
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

EffectColumns columnsOf(const EffectFit& effects) {
  EffectColumns columns{{}, effects.free};
  for (const diagnosis::ChosenModel& one : effects.fit.set.models) columns.models.push_back(one.model);
  return columns;
}

Eigen::MatrixXd displacementByEffects(const diagnosis::SystemInput& input, const diagnosis::GapFit& fit,
                                      const EffectColumns& columns, const effects::PostureStates& posture,
                                      std::size_t state, const std::vector<int>& targets,
                                      const std::vector<Eigen::Vector3d>& places) {
  effects::PostureStates states = posture;
  for (effects::ArmState& one : states) one.targets = targets, one.points = places;
  const auto rows = static_cast<Eigen::Index>(3 * targets.size());
  const diagnosis::GapLayout& layout = fit.data->layout;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(rows, layout.end - layout.effects);
  for (const std::size_t m : columns.models) {
    const effects::EffectModel& model = input.models[m];
    all.middleCols(layout.model_at[m] - layout.effects, static_cast<Eigen::Index>(model.parameters())) =
        model.columns(fit.state.at, states, state) - model.columns(fit.state.at, states, 0);
  }
  return all(Eigen::all, columns.parameters);
}

Eigen::MatrixXd displacementBySteps(const EffectFit& effects, const Eigen::MatrixXd& steps, const JointVector& q,
                                    const effects::FlangeLoad& load,
                                    const std::vector<Eigen::Vector3d>& targets_in_flange) {
  const diagnosis::SystemState& state = effects.fit.state;
  const effects::ArmState& seen = effects.fit.data->postures.front().states.back();
  effects::ArmState rest = effects::gravityEquilibrium(state.geometry, state.at, q);
  rest.pose = effects.fit.data->postures.front().pose;
  std::vector<int> targets;
  std::vector<Eigen::Vector3d> places;
  for (const Eigen::Vector3d& target : targets_in_flange) {
    targets.push_back(static_cast<int>(targets.size()));
    places.push_back(rest.flange * target);
  }
  effects::ArmState loaded = rest;
  loaded.step = 1;
  loaded.loaded = true;
  loaded.cell_axes = rest.flange.linear() * seen.flange.linear().transpose() * seen.cell_axes;
  loaded.load = {rest.flange * load.point_in_flange, load.force, load.moment};
  loaded.load_torque = robot::jointTorque(state.geometry.arm, rest.posture, loaded.load);
  return displacementByEffects(*effects.input, effects.fit, columnsOf(effects), {rest, loaded}, 1, targets, places) *
         steps;
}

}  // namespace stiffscope::extended_model
