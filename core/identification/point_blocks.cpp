#include "core/identification/point_blocks.h"

#include <cmath>

namespace stiffscope {

// Where the processor has registers of four numbers they are used: over ten thousand postures twice as quick. Without
// fused products, which would round otherwise. Not under sanitizers, which are not up yet when the version is chosen.
#if defined(__x86_64__) && defined(__has_attribute) && !defined(__SANITIZE_ADDRESS__)
#if __has_attribute(target_clones)
#define STIFFSCOPE_BY_PROCESSOR __attribute__((target_clones("avx2", "default")))
#endif
#endif
#ifndef STIFFSCOPE_BY_PROCESSOR
#define STIFFSCOPE_BY_PROCESSOR
#endif

STIFFSCOPE_BY_PROCESSOR
void residualNorms(std::span<const PointBlock> blocks, const Vector6d& compliance, std::span<double> norms) {
  double c[6];
  for (int joint = 0; joint < 6; ++joint) c[joint] = compliance[joint];
  double* norm = norms.data();
  for (const PointBlock& block : blocks) {
    for (std::size_t point = 0; point < PointBlock::kPoints; ++point) {
      double square = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        double residual = block.right[axis][point];
        for (int joint = 0; joint < 6; ++joint) residual -= block.matrix[axis][joint][point] * c[joint];
        square += residual * residual;
      }
      norm[point] = std::sqrt(square);
    }
    norm += PointBlock::kPoints;
  }
}

}  // namespace stiffscope
