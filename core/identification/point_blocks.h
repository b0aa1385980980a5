#pragma once

#include <cstddef>
#include <span>

#include "core/robot/robot.h"

namespace stiffscope {

/// Equations b = A c of some points, three rows each, laid out so that all residuals of a block are computed at once: a
/// coordinate of all points stands together. Points that are not there have zeros.
struct alignas(64) PointBlock {
  static constexpr std::size_t kPoints = 8;
  double matrix[3][6][kPoints] = {};  ///< A by coordinate, joint and point
  double right[3][kPoints] = {};      ///< b by coordinate and point, m
};

/// |b - A c| of each point, m; `norms`: kPoints a block. The same numbers with wide registers and without.
void residualNorms(std::span<const PointBlock> blocks, const Vector6d& compliance, std::span<double> norms);

}  // namespace stiffscope
