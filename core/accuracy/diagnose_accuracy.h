#pragma once

#include "core/accuracy/accuracy_diagnosis.h"
#include "core/preparation/prepare.h"

namespace stiffscope::accuracy {

/// Folds of a diagnosis: neighbours by fours stay together, since consecutive postures often come in pairs of two
/// shapes of the arm, and a fold of one shape would be judged by the other.
inline constexpr calibration::CalibrationOptions kDiagnosisFolds{.folds = 2, .fold_size = 4, .divisions = 24};

/// Where the calibrated geometry and the tracker disagree, which effect of the vocabulary of unloaded days makes it,
/// and how far it shrinks with that effect in the model.
///
/// The readings are taken as they were measured, the station's motion in them: it is one of the effects. Their noise is
/// what repeats show. An effect that the selection found (calibration::selectEffects) is named, with the rivals that do
/// as well, unless it is smaller than what matters, or was found by all of the day and not by what each fold leaves of
/// it although that has equations enough to show it. Where something significant stays, the verdict says `unknown`, and
/// an effect stands beside it only where it removes nearly all of the gap.
AccuracyDiagnosis diagnoseAccuracy(const preparation::PreparedCampaign& prepared,
                                   const calibration::CalibrationOptions& options = kDiagnosisFolds);

/// Diagnoses a campaign as it was read, which is prepared first.
AccuracyDiagnosis diagnoseAccuracy(const campaign::Campaign& campaign,
                                   const calibration::CalibrationOptions& options = kDiagnosisFolds);

}  // namespace stiffscope::accuracy
