#pragma once

#include <string>

#include "core/accuracy/remarks.h"
#include "core/audit/remarks.h"
#include "core/calibration/remarks.h"
#include "core/comparison/remarks.h"
#include "core/compensation/remarks.h"
#include "core/diagnosis/remarks.h"
#include "core/effects/remarks.h"
#include "core/elastic_model/remarks.h"
#include "core/extended_model/remarks.h"
#include "core/frames/remarks.h"
#include "core/identification/remarks.h"
#include "core/mistakes/remarks.h"
#include "core/planning/remarks.h"
#include "core/preparation/remarks.h"
#include "core/validation/remarks.h"
#include "metrology/remarks.h"
#include "reports/words/remark_values.h"

namespace stiffscope::reports {

// One function a library: the sentence for each of its remarks, by a switch without a default, so that the compiler
// warns of a remark without words. Defined in the file that bears the library's name (audit_remarks.cpp).
std::string accuracyWords(accuracy::RemarkId id, const RemarkValues& values);
std::string auditWords(audit::RemarkId id, const RemarkValues& values);
std::string calibrationWords(calibration::RemarkId id, const RemarkValues& values);
std::string comparisonWords(comparison::RemarkId id, const RemarkValues& values);
std::string compensationWords(compensation::RemarkId id, const RemarkValues& values);
std::string diagnosisWords(diagnosis::RemarkId id, const RemarkValues& values);
std::string effectsWords(effects::RemarkId id, const RemarkValues& values);
std::string elasticModelWords(elastic_model::RemarkId id, const RemarkValues& values);
std::string extendedModelWords(extended_model::RemarkId id, const RemarkValues& values);
std::string framesWords(frames::RemarkId id, const RemarkValues& values);
std::string identificationWords(identification::RemarkId id, const RemarkValues& values);
std::string metrologyWords(metrology::RemarkId id, const RemarkValues& values);
std::string mistakesWords(mistakes::RemarkId id, const RemarkValues& values);
std::string planningWords(planning::RemarkId id, const RemarkValues& values);
std::string preparationWords(preparation::RemarkId id, const RemarkValues& values);
std::string validationWords(validation::RemarkId id, const RemarkValues& values);

}  // namespace stiffscope::reports
