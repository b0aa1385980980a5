#pragma once

#include <initializer_list>

#include "core/frames/frames.h"

namespace stiffscope {

/// Where a length, angle or place that hangs on these axes (0-based) comes from: "sweeps" where all of them
/// were measured, "nominal" where none was and the value is the URDF's, else "partly nominal".
const char* sourceOf(const Frames& frames, std::initializer_list<std::size_t> axes);

/// The same as a mark behind a value for people: empty for "sweeps", else " (nominal)".
std::string sourceMark(const Frames& frames, std::initializer_list<std::size_t> axes);

}  // namespace stiffscope
