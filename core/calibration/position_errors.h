#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "core/calibration/calibrate.h"

namespace stiffscope::calibration {

/// Measured less modelled of one reading by every model, in base_link, m.
using ByModel = std::array<Eigen::Vector3d, 4>;  ///< indexed by CalibratedModel; not a number: there is no such model

/// A reading that was not rejected, and how far each model misses it: held out where its fold could be predicted by the
/// others, else by the fit to all.
struct ReadingError {
  std::size_t posture = 0;  ///< index into UnloadedDay::postures
  int target = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< as measured, in base_link by the calibrated geometry, m
  Eigen::Vector3d station = Eigen::Vector3d::Zero();   ///< of the tracker, there
  ByModel left = {};

  const Eigen::Vector3d& of(CalibratedModel model) const { return left[static_cast<std::size_t>(model)]; }
};

/// Errors of all readings that were not rejected, in the order of the day. None where there is no calibration.
std::vector<ReadingError> readingErrors(const Calibration& calibration);

/// Lengths of what a model leaves of each reading, ascending, m.
std::vector<double> errorLengths(const std::vector<ReadingError>& errors, CalibratedModel model);

/// The reading of each posture that `model` misses most, largest first; at most `most` of them.
std::vector<ReadingError> worstPostures(const std::vector<ReadingError>& errors, CalibratedModel model,
                                        std::size_t most);

}  // namespace stiffscope::calibration
