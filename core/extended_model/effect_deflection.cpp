#include "core/extended_model/effect_deflection.h"

#include <algorithm>

#include "core/effects/all.h"
#include "core/effects/gravity_equilibrium.h"
#include "core/extended_model/effect_fit.h"
#include "core/extended_model/effect_offsets.h"
#include "core/robot/wrench.h"

namespace stiffscope::extended_model {

namespace {

effects::RestingFlange flangeOf(const ExtendedModel& model, const frames::LoadingGeometry& geometry,
                                const Eigen::VectorXd& parameters, const JointVector& compliance) {
  const auto arm = std::make_shared<const effects::ElasticArm>(geometry, compliance, model.effects.fit.state.at,
                                                               machineEffects(model.effects, parameters));
  return [&model, &geometry, arm](const JointVector& commands,
                                  const effects::FlangeLoad& load) -> std::optional<Eigen::Isometry3d> {
    const Eigen::Isometry3d& at_zero = geometry.arm.base_from_flange_at_zero;
    const effects::ArmState rest = effects::gravityEquilibrium(geometry, model.effects.fit.state.at, commands);
    effects::PostureStates states{rest, rest};
    states[1].step = 1;
    states[1].loaded = true;
    const bool loaded = !load.force.isZero(0.0) || !load.moment.isZero(0.0);
    const effects::ToolLoad own{at_zero * load.point_in_flange, load.force, load.moment};
    const auto motion = arm->toolMotion(states, loaded ? 1 : 0, loaded ? &own : nullptr);
    return motion ? std::optional<Eigen::Isometry3d>(*motion * at_zero) : std::nullopt;
  };
}

}  // namespace

bool deflectsByEffects(const EffectFit& effects) {
  return std::any_of(effects.added.begin(), effects.added.end(), [](const AddedEffect& one) {
    return effects::natureOf(one.effect) == effects::EffectNature::machine;
  });
}

effects::EffectDeflection effectDeflection(const ExtendedModel& model, identification::Method method) {
  const identification::MethodResult& own = model.with.of(method);
  const identification::StiffnessEstimate& estimate = own.estimate;
  effects::EffectDeflection give;
  give.flange = flangeOf(model, own.geometry, model.effects.parameters(), estimate.compliance);
  give.spring_covariance = estimate.covariance - estimate.parts.effects;
  const auto& columns = model.spread.compliance[static_cast<std::size_t>(method)];
  for (Eigen::Index k = 0; k < model.spread.parameters.cols(); ++k) {
    Eigen::VectorXd parameters = model.effects.parameters();
    for (std::size_t i = 0; i < model.effects.free.size(); ++i)
      parameters[model.effects.free[i]] += model.spread.parameters(static_cast<Eigen::Index>(i), k);
    give.varied.push_back(flangeOf(model, own.geometry, parameters, estimate.compliance + columns.col(k)));
  }
  return give;
}

Eigen::MatrixXd displacementByHidden(const ExtendedModel& model, identification::Method method,
                                     const JointVector& commands, const effects::FlangeLoad& load,
                                     const std::vector<Eigen::Vector3d>& points) {
  const diagnosis::GapStudy& study = *model.study;
  const frames::LoadingGeometry& geometry = model.with.of(method).geometry;
  const effects::ArmState rest = effects::gravityEquilibrium(geometry, study.fit.state.at, commands);
  effects::PostureStates states{rest, rest};
  states[1].step = 1;
  states[1].loaded = true;
  states[1].load = {rest.flange * load.point_in_flange, load.force, load.moment};
  states[1].load_torque = robot::jointTorque(geometry.arm, rest.posture, states[1].load);
  EffectColumns moving = model.hidden->draws.columns;
  std::erase_if(moving.models, [&](std::size_t m) {
    const effects::EffectNature nature = effects::natureOf(study.input->models[m].effect);
    return nature != effects::EffectNature::machine && nature != effects::EffectNature::load;
  });
  const std::vector<int> targets(points.size(), 0);  // none of these effects asks which point it is
  return displacementByEffects(*study.input, study.fit, moving, states, 1, targets, points);
}

}  // namespace stiffscope::extended_model
