#include "core/diagnosis/known_beforehand.h"

#include "core/diagnosis/sag_by_body.h"

namespace stiffscope {

namespace {

/// m and rad, a round: wide beside what a round corrects, and narrow enough that a motion of everything,
/// which is free by choice of frame, stays where linear steps and rounding are good.
constexpr double kGeometryPrior = 3e-3;
constexpr double kSweptGeometry =
    1e-3;  // m and rad: where nothing absolute is fitted, as a calibrated or sagging arm has it
constexpr double kWeightPrior = 0.1;  // of a body's weight: masses of a URDF are no better

void addGeometryAndWeights(const GapInput& input, GapData& data) {
  for (Eigen::Index k = 0; k < GeometrySteps::count(input.campaign.targets.size()); ++k) {
    const Eigen::Index at = data.layout.geometry + k;
    const double prior = input.absolute ? kGeometryPrior : kSweptGeometry;
    data.sweeps(at, at) += 1.0 / (prior * prior);
  }
  for (Eigen::Index k = 0; k < kBodies; ++k) {
    const Eigen::Index at = data.layout.weights + k;
    data.sweeps(at, at) += 1.0 / (kWeightPrior * kWeightPrior);
  }
}

void addCompliances(const GapInput& input, GapData& data) {
  const Eigen::Index end = data.layout.end;
  for (Eigen::Index j = 0; j < 6; ++j) {
    const double value = input.expected.value[j], sd = input.expected.sd[j];
    if (sd <= 0.0) continue;
    const double weight = 1.0 / (sd * sd);
    data.sweeps(j, j) += weight;
    data.sweeps(j, end) += weight * value;
    data.sweeps(end, j) += weight * value;
    data.sweeps(end, end) += weight * value * value;
  }
}

void addNests(const GapInput& input, GapData& data) {
  if (input.drift_weight.isZero()) return;
  for (std::size_t m = 0; m < input.models.size(); ++m) {
    if (input.models[m].effect != Effect::tracker_drift) continue;
    const Eigen::Index at = data.layout.model_at[m], end = data.layout.end;
    const Vector6d right = input.drift_weight * input.drift;
    data.sweeps.block<6, 6>(at, at) += input.drift_weight;
    data.sweeps.block<6, 1>(at, end) += right;
    data.sweeps.block<1, 6>(end, at) += right.transpose();
    data.sweeps(end, end) += input.drift.dot(right);
    data.sweep_rows += 6;
  }
}

}  // namespace

void addKnownBeforehand(const GapInput& input, GapData& data) {
  addGeometryAndWeights(input, data);
  addCompliances(input, data);
  addNests(input, data);
}

}  // namespace stiffscope
