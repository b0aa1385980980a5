#include "core/diagnosis/gap_data.h"

#include <algorithm>

#include "core/diagnosis/known_beforehand.h"
#include "core/diagnosis/posture_equations.h"
#include "core/diagnosis/sag_by_body.h"
#include "core/diagnosis/sweep_equations.h"

namespace stiffscope {

double GapPosture::noiseSquares(Eigen::Index first, Eigen::Index rows) const {
  double sum = 0.0;
  for (Eigen::Index row = first; row < first + rows; ++row) sum += noise(row, row % noise.cols());
  return sum;
}

ComplianceExpected complianceExpected(const Vector6d& identified) {
  constexpr double kNothing = 0.05;  // of the neighbours': not identified
  constexpr double kHalf = 0.5, kThrice = 3.0;
  ComplianceExpected expected;
  for (Eigen::Index j = 0; j < 6; ++j) {
    const double neighbour = std::max(j > 0 ? identified[j - 1] : 0.0, j < 5 ? identified[j + 1] : 0.0);
    const bool known = identified[j] > kNothing * neighbour;
    expected.value[j] = known ? identified[j] : kHalf * neighbour;
    expected.sd[j] = known ? kThrice * identified[j] : kHalf * neighbour;
  }
  return expected;
}

GapLayout gapLayout(const std::vector<EffectModel>& models, std::size_t targets) {
  GapLayout layout;
  layout.weights = layout.geometry + GeometrySteps::count(targets);
  layout.effects = layout.weights + kBodies;
  layout.end = layout.effects;
  for (const EffectModel& model : models) {
    layout.model_at.push_back(layout.end);
    layout.end += static_cast<Eigen::Index>(model.parameters());
  }
  return layout;
}

GapData gapData(const GapInput& input, const GapState& state, const ContainedEffects& effects_now) {
  GapData data;
  data.layout = gapLayout(input.models, input.campaign.targets.size());
  data.sweeps.setZero(data.layout.end + 1, data.layout.end + 1);
  addPostureEquations(input, state, effects_now, data);
  addKnownBeforehand(input, data);
  if (input.sweeps) addSweepEquations(input, state, effects_now, data);
  return data;
}

}  // namespace stiffscope
