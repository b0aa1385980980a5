#pragma once

#include <string>
#include <vector>

#include "reports/stated_results.h"
#include "reports/words/table.h"

namespace stiffscope::reports {

/// What audit and diagnosis find in both alike, a sentence each.
std::vector<std::string> saidOfBoth(const StatedComparison& comparison);

/// Where the two differ and what each states, for text and page. Tables without rows are left out.
std::vector<Table> statedTables(const StatedComparison& comparison);

/// The result in a sentence: which joints changed, or that none did; empty where no stiffness is compared.
std::string changedWords(const StatedComparison& comparison);

}  // namespace stiffscope::reports
