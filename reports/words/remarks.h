#pragma once

#include <string>

#include "core/comparison/remarks.h"
#include "core/compensation/remarks.h"
#include "core/diagnosis/remarks.h"
#include "core/effects/remarks.h"
#include "core/extended_model/remarks.h"
#include "core/planning/remarks.h"
#include "core/validation/remarks.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

// One function a library: the sentence for each of its remarks, by a switch without a default, so that the compiler
// warns of a remark without words. Defined in the file that bears the library's name (audit_remarks.cpp).

std::string comparisonWords(comparison::RemarkId id, const RemarkValues& values);
std::string compensationWords(compensation::RemarkId id, const RemarkValues& values);
std::string diagnosisWords(diagnosis::RemarkId id, const RemarkValues& values);
std::string effectsWords(effects::RemarkId id, const RemarkValues& values);
std::string extendedModelWords(extended_model::RemarkId id, const RemarkValues& values);
std::string planningWords(planning::RemarkId id, const RemarkValues& values);
std::string validationWords(validation::RemarkId id, const RemarkValues& values);

}  // namespace stiffscope::reports
