#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace stiffscope::effects {

/// The table of effects, one line each: what a machine or a measurement may do that the joint-stiffness model does not.
/// The first name is the effect's id, which is fixed because other programs use it; the second is the function that
/// returns its record, defined in the effect's own file. Reports list effects in this order.
#define STIFFSCOPE_EFFECTS(EFFECT)                     \
  EFFECT(link_compliance, linkCompliance)              \
  EFFECT(bearing_tilt, bearingTilt)                    \
  EFFECT(base_compliance, baseCompliance)              \
  EFFECT(rail_bending, railBending)                    \
  EFFECT(joint_coupling, jointCoupling)                \
  EFFECT(joint_hardening, jointHardening)              \
  EFFECT(backlash, backlash)                           \
  EFFECT(hysteresis, hysteresis)                       \
  EFFECT(gravity_compensator, gravityCompensator)      \
  EFFECT(load_point_error, loadPointError)             \
  EFFECT(load_cell_misalignment, loadCellMisalignment) \
  EFFECT(load_cell_bias, loadCellBias)                 \
  EFFECT(frame_error, frameError)                      \
  EFFECT(kinematic_error, kinematicError)              \
  EFFECT(tracker_drift, trackerDrift)                  \
  EFFECT(target_motion, targetMotion)                  \
  EFFECT(tool_compliance, toolCompliance)

// clang-format off
#define STIFFSCOPE_EFFECT_ID(id, record) id,
enum class Effect { STIFFSCOPE_EFFECTS(STIFFSCOPE_EFFECT_ID) };
#undef STIFFSCOPE_EFFECT_ID

/// Their ids, in the order of Effect.
#define STIFFSCOPE_EFFECT_NAME(id, record) std::string_view(#id),
inline constexpr std::array kEffectIds{STIFFSCOPE_EFFECTS(STIFFSCOPE_EFFECT_NAME)};
#undef STIFFSCOPE_EFFECT_NAME
// clang-format on

inline constexpr std::size_t kEffectCount = kEffectIds.size();

constexpr std::string_view idOf(Effect effect) { return kEffectIds[static_cast<std::size_t>(effect)]; }

/// The effect of this id, empty where there is none.
constexpr std::optional<Effect> effectOf(std::string_view id) {
  for (std::size_t i = 0; i < kEffectCount; ++i) {
    if (kEffectIds[i] == id) return static_cast<Effect>(i);
  }
  return std::nullopt;
}

}  // namespace stiffscope::effects
