#pragma once

#include <string>

#include "reports/json/fit_json.h"

namespace stiffscope::reports {

/// The fitted shape for people: each parameter with its standard uncertainty, the residuals, and the method.
std::string fitText(const ShapeFit& fitted);

}  // namespace stiffscope::reports
