#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace stiffscope::effects {

/// What a machine may do that the joint-stiffness model does not. The ids are fixed: other programs use them.
enum class Effect {
  link_compliance,         ///< a link bends and twists along its length
  bearing_tilt,            ///< a joint also gives about the two directions across its axis
  base_compliance,         ///< pedestal or floor gives
  joint_coupling,          ///< torque at one joint turns another; names the pair
  joint_hardening,         ///< stiffness grows (or drops) with torque
  backlash,                ///< lost motion as a joint's torque passes zero
  hysteresis,              ///< friction: the way back differs from the way out
  gravity_compensator,     ///< a spring on axis 2 whose torque depends on posture
  load_point_error,        ///< the load acts elsewhere on the tool than declared
  load_cell_misalignment,  ///< the load cell is turned against its declared axes
  load_cell_bias,          ///< a constant force added to, or missing from, the loaded readings
  frame_error,             ///< the tracker, or the robot, moved between the frame sweeps and the loading
  kinematic_error,         ///< lengths or joint zeros differ from the nominal geometry
  tracker_drift,           ///< readings wander with time
  target_motion,           ///< one reflector moves in its nest under load; names it
  tool_compliance,         ///< the plate between flange and reflectors gives
};

inline constexpr std::size_t kEffectCount = 16;

/// Their ids, in the order of Effect.
inline constexpr std::array<std::string_view, kEffectCount> kEffectIds{
    "link_compliance",   "bearing_tilt",           "base_compliance",
    "joint_coupling",    "joint_hardening",        "backlash",
    "hysteresis",        "gravity_compensator",    "load_point_error",
    "load_cell_misalignment", "load_cell_bias",    "frame_error",
    "kinematic_error",   "tracker_drift",          "target_motion",
    "tool_compliance"};

constexpr std::string_view idOf(Effect effect) { return kEffectIds[static_cast<std::size_t>(effect)]; }

/// The effect of this id, empty where there is none.
constexpr std::optional<Effect> effectOf(std::string_view id) {
  for (std::size_t i = 0; i < kEffectCount; ++i) {
    if (kEffectIds[i] == id) return static_cast<Effect>(i);
  }
  return std::nullopt;
}

}  // namespace stiffscope::effects
