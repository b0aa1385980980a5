#pragma once

#include <string>

namespace stiffscope::reports {

/// What is amiss where this check warns or fails, for readers who do not know its name: "reflectors do not come back
/// when the load is taken off". A clause without a full stop. Throws std::logic_error for a check that there is not.
std::string amissWords(const std::string& check_id);

}  // namespace stiffscope::reports
