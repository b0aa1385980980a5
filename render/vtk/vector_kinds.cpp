#include "render/vtk/scene_stage.h"

namespace stiffscope {

const Palette& paletteOf(const ArmScene& scene) { return scene.dark ? kDarkPalette : kLightPalette; }

std::array<VectorKind, 3> vectorKinds(const ArmScene& scene) {
  const Palette& palette = paletteOf(scene);
  return {{{&ScenePoint::measured, palette.measured, kMeasuredWidth, 1, scene.measured_name},
           {&ScenePoint::predicted, palette.predicted, kPredictedWidth, 1, scene.predicted_name},
           {&ScenePoint::residual, palette.residual, kResidualWidth, scene.residual_factor,
            scene.residual_name}}};
}

bool hasVectors(const ArmScene& scene, const VectorKind& kind) {
  bool any = false;
  forEachPoint(scene, [&](const ScenePoint& point, const ArmPose&) { any = any || (point.*kind.vector); });
  return any;
}

}  // namespace stiffscope
