#pragma once

#include "core/diagnosis/diagnosis.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json_document.h"

namespace stiffscope::reports {

/// The result of `diagnose`. `verdict` is a list of lists of effect ids: the outer names all that is present,
/// an inner one what this data cannot tell apart; [["none"]], or ["unknown"] among them.
Json diagnosisJson(const campaign::Campaign& campaign, const diagnosis::Diagnosis& diagnosis);

}  // namespace stiffscope::reports
