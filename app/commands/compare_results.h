#pragma once

#include <string>

#include "app/output.h"

namespace stiffscope::app {

/// `compare` of two result files; `html` is written where it is named. kNotUsable where the machines differ.
int compareResults(const std::string& before, const std::string& after, const std::string& html, const Outlet& outlet);

}  // namespace stiffscope::app
