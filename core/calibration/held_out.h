#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/calibration/unloaded_day.h"

namespace stiffscope::calibration {

struct CalibrationOptions {
  int folds = 2;  ///< at least 2
  int fold_size =
      1;  ///< posture i (from 0, in the order of the campaign) belongs to fold floor(i / fold_size) mod folds
  JointAngles angles = JointAngles::reported;
  int divisions = 0;  ///< other divisions into as many folds, drawn, for what the division does to held-out figures
};

int foldOf(int pose, const CalibrationOptions& options);

/// Weight 1 of the readings of postures (numbers of the campaign) that `uses` asks for, 0 of the others; one a reading
/// in the order of the day.
std::vector<double> weightsWhere(const UnloadedDay& day, const std::function<bool(int)>& uses);

/// Plain 3-D position errors over postures and reflectors, rejected readings left out, m.
struct PositionErrors {
  double rms = 0.0, largest = 0.0;
  std::size_t readings = 0;
};

/// Counts the residuals (m) whose weight is above 0 in.
void addErrors(const std::vector<Eigen::Vector3d>& residuals, const std::vector<double>& weights,
               PositionErrors& errors);

}  // namespace stiffscope::calibration
