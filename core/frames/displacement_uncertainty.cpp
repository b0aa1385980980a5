#include "core/frames/displacement_uncertainty.h"

#include <algorithm>

#include "core/frames/reading_covariance.h"
#include "metrology/trilateration.h"

namespace stiffscope::frames {

namespace {

Eigen::Matrix3d meanCovariance(const LoadingReadings& how, const MeanReading& mean) {
  return readingCovariance(how.noise, how.r0_from_loading, mean.in_r0) / std::max(1, mean.readings);
}

/// Without readings and radii: what a displacement d shares by R0 and the scale.
DisplacementUncertainty startOf(const LoadingReadings& how, int pose, int step, const Eigen::Vector3d& d) {
  DisplacementUncertainty result{pose, step, {}, {}};
  result.by_common.setZero(3, CommonTerms::kRadii + static_cast<Eigen::Index>(how.targets));
  result.by_common.leftCols<6>() = metrology::vectorByFrameError(d);
  result.by_common.col(CommonTerms::kScale) = d;
  return result;
}

}  // namespace

CommonTerms commonTerms(const FramesCovariance& frames, double scale_sd) {
  using From = FramesCovariance;
  const Eigen::MatrixXd total = frames.total();
  const Eigen::Index radii = total.rows() - From::kRadii;
  CommonTerms common;
  common.covariance.setZero(CommonTerms::kRadii + radii, CommonTerms::kRadii + radii);
  common.covariance.topLeftCorner<6, 6>() = total.topLeftCorner<6, 6>();
  common.covariance.topRightCorner(6, radii) = total.topRightCorner(6, radii);
  common.covariance.bottomLeftCorner(radii, 6) = total.bottomLeftCorner(radii, 6);
  common.covariance.bottomRightCorner(radii, radii) = total.bottomRightCorner(radii, radii);
  common.covariance(CommonTerms::kScale, CommonTerms::kScale) = scale_sd * scale_sd;
  return common;
}

Eigen::Matrix3d DisplacementUncertainty::loadedPart() const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const ReadingEffect& one : readings) sum += one.by_loaded * one.loaded * one.by_loaded.transpose();
  return sum;
}

Eigen::Matrix3d DisplacementUncertainty::stepZeroPart() const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const ReadingEffect& one : readings) sum += one.by_unloaded * one.unloaded * one.by_unloaded.transpose();
  return sum;
}

Eigen::Matrix3d covarianceBetween(const DisplacementUncertainty& first, const DisplacementUncertainty& second,
                                  const CommonTerms& common) {
  Eigen::Matrix3d sum = first.by_common * common.covariance * second.by_common.transpose();
  if (first.pose != second.pose) return sum;
  for (const ReadingEffect& a : first.readings) {
    for (const ReadingEffect& b : second.readings) {
      if (a.target != b.target) continue;
      sum += a.by_unloaded * a.unloaded * b.by_unloaded.transpose();
      if (first.step == second.step) sum += a.by_loaded * a.loaded * b.by_loaded.transpose();
    }
  }
  return sum;
}

DisplacementUncertainty reflectorDisplacement(const LoadingReadings& how, int pose, int step,
                                              const MeanReading& unloaded, const MeanReading& loaded) {
  DisplacementUncertainty result = startOf(how, pose, step, loaded.in_r0 - unloaded.in_r0);
  result.readings.push_back({loaded.target, -Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity(),
                             meanCovariance(how, unloaded), meanCovariance(how, loaded)});
  return result;
}

std::optional<DisplacementUncertainty> wristDisplacement(const LoadingReadings& how, int pose, int step,
                                                         const TrilateratedState& unloaded,
                                                         const TrilateratedState& loaded) {
  const auto sensitivityOf = [](const TrilateratedState& state) {
    const auto& [a, b, c] = state.reflectors;
    return metrology::trilaterationSensitivity({a.in_r0, b.in_r0, c.in_r0}, state.wrist_in_r0);
  };
  const auto before = sensitivityOf(unloaded), after = sensitivityOf(loaded);
  if (!before || !after) return std::nullopt;
  DisplacementUncertainty result = startOf(how, pose, step, loaded.wrist_in_r0 - unloaded.wrist_in_r0);
  const Eigen::Matrix3d by_radii = after->by_radii - before->by_radii;
  for (std::size_t k = 0; k < 3; ++k) {
    const MeanReading &from = unloaded.reflectors[k], &to = loaded.reflectors[k];
    result.readings.push_back({to.target, -before->by_points[k], after->by_points[k], meanCovariance(how, from),
                               meanCovariance(how, to)});
    result.by_common.col(CommonTerms::kRadii + to.target) = by_radii.col(static_cast<Eigen::Index>(k));
  }
  return result;
}

}  // namespace stiffscope::frames
