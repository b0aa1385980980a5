#pragma once

#include <string>
#include <vector>

#include "core/calibration/calibrate.h"
#include "core/calibration/growth_from.h"

// A calibration of an unloaded day in the words of its text, JSON and tables.

namespace stiffscope::reports {

const char* nameOf(calibration::CalibratedModel model);  ///< "nominal", "geometry", "gravity", "effects"

/// Ids of the effects in a fit, each once, in the order in which they were found; refused terms are not in it.
std::vector<std::string> effectIdsOf(const calibration::ArmFit& fit);

/// What the axes of the geometry alone are not, where effects beside it were found; empty where none were.
std::string geometryCaution(const calibration::Calibration& calibration);

/// Of which state of the arm the axes are that were fitted with growth; empty where none was found.
std::string growthFromWords(const calibration::GrowthFrom& from);

/// "held out: each of 2 folds predicted by what the others fit; posture i is in fold (i / 1) mod 2"
std::string foldWords(const calibration::CalibrationOptions& options);

/// What is to be said of the models: refused compliances, no effect.
std::vector<std::string> modelNotes(const calibration::Calibration& calibration);

const char* nameOf(calibration::JointAngles angles);  ///< "reported", "commanded"

/// How well either kind of joint angles predicts, and which fits; `used`: those that the calibration stands on.
std::string angleWords(const calibration::AngleComparison& angles, calibration::JointAngles used);

/// "transmission error (joint 2, order 17.25)"
std::string partName(const calibration::EffectPart& part);

/// Stiffness of a joint from its compliance by the own weight, Nm/rad; 0: the fit has none, or a compliance of less
/// than twice its standard uncertainty, which no stiffness follows from.
struct JointStiffness {
  double value = 0.0, sd = 0.0;
};
std::vector<JointStiffness> stiffnessOf(const calibration::ArmFit& fit);

}  // namespace stiffscope::reports
