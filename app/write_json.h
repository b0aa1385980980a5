#pragma once

#include "core/input/write_file.h"
#include "reports/json/json_document.h"

namespace stiffscope {

/// Hands what dump(1) gives, and a line end, to `sink`, in parts; long lists of it are made and written on all cores, a few
/// thousand rows at a time, so that neither a hundred megabytes of values nor their text stands in memory.
void writeJson(const JsonDocument& document, const ByteSink& sink);

}  // namespace stiffscope
