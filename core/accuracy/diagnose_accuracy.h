#pragma once

#include "core/accuracy/accuracy_diagnosis.h"
#include "core/campaign/campaign.h"

namespace stiffscope::accuracy {

/// Where the calibrated geometry and the tracker disagree, which effect of the vocabulary of unloaded days makes it,
/// and how far it shrinks with that effect in the model.
AccuracyDiagnosis diagnoseAccuracy(const campaign::Campaign& campaign,
                                   const calibration::CalibrationOptions& options = {});

}  // namespace stiffscope::accuracy
