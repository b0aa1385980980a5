#include "core/accuracy/diagnose_accuracy.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::accuracy {

AccuracyDiagnosis diagnoseAccuracy(const campaign::Campaign& campaign, const calibration::CalibrationOptions& options) {
  AccuracyDiagnosis result;
  result.calibration = calibration::calibrate(campaign, options);
  const calibration::Calibration& calibration = result.calibration;
  result.unusable_reason = calibration.reason;
  result.usable = calibration.reason.empty();
  if (!result.usable) return result;
  const double per_coordinate = std::sqrt(1.0 / 3.0);
  result.gap.nominal = per_coordinate * calibration.of(calibration::CalibratedModel::nominal).held_out.rms;
  result.gap.before = per_coordinate * calibration.geometry().held_out.rms;
  result.gap.after = per_coordinate * calibration.best().held_out.rms;
  for (const calibration::EffectPart& part : calibration.best().fit.parts) {
    const auto known = std::find_if(result.verdict.begin(), result.verdict.end(),
                                    [&](const AccuracyEntry& entry) { return entry.effects.front() == part.effect; });
    if (known != result.verdict.end()) continue;
    result.verdict.push_back({{part.effect}, part.detail});
    AccuracyClass one;
    one.effects = {part.effect};
    one.detail = part.detail;
    one.in_verdict = true;
    result.classes.push_back(std::move(one));
  }
  result.postures = static_cast<int>(calibration.day.postures.size());
  result.readings = static_cast<int>(calibration.day.readings());
  return result;
}

}  // namespace stiffscope::accuracy
