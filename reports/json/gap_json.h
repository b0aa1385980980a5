#pragma once

#include <vector>

#include "core/diagnosis/diagnosis.h"
#include "reports/json/json_document.h"

// What diagnoses of loaded and of unloaded days have in common.

namespace stiffscope::reports {

Json micrometres(double metres);
Json shrinkJson(const diagnosis::Shrink& shrink);                     ///< value, low, high
Json tablesJson(const std::vector<diagnosis::WhereTable>& tables);    ///< rows of each, by what it is by
Json overlapsJson(const std::vector<diagnosis::WhereTable>& tables);  ///< of tables whose parts share; null without any

}  // namespace stiffscope::reports
