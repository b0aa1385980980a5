#pragma once

#include <vector>

#include "reports/page/report_content.h"

namespace stiffscope {

/// stiffscope's own version and those of the libraries it was built with.
std::vector<NamedText> versions();

}  // namespace stiffscope
