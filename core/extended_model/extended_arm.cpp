#include "core/extended_model/extended_arm.h"

#include <array>

#include "core/effects/effect_model.h"
#include "core/effects/gravity_equilibrium.h"
#include "core/robot/wrench.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::extended_model {

namespace {

constexpr int kTool = 7;  // beyond the six bodies

/// The body that an element's motion carries along, with all beyond it: 0 the base, 7 the tool. An element at joint j
/// (from 1) or at the tip of link j moves body j.
int bodyOf(effects::Effect effect, std::size_t part) {
  switch (effect) {
    case effects::Effect::bearing_tilt:
    case effects::Effect::link_compliance:
      return static_cast<int>(part) + 1;
    case effects::Effect::tool_compliance:
      return kTool;
    default:
      return 0;
  }
}

/// About which an element's motion turns.
Eigen::Vector3d pivotOf(effects::Effect effect, std::size_t part, const effects::ArmState& state, const effects::WorkingPoint& at) {
  switch (effect) {
    case effects::Effect::bearing_tilt:
      return state.axes[part].point;
    case effects::Effect::link_compliance:
      return state.axes[part + 1].point;
    case effects::Effect::tool_compliance:
      return state.flange.translation();
    default:
      return at.r0_from_base_link.translation();
  }
}

}  // namespace

/// What the effects do at one place of the arm.
struct ImprovedArm::Give {
  Vector6d angles = Vector6d::Zero();
  std::array<Eigen::Isometry3d, kTool + 1> motions;

  Give() { motions.fill(Eigen::Isometry3d::Identity()); }
};

ImprovedArm::ImprovedArm(const EffectFit& effects, const Eigen::VectorXd& parameters, const frames::LoadingGeometry& geometry,
                         const Vector6d& compliance)
    : effects_(effects), geometry_(geometry), compliance_(compliance) {
  const diagnosis::GapLayout& layout = effects.fit.data.layout;
  for (const diagnosis::ChosenModel& one : effects.fit.set.models) {
    const effects::EffectModel& model = effects.input->models[one.model];
    if (effects::natureOf(model.effect) != effects::EffectNature::machine) continue;
    const Eigen::VectorXd own = parameters.segment(layout.model_at[one.model] - layout.effects,
                                                   static_cast<Eigen::Index>(model.parameters()));
    if (!own.isZero(0.0)) machine_.emplace_back(&model, own);
  }
}

ImprovedArm::Give ImprovedArm::giveOf(const effects::PostureStates& posture, std::size_t s) const {
  const effects::WorkingPoint& at = effects_.fit.state.at;
  Give give;
  for (const auto& [model, own] : machine_) {
    if (model->angles) {
      give.angles += model->angles(at, posture, s) * own;
      continue;
    }
    const Eigen::MatrixXd columns = model->offset(at, posture, s);
    Eigen::Index next = 0;
    for (std::size_t part = 0; part < model->parts.size(); ++part) {
      const auto count = static_cast<Eigen::Index>(model->parts[part].most.size());
      Vector6d motion = effects::probedMotion(columns.middleCols(next, count) * own.segment(next, count));
      next += count;
      if (motion.isZero(0.0)) continue;
      const Eigen::Vector3d pivot = pivotOf(model->effect, part, posture[s], at);
      motion.tail<3>() += motion.head<3>().cross(pivot - posture[s].points.front());
      auto& there = give.motions[static_cast<std::size_t>(bodyOf(model->effect, part))];
      there = metrology::motionAbout(pivot, motion) * there;
    }
  }
  return give;
}

std::optional<Eigen::Isometry3d> ImprovedArm::toolMotion(const effects::PostureStates& posture, std::size_t s,
                                                         const ToolLoad* load) const {
  constexpr int kMostSteps = 60;
  constexpr double kSettled = 1e-10;  // rad
  effects::PostureStates states = posture;
  effects::ArmState& state = states[s];
  Vector6d angles = state.q;
  Give give;
  Eigen::Isometry3d last = Eigen::Isometry3d::Identity();
  for (int step = 0; step < kMostSteps; ++step) {
    robot::ArmPosture place;
    place.motion[0] = give.motions[0];
    const robot::ArmPosture turned = robot::postureAt(geometry_.arm, angles);
    for (std::size_t b = 1; b <= 6; ++b) {
      const Eigen::Isometry3d own = turned.motion[b - 1].inverse() * turned.motion[b];
      place.motion[b] = give.motions[b] * place.motion[b - 1] * own;
    }
    const Eigen::Isometry3d tool = give.motions[kTool] * place.motion[6];
    if (step > 0 && (tool.matrix() - last.matrix()).cwiseAbs().maxCoeff() < kSettled) return tool;
    last = tool;
    state.posture = place;
    effects::placeByPosture(geometry_, state);
    if (s == 0) state.turned = angles;
    state.load = load ? robot::Wrench{tool * load->point_at_zero, load->force, load->moment} : robot::Wrench{};
    state.load_torque = load ? robot::jointTorque(geometry_.arm, place, state.load) : Vector6d::Zero();
    state.points = effects::probesAt(state.flange.translation());
    give = giveOf(states, s);
    angles = state.q + compliance_.cwiseProduct(effects::totalTorque(state)) + give.angles;
  }
  return std::nullopt;
}

}  // namespace stiffscope::extended_model
