#include "core/simulation/torque_curve.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::simulation {

namespace {

/// At a twist of size `size` >= 0 on one side.
CurvePoint alongStages(const std::vector<TorqueCurve::Stage>& stages, double size) {
  CurvePoint at;
  double from = 0.0;
  for (const TorqueCurve::Stage& stage : stages) {
    const double part = std::min(size, stage.until) - from;
    at.energy += at.torque * part + 0.5 * stage.rate * part * part;
    at.torque += stage.rate * part;
    at.rate = stage.rate;
    if (size <= stage.until) break;
    from = stage.until;
  }
  return at;
}

}  // namespace

CurvePoint evaluate(const TorqueCurve& curve, double twist, const double* anchors) {
  const bool up = twist >= 0.0;
  CurvePoint at = alongStages(up ? curve.positive : curve.negative, std::abs(twist));
  if (!up) at.torque = -at.torque;

  const double square = twist * twist;
  at.energy += 0.25 * curve.cubic * square * square;
  at.torque += curve.cubic * square * twist;
  at.rate += 3.0 * curve.cubic * square;

  if (anchors == nullptr) return at;
  for (std::size_t s = 0; s < curve.sliders.size(); ++s) {
    const Slider& slider = curve.sliders[s];
    const double stretch = twist - anchors[s], most = slider.limit / slider.rate;
    if (std::abs(stretch) <= most) {
      at.energy += 0.5 * slider.rate * stretch * stretch;
      at.torque += slider.rate * stretch;
      at.rate += slider.rate;
    } else {
      at.energy += slider.limit * (std::abs(stretch) - 0.5 * most);
      at.torque += std::copysign(slider.limit, stretch);
    }
  }
  return at;
}

void slip(const TorqueCurve& curve, double twist, double* anchors) {
  for (std::size_t s = 0; s < curve.sliders.size(); ++s) {
    const double most = curve.sliders[s].limit / curve.sliders[s].rate;
    anchors[s] = std::clamp(anchors[s], twist - most, twist + most);
  }
}

std::vector<TorqueCurve::Stage> stagesByTorque(const std::vector<double>& torques,
                                               const std::vector<double>& rates) {
  std::vector<TorqueCurve::Stage> stages;
  double torque = 0.0, twist = 0.0;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    TorqueCurve::Stage stage{rates[k]};
    if (k < torques.size()) {
      twist += (torques[k] - torque) / rates[k];
      torque = torques[k];
      stage.until = twist;
    }
    stages.push_back(stage);
  }
  return stages;
}

}  // namespace stiffscope::simulation
