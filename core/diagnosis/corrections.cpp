#include "core/diagnosis/corrections.h"
#include "metrology/rigid_motion.h"


namespace stiffscope {

namespace {

/// Parameters of one model in a vector of all effects' parameters.
Eigen::VectorXd ownOf(const GapInput& input, const GapLayout& layout, const Eigen::VectorXd& effects,
                      std::size_t m) {
  return effects.segment(layout.model_at[m] - layout.effects,
                         static_cast<Eigen::Index>(input.models[m].parameters()));
}

/// Effects that the equations contain once they are estimated: a corrected wrench, frame or unloaded place.
bool isCorrection(Effect effect) {
  return effect == Effect::load_point_error || effect == Effect::load_cell_misalignment ||
         effect == Effect::load_cell_bias || effect == Effect::frame_error ||
         effect == Effect::gravity_compensator;
}

}  // namespace

bool becomesPart(const EffectModel& model) {
  return model.angles || !model.first_body.empty() || isCorrection(model.effect);
}

bool isBilinear(const EffectModel& model) { return isCorrection(model.effect); }

ContainedEffects correct(const GapInput& input, const GapLayout& layout, const FittedSet& set,
                         const Eigen::VectorXd& nuisances, GapState& state) {
  const Vector6d before = state.at.compliance;
  state.at.compliance = nuisances.head<6>().cwiseMax(0.0);
  state.geometry.compliance = state.geometry.weight.links_known ? state.at.compliance : Vector6d::Zero();
  const Eigen::VectorXd steps = nuisances.segment(layout.geometry, layout.weights - layout.geometry);
  if (input.absolute) {
    const LoadingGeometry there = moved(state.geometry, steps, state.at.epoch_centre);
    state.r0_from_sweeps =
        motionAbout(state.at.epoch_centre, steps.segment<6>(GeometrySteps::kAxes)) * state.r0_from_sweeps;
    state.geometry = there;
  }
  state.corrections = {};
  state.at.compensator.resize(0);
  ContainedEffects contained{Eigen::VectorXd::Zero(set.effects.size()),
                             Eigen::VectorXd::Zero(set.effects.size())};
  state.at.turns.clear();
  state.at.motions.clear();
  state.at.harder_by_square.setZero();
  state.at.harder_by_size.setZero();
  for (const ChosenModel& one : set.models) {
    const EffectModel& model = input.models[one.model];
    Eigen::VectorXd own = ownOf(input, layout, set.effects, one.model);
    const Eigen::Index at = layout.model_at[one.model] - layout.effects;
    switch (model.effect) {
      case Effect::load_point_error:
        state.corrections.load_point = own;
        break;
      case Effect::load_cell_misalignment:
        state.corrections.cell_turn = own;
        break;
      case Effect::load_cell_bias:
        if (own.size() == 3) state.corrections.cell_force = own;
        if (own.size() == 1) state.corrections.missing_weight = own[0];
        break;
      case Effect::frame_error:
        state.corrections.frame = own;
        break;
      case Effect::gravity_compensator:
        // The torque turns the joint by the compliance of the equations it was found in.
        if (before[1] <= 0.0 || state.at.compliance[1] <= 0.0) continue;
        own *= before[1] / state.at.compliance[1];
        state.at.compensator = own;
        break;
      default:
        break;
    }
    if (model.settle) model.settle(state.at, own);
    if (model.angles) state.at.turns.push_back({model.angles, own});
    if (!model.first_body.empty()) state.at.motions.push_back({model.offset, model.first_body, own});
    const bool in_deflections = model.effect == Effect::gravity_compensator || !model.angles;
    if (becomesPart(model)) contained.in_positions.segment(at, own.size()) = own;
    if (in_deflections && isCorrection(model.effect)) contained.in_deflections.segment(at, own.size()) = own;
  }
  return contained;
}

}  // namespace stiffscope
