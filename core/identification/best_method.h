#pragma once

#include "core/identification/identification.h"

namespace stiffscope {

/// The method whose result stands for a campaign where one must: the decoupled where it can be had, else Partial
/// Pose, else Complete Pose, available or not. `result.of(method)` says `available`.
template <class Result>
Method bestMethod(const Result& result) {
  for (const Method method : {Method::decoupled_partial_pose, Method::partial_pose}) {
    if (result.of(method).available) return method;
  }
  return Method::complete_pose;
}

}  // namespace stiffscope
