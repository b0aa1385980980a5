#pragma once

#include <string>

#include "reports/json/json_values.h"

namespace stiffscope {

/// json.dump(1) and a line end: the same text, long lists written on all cores.
std::string jsonText(const Json& json);

}  // namespace stiffscope
