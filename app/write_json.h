#pragma once

#include "core/input/write_file.h"
#include "reports/json/json_values.h"

namespace stiffscope {

/// Hands json.dump(1) and a line end to `sink`: that text, long lists of it written on all cores, in parts,
/// so that tens of megabytes do not stand in memory beside the values.
void writeJson(const Json& json, const ByteSink& sink);

}  // namespace stiffscope
