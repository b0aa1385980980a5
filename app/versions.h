#pragma once

#include <vector>

#include "reports/report_content.h"

namespace stiffscope::app {

/// stiffscope's own version and those of the libraries it was built with.
std::vector<reports::NamedText> versions();

}  // namespace stiffscope::app
