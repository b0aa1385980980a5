#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/accuracy/remarks.h"
#include "core/calibration/calibrate.h"
#include "core/calibration/effect_terms.h"
#include "core/diagnosis/diagnosis.h"
#include "metrology/remark.h"

namespace stiffscope::accuracy {

using calibration::UnloadedEffect;

/// One member of a verdict: effects that the day cannot tell apart, or `unknown` where `effects` is empty.
struct AccuracyEntry {
  std::vector<UnloadedEffect> effects;
  std::string detail;  ///< joint, pair of joints or reflector of the first; empty where nothing is named
};

/// Effects that this day cannot tell apart, as one candidate.
struct AccuracyClass {
  std::vector<UnloadedEffect> effects;  ///< the best first
  std::string detail;
  double score = 0.0;        ///< fall of BIC against the model without it; larger is better
  double size = 0.0;         ///< rms per coordinate of what it explains beside the others, m
  diagnosis::Shrink shrink;  ///< of the rms of the positions' residual, held out, besides what stands before it
  double explained = 0.0;    ///< that in variance, less noise
  bool in_verdict = false;
  std::vector<calibration::EffectPart> parts;  ///< of those effects that were fitted, the first's first
  std::vector<double> sizes, sds;              ///< of their terms, in their units
};

/// Positions' gap, rms per coordinate, m.
struct AccuracyGap {
  double nominal = 0.0;  ///< base and reflectors alone fitted to the URDF's arm
  double before = 0.0;   ///< geometry calibrated, held out
  double after = 0.0;    ///< with all effects that were fitted, the verdict's among them, held out
  double noise = 0.0;    ///< of the readings
};

struct DetectableEffect {
  UnloadedEffect effect = {};
  std::optional<double> size;  ///< rms per coordinate of what it moves beyond the geometry, m; empty: not testable
};

struct UntestableEffect {
  UnloadedEffect effect = {};
  Remark missing;
};

/// Answer of `diagnose` on a day without a load.
struct AccuracyDiagnosis {
  bool usable = false;
  Remark unusable_reason;
  bool effects_asked = true;           ///< false: fewer postures than that takes; then `unknown` is not looked into
  std::vector<AccuracyEntry> verdict;  ///< empty: none
  std::vector<Remark> reasons;
  std::vector<AccuracyClass> classes;                ///< the verdict's first, then the others; best first
  std::vector<std::vector<UnloadedEffect>> aliases;  ///< by the postures alone, before any residual
  std::vector<DetectableEffect> detectable;
  std::vector<UntestableEffect> not_testable;
  AccuracyGap gap;
  diagnosis::Shrink shrink_together;  ///< by all effects that were fitted
  /// Where the residual of the geometry lies, and that of the geometry with all effects that were fitted.
  std::vector<diagnosis::WhereTable> where, where_after;
  std::vector<Remark> next;
  double size_limit = 0.0;            ///< below it an effect is too small to matter, m rms per coordinate
  double left_over = 0.0;             ///< chi2 per equation with all effects that were fitted
  double left_over_limit = 0.0;       ///< what chance makes of it
  bool geometry_off_nominal = false;  ///< kinematic_error is named: the URDF misses by more than its limit
  double geometry_limit = 0.0;        ///< that limit, m rms per coordinate
  /// Of the readings as they are used: what accuracy, axes and places are stated by.
  calibration::Calibration calibration;
  /// Of the readings as they were read, where the station's motion was taken off: by which the cause is looked for, and
  /// what the gap, the classes and the tables are of. Empty: they are the same readings.
  std::optional<calibration::Calibration> as_read;
  const calibration::Calibration& ofCause() const { return as_read ? *as_read : calibration; }
  int postures = 0, readings = 0;
};

}  // namespace stiffscope::accuracy
