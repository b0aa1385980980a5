#pragma once

#include "core/identification/identify.h"

namespace stiffscope {

/// A method's names: `dpp` as a key, `DPP` in tables, `Decoupled Partial Pose` in words.
struct MethodNames {
  const char* key;
  const char* brief;
  const char* full;
};

const MethodNames& namesOf(Method method);

}  // namespace stiffscope
