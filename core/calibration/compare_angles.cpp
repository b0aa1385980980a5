#include "core/calibration/calibrate.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::calibration {

namespace {

/// See AngleComparison::significance. Reflectors of one posture share its angles, so postures are the sample.
double significanceOf(const UnloadedDay& day, const std::vector<double>& weights,
                      const std::vector<Eigen::Vector3d>& reported, const std::vector<Eigen::Vector3d>& commanded) {
  std::vector<double> gains;
  std::size_t at = 0;
  for (const Posture& posture : day.postures) {
    double gain = 0.0;
    for (std::size_t k = 0; k < posture.readings.size(); ++k, ++at) {
      if (weights[at] > 0.0) gain += reported[at].squaredNorm() - commanded[at].squaredNorm();
    }
    gains.push_back(gain);
  }
  const Eigen::Map<const Eigen::ArrayXd> all(gains.data(), static_cast<Eigen::Index>(gains.size()));
  const double count = static_cast<double>(gains.size()), mean = all.mean();
  const double sd = std::sqrt((all - mean).square().sum() / std::max(1.0, count - 1.0) / count);
  return sd > 0.0 ? mean / sd : 0.0;
}

}  // namespace

double largestDifference(const campaign::Campaign& campaign) {
  if (!campaign.states) return 0.0;
  const PerJoint<bool> joints = commandedJoints(campaign);
  double largest = 0.0;
  for (const campaign::State& state : campaign.states->rows) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const auto at = static_cast<Eigen::Index>(j);
      if (joints[j] && state.step == 0)
        largest = std::max(largest, std::abs(state.q[at] - state.extras().commanded[at]));
    }
  }
  return largest;
}

AngleComparison compareAngles(const UnloadedDay& day, const HeldOutReadings& reported,
                              const HeldOutReadings& commanded) {
  AngleComparison result;
  std::vector<double> weights;
  for (std::size_t i = 0; i < reported.residuals.size(); ++i) {
    const bool predicted = reported.residuals[i].allFinite() && commanded.residuals[i].allFinite();
    const bool right = reported.weights[i] > 0.0 || commanded.weights[i] > 0.0;
    weights.push_back(predicted && right ? 1.0 : 0.0);
  }
  addErrors(reported.residuals, weights, result.reported);
  addErrors(commanded.residuals, weights, result.commanded);
  result.significance = significanceOf(day, weights, reported.residuals, commanded.residuals);
  constexpr double kBeyondChance = 3.0;
  if (std::abs(result.significance) > kBeyondChance)
    result.better = result.significance > 0.0 ? JointAngles::commanded : JointAngles::reported;
  return result;
}

}  // namespace stiffscope::calibration
