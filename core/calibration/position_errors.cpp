#include "core/calibration/position_errors.h"

#include <algorithm>
#include <cmath>

#include "core/calibration/fitted_day.h"

namespace stiffscope::calibration {

namespace {

/// Of every reading of the day, in its order.
std::vector<Eigen::Vector3d> leftBy(const UnloadedDay& day, const ModelResult& model) {
  std::vector<Eigen::Vector3d> left = model.held_out_residuals;
  const std::vector<Eigen::Vector3d> fitted = residualsOf(day, model.fit);
  left.resize(fitted.size(), Eigen::Vector3d::Constant(std::nan("")));
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!left[i].allFinite()) left[i] = fitted[i];
  }
  return left;
}

}  // namespace

std::vector<ReadingError> readingErrors(const Calibration& calibration) {
  std::vector<ReadingError> errors;
  if (!calibration.reason.empty() || calibration.models.empty()) return errors;
  const UnloadedDay& day = calibration.day;
  const Eigen::Isometry3d base_from_points = calibration.geometry().fit.basePointsMotion();
  const std::vector<double>& weights = calibration.best().fit.weights;
  ByModel none;
  none.fill(Eigen::Vector3d::Constant(std::nan("")));
  for (std::size_t p = 0; p < day.postures.size(); ++p) {
    for (const Reading& reading : day.postures[p].readings)
      errors.push_back(
          {p, reading.target, base_from_points * reading.point, base_from_points * day.stationOf(reading), none});
  }
  for (const ModelResult& model : calibration.models) {
    const std::vector<Eigen::Vector3d> left = leftBy(day, model);
    for (std::size_t i = 0; i < errors.size(); ++i) errors[i].left[static_cast<std::size_t>(model.model)] = left[i];
  }
  std::size_t at = 0;
  std::erase_if(errors, [&](const ReadingError&) { return weights[at++] <= 0.0; });
  return errors;
}

std::vector<double> errorLengths(const std::vector<ReadingError>& errors, CalibratedModel model) {
  std::vector<double> lengths;
  for (const ReadingError& error : errors) {
    if (error.of(model).allFinite()) lengths.push_back(error.of(model).norm());
  }
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

std::vector<ReadingError> worstPostures(const std::vector<ReadingError>& errors, CalibratedModel model,
                                        std::size_t most) {
  std::vector<ReadingError> worst;
  for (const ReadingError& error : errors) {
    if (!error.of(model).allFinite()) continue;
    if (worst.empty() || worst.back().posture != error.posture)
      worst.push_back(error);
    else if (error.of(model).norm() > worst.back().of(model).norm())
      worst.back() = error;
  }
  std::stable_sort(worst.begin(), worst.end(), [model](const ReadingError& a, const ReadingError& b) {
    return a.of(model).norm() > b.of(model).norm();
  });
  if (worst.size() > most) worst.resize(most);
  return worst;
}

}  // namespace stiffscope::calibration
