#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/calibration/unloaded_day.h"
#include "core/frames/arm_parameters.h"

namespace stiffscope::calibration {

/// The vocabulary of unloaded days: what a machine or a measurement does that the rigid calibrated arm does not. The
/// names are ids that other programs use.
#define STIFFSCOPE_UNLOADED_EFFECTS(EFFECT) \
  EFFECT(kinematic_error)                   \
  EFFECT(joint_compliance)                  \
  EFFECT(link_compliance)                   \
  EFFECT(bearing_tilt)                      \
  EFFECT(base_compliance)                   \
  EFFECT(gravity_compensator)               \
  EFFECT(transmission_error)                \
  EFFECT(ratio_error)                       \
  EFFECT(backlash)                          \
  EFFECT(read_back_error)                   \
  EFFECT(tracker_drift)                     \
  EFFECT(frame_error)                       \
  EFFECT(target_motion)                     \
  EFFECT(thermal_growth)                    \
  EFFECT(scale_error)

// clang-format off
#define STIFFSCOPE_UNLOADED_ID(id) id,
enum class UnloadedEffect { STIFFSCOPE_UNLOADED_EFFECTS(STIFFSCOPE_UNLOADED_ID) };
#undef STIFFSCOPE_UNLOADED_ID
#define STIFFSCOPE_UNLOADED_NAME(id) std::string_view(#id),
inline constexpr std::array kUnloadedEffectIds{STIFFSCOPE_UNLOADED_EFFECTS(STIFFSCOPE_UNLOADED_NAME)};
#undef STIFFSCOPE_UNLOADED_NAME
// clang-format on

constexpr std::string_view idOf(UnloadedEffect effect) { return kUnloadedEffectIds[static_cast<std::size_t>(effect)]; }

/// Where a reflector stands in a posture, for terms that move it: everything in base_link.
struct ReflectorAt {
  const frames::PlacedPosture& arm;
  int target = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d station = Eigen::Vector3d::Zero();  ///< the tracker
  int place = 0;                                      ///< of UnloadedDay::stations, where it stood
};

/// One unknown of an effect. By a unit of it joints turn (`angles`, rad), or a reflector is seen elsewhere (`offset`,
/// m, in base_link); exactly one of the two is set.
struct EffectTerm {
  std::string name, unit;
  double most = 0.0;       ///< physical bound of its magnitude
  bool positive = false;   ///< a compliance: never negative
  int compliance_of = -1;  ///< the joint (from 0) whose compliance about its axis this is; -1: of none
  std::function<JointVector(const Posture&)> angles = {};
  std::function<Eigen::Vector3d(const Posture&, const ReflectorAt&)> offset = {};
};

/// Terms that come or stay away together: one joint's harmonic, one reflector's motion.
struct EffectPart {
  UnloadedEffect effect = {};
  std::string detail;  ///< "joint 2", "joints 4 and 5", "P11"; empty where nothing is to be named
  std::vector<EffectTerm> terms = {};
  std::optional<double> order = {};  ///< of a periodic error, per turn of the joint
  std::optional<double> from = {};   ///< of what starts at a time: share of the day (Posture::time)
  std::optional<double> chance =
      {};         ///< of a part as large by noise alone, over all that were tried (false-alarm probability)
  int tried = 0;  ///< alternatives of its kind; 0: as many as the family has
  int needs_compliance_of = -1;  ///< a joint without whose compliance among the terms this is another effect; -1: none
  double penalty = 0.0;          ///< in BIC: its terms, and the alternatives that were tried
};

/// The forms that one effect may have. Any number of `parts` may be present, found one by one; `wholes` are other forms
/// of the effect, each complete, of which one may be present instead: all joints twist at once, a drift is a
/// polynomial.
struct EffectFamily {
  UnloadedEffect effect = {};
  std::vector<EffectPart> parts = {}, wholes = {};
};

/// The vocabulary as this day can be asked for it: own weight only where masses or free moments stand for it, growth by
/// temperature where there is one. Periodic errors (transmission_error) and what starts at a time (frame_error,
/// target_motion, scale_error from a time on), of which there are continua, have no parts here: the selection makes
/// them with the functions below. kinematic_error is the geometry, which is always fitted.
std::vector<EffectFamily> effectFamilies(const UnloadedDay& day);

/// c_j times the own weight's torque on joint j, a part a joint.
std::vector<EffectPart> jointCompliances(const UnloadedDay& day);

/// a sin(k q_j) + b cos(k q_j) on joint j (from 0): an eccentric gear or encoder ring (k 1, 2), a gear's own order.
EffectPart transmissionError(int joint, double order);

/// The poses of the day's stations, each in up to six parts that are independent of each other and of which one is a
/// standard uncertainty: what a later station's readings may all be off by. They are unknowns of every fit and no
/// effect. `base_from_points`: of the table's frame, in which the stations were joined.
std::vector<EffectTerm> stationPoses(const UnloadedDay& day, const Eigen::Isometry3d& base_from_points);

/// From `from` (Posture::time) on: station or robot elsewhere, a reflector elsewhere on the flange, another scale.
EffectPart frameError(double from);
EffectPart targetMotion(const UnloadedDay& day, int target, double from);
EffectPart scaleError(double from);

}  // namespace stiffscope::calibration
