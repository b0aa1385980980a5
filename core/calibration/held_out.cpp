#include "core/calibration/held_out.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::calibration {

int foldOf(int pose, const CalibrationOptions& options) { return (pose / options.fold_size) % options.folds; }

std::vector<double> weightsWhere(const UnloadedDay& day, const std::function<bool(int)>& uses) {
  std::vector<double> weights;
  weights.reserve(day.readings());
  for (const Posture& posture : day.postures)
    weights.insert(weights.end(), posture.readings.size(), uses(posture.pose) ? 1.0 : 0.0);
  return weights;
}

void addErrors(const std::vector<Eigen::Vector3d>& residuals, const std::vector<double>& weights,
               PositionErrors& errors) {
  double sum = errors.rms * errors.rms * static_cast<double>(errors.readings);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    sum += residuals[i].squaredNorm();
    errors.largest = std::max(errors.largest, residuals[i].norm());
    ++errors.readings;
  }
  errors.rms = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, errors.readings)));
}

}  // namespace stiffscope::calibration
