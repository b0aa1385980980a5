#pragma once

#include "core/diagnosis/diagnosis.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json_values.h"

namespace stiffscope {

/// The result of `diagnose`. `verdict` is a list of lists of effect ids: the outer names all that is present,
/// an inner one what this data cannot tell apart; [["none"]], or ["unknown"] among them.
Json diagnosisJson(const Campaign& campaign, const Diagnosis& diagnosis);

}  // namespace stiffscope
