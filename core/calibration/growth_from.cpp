#include "core/calibration/growth_from.h"

#include <string>

#include "core/frames/placed_arm.h"

namespace stiffscope::calibration {

namespace {

/// Else by time: it then shows nothing in a first posture, however warm that is.
bool growsByTemperature(const UnloadedDay& day, const EffectTerm& term) {
  if (!term.offset) return false;
  Posture warmer(day.arm.joints());
  warmer.warmth = 1.0;
  const frames::PlacedArm arm(frames::axesAtStart(day.arm.axes_in_base_at_zero));
  const frames::PlacedPosture placed(arm, warmer.q);
  const ReflectorAt flange{placed, 0, day.arm.base_from_flange_at_zero.translation()};
  return !term.offset(warmer, flange).isZero(0.0);
}

/// The mean from which the postures' warmth is counted: by any one of them.
std::optional<double> meanTemperature(const campaign::Campaign& campaign, const UnloadedDay& day) {
  if (!campaign.states || day.postures.empty()) return std::nullopt;
  const Posture& posture = day.postures.front();
  const std::string& id = day.pose_ids[static_cast<std::size_t>(posture.pose)];
  for (const campaign::State& state : campaign.states->rows) {
    if (state.step == 0 && campaign.pose_ids[static_cast<std::size_t>(state.pose)] == id)
      return state.extras().temperature_c - posture.warmth;
  }
  return std::nullopt;
}

}  // namespace

GrowthFrom growthFrom(const campaign::Campaign& campaign, const Calibration& calibration) {
  GrowthFrom from;
  for (const EffectPart& part : calibration.best().fit.parts) {
    if (part.effect != UnloadedEffect::thermal_growth) continue;
    for (const EffectTerm& term : part.terms) {
      if (growsByTemperature(calibration.day, term)) {
        from.temperature_c = meanTemperature(campaign, calibration.day);
      } else {
        from.first_posture = true;
      }
    }
  }
  return from;
}

}  // namespace stiffscope::calibration
