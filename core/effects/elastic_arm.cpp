#include "core/effects/elastic_arm.h"

#include "core/robot/spring_equilibrium.h"
#include "core/robot/wrench.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::effects {

std::optional<JointVector> loadedAngles(const frames::LoadingGeometry& geometry, const JointVector& compliance,
                                        const JointVector& q, const FlangeLoad& load) {
  constexpr int kMostSteps = 100;
  constexpr double kSettled = 1e-12;  // rad
  const auto torqueAt = [&](const JointVector& angles) -> JointVector {
    const robot::ArmPosture posture = robot::postureAt(geometry.arm, angles);
    const robot::Wrench wrench{robot::flangeAt(geometry.arm, posture) * load.point_in_flange, load.force, load.moment};
    return robot::weightTorque(geometry.arm, posture, geometry.weight) +
           robot::jointTorque(geometry.arm, posture, wrench);
  };
  const auto found = robot::springEquilibrium(q, compliance, kMostSteps, kSettled, torqueAt);
  return found.settled ? std::optional<JointVector>(found.angles) : std::nullopt;
}

/// What the effects do at one place of the arm: motions of the base (0), the bodies and the tool.
struct ElasticArm::Deflection {
  JointVector angles;
  boost::container::static_vector<Eigen::Isometry3d, toolBody(kMostJoints) + 1> motions;

  explicit Deflection(const robot::Robot& arm)
      : angles(JointVector::Zero(arm.joints())),
        motions(static_cast<std::size_t>(toolBody(arm.axes())) + 1, Eigen::Isometry3d::Identity()) {}
};

ElasticArm::ElasticArm(const frames::LoadingGeometry& geometry, const JointVector& compliance,
                       const LinearizationPoint& at, std::vector<PresentEffect> effects)
    : geometry_(geometry), compliance_(compliance), at_(at), effects_(std::move(effects)) {}

ElasticArm::Deflection ElasticArm::deflectionBy(const PostureStates& posture, std::size_t s) const {
  Deflection deflection(geometry_.arm);
  for (const auto& [model, own] : effects_) {
    if (model->angles) {
      deflection.angles += model->angles(at_, posture, s) * own;
      continue;
    }
    const std::vector<BodyTwist> twists = model->twists(at_, posture, s);
    std::size_t next = 0;
    for (const EffectPart& part : model->parts) {
      const BodyTwist& first = twists[next];
      Vector6d motion = Vector6d::Zero();
      for (std::size_t k = 0; k < part.most.size(); ++k, ++next) {
        const double size = own[static_cast<Eigen::Index>(next)];
        motion.head<3>() += size * twists[next].rotation;
        motion.tail<3>() += size * twists[next].shift;
      }
      if (motion.isZero(0.0)) continue;
      // An axis stands where the body inside it does.
      auto& there = deflection.motions[static_cast<std::size_t>(first.first_body - (first.with_axis ? 1 : 0))];
      there = metrology::motionAbout(first.pivot, motion) * there;
    }
  }
  return deflection;
}

std::optional<Eigen::Isometry3d> ElasticArm::toolMotion(const PostureStates& posture, std::size_t s,
                                                        const ToolLoad* load) const {
  PostureStates states = posture;
  return settledTool(states, s, load);
}

std::optional<Eigen::Isometry3d> ElasticArm::toolMotion(PostureStates& posture, std::size_t s,
                                                        const ToolLoad* load) const {
  ArmState before = posture[s];
  const std::optional<Eigen::Isometry3d> tool = settledTool(posture, s, load);
  posture[s] = std::move(before);
  return tool;
}

std::optional<Eigen::Isometry3d> ElasticArm::settledTool(PostureStates& states, std::size_t s,
                                                         const ToolLoad* load) const {
  constexpr int kMostSteps = 60;
  constexpr double kSettled = 1e-9;  // rad, of which the next round would leave a hundredth
  ArmState& state = states[s];
  // Where the arm rests by its springs under the own weight it is near the end: a third fewer rounds than from its
  // commands.
  Eigen::Isometry3d tool = state.posture.motion.back();
  for (int step = 0; step < kMostSteps; ++step) {
    state.load = load ? robot::Wrench{tool * load->point_at_zero, load->force, load->moment} : robot::Wrench{};
    state.load_torque = load ? robot::jointTorque(geometry_.arm, state.posture, state.load)
                             : JointVector(JointVector::Zero(geometry_.arm.joints()));
    const Deflection deflection = deflectionBy(states, s);
    const JointVector angles = state.q + compliance_.cwiseProduct(totalTorque(state)) + deflection.angles;
    const robot::ArmPosture turned = robot::postureAt(geometry_.arm, angles);
    state.posture.motion[0] = deflection.motions[0];
    for (std::size_t b = 1; b < turned.motion.size(); ++b) {
      const Eigen::Isometry3d own = turned.motion[b - 1].inverse() * turned.motion[b];
      state.posture.motion[b] = deflection.motions[b] * state.posture.motion[b - 1] * own;
    }
    const Eigen::Isometry3d last = tool;
    tool = deflection.motions[static_cast<std::size_t>(toolBody(geometry_.arm.axes()))] * state.posture.motion.back();
    if ((tool.matrix() - last.matrix()).cwiseAbs().maxCoeff() < kSettled) return tool;
    placeByPosture(geometry_, state);
    if (s == 0) state.turned = angles;
  }
  return std::nullopt;
}

}  // namespace stiffscope::effects
