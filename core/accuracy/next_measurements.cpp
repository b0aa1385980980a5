#include "core/accuracy/where_next.h"

#include <algorithm>
#include <string>

namespace stiffscope::accuracy {

namespace {

/// By which measurement an effect stands out from the others.
RemarkId measurementFor(UnloadedEffect effect) {
  switch (effect) {
    case UnloadedEffect::joint_compliance:
    case UnloadedEffect::link_compliance:
    case UnloadedEffect::bearing_tilt:
    case UnloadedEffect::base_compliance:
    case UnloadedEffect::gravity_compensator:
      return RemarkId::measure_under_load;
    case UnloadedEffect::tracker_drift:
    case UnloadedEffect::frame_error:
      return RemarkId::measure_nests;
    case UnloadedEffect::backlash:
    case UnloadedEffect::read_back_error:
      return RemarkId::measure_moves;
    case UnloadedEffect::target_motion:
      return RemarkId::measure_repeats;
    case UnloadedEffect::scale_error:
      return RemarkId::measure_scale_bar;
    case UnloadedEffect::thermal_growth:
      return RemarkId::measure_temperature;
    case UnloadedEffect::kinematic_error:
    case UnloadedEffect::transmission_error:
    case UnloadedEffect::ratio_error:
      break;
  }
  return RemarkId::measure_more_postures;
}

}  // namespace

std::vector<Remark> nextMeasurements(const AccuracyDiagnosis& diagnosis) {
  std::vector<std::pair<RemarkId, std::vector<std::string>>> wanted;
  const auto want = [&](RemarkId what, const std::string& id) {
    auto found = std::find_if(wanted.begin(), wanted.end(), [&](const auto& one) { return one.first == what; });
    if (found == wanted.end()) found = wanted.insert(wanted.end(), {what, {}});
    if (std::find(found->second.begin(), found->second.end(), id) == found->second.end()) found->second.push_back(id);
  };
  for (const AccuracyEntry& entry : diagnosis.verdict) {
    if (entry.effects.size() < 2) continue;
    for (const UnloadedEffect effect : entry.effects) want(measurementFor(effect), std::string(idOf(effect)));
  }
  for (const AccuracyClass& one : diagnosis.classes) {
    if (!one.in_verdict) want(measurementFor(one.effects.front()), std::string(idOf(one.effects.front())));
  }
  for (const UntestableEffect& one : diagnosis.not_testable)
    want(measurementFor(one.effect), std::string(idOf(one.effect)));
  const bool unknown = std::any_of(diagnosis.verdict.begin(), diagnosis.verdict.end(),
                                   [](const AccuracyEntry& entry) { return entry.effects.empty(); });
  if (unknown && diagnosis.effects_asked) {
    want(RemarkId::measure_repeats, "unknown");
    want(RemarkId::measure_more_postures, "unknown");
  }
  std::vector<Remark> next;
  if (!diagnosis.effects_asked) next.emplace_back(RemarkId::measure_enough, calibration::kFewestForEffects);
  for (const auto& [what, ids] : wanted) next.emplace_back(what, ids);
  return next;
}

}  // namespace stiffscope::accuracy
