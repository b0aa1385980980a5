#include "app/view/suiting_lengths.h"

#include <algorithm>
#include <functional>
#include <optional>

namespace stiffscope {

namespace {

double medianOverStep(const std::vector<ViewFrame>& frames, int step,
                      const std::function<std::optional<double>(const ArmScene&)>& value) {
  std::vector<double> values;
  for (const ViewFrame& frame : frames) {
    if (frame.step != step) continue;
    if (const auto one = value(frame.scene)) values.push_back(*one);
  }
  if (values.empty()) return 1;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

double magnificationForStep(const std::vector<ViewFrame>& frames, int step, double residual_factor) {
  return medianOverStep(frames, step, [&](ArmScene scene) -> std::optional<double> {
    scene.residual_factor = residual_factor;
    const double suits = automaticMagnification(scene);
    return suits == 1 ? std::nullopt : std::optional(suits);  // 1: there is no vector
  });
}

double residualFactorForStep(const std::vector<ViewFrame>& frames, int step) {
  return medianOverStep(frames, step,
                        [](const ArmScene& scene) { return std::optional(automaticResidualFactor(scene)); });
}

}  // namespace stiffscope
