#pragma once

#include <string>
#include <vector>

#include "core/identification/identify.h"

namespace stiffscope {

/// The methods that `--method` names: cp, pp, dpp or all. Throws InputError with the nearest known name.
std::vector<Method> methodsNamed(const std::string& name);

}  // namespace stiffscope
