#include "core/diagnosis/model_error.h"

#include <algorithm>
#include <cmath>

namespace stiffscope {

namespace {

/// rms per coordinate of what the fit leaves at the largest load of each posture, less the noise.
double leftAtLargestLoad(const GapFit& fit) {
  Eigen::VectorXd all(fit.nuisances.size() + fit.set.effects.size());
  all << fit.nuisances, fit.set.effects;
  double squares = 0.0, count = 0.0;
  for (const GapPosture& posture : fit.data.postures) {
    const Eigen::VectorXd left = posture.right - posture.columns * all;
    const std::size_t s = heaviestState(posture.states);
    if (s == 0) continue;
    const Eigen::Index per_state = posture.states.front().rows();
    const Eigen::Index at = posture.position_rows + static_cast<Eigen::Index>(s - 1) * per_state;
    squares +=
        left.segment(at, per_state).squaredNorm() - posture.noiseSquares(at, per_state);
    count += static_cast<double>(per_state);
  }
  return count > 0.0 ? std::sqrt(std::max(0.0, squares / count)) : 0.0;
}

}  // namespace

double modelError(const GapFit& fit, const FitRules& rules) {
  const double rows = fit.rules.loading_rows, left = leftPerEquation(fit);
  constexpr double kSigmas = 4.0;
  const double doubt = std::sqrt(2.0 / rows + (rules.noise_degrees > 0.0 ? 2.0 / rules.noise_degrees : 0.0));
  if (fit.state.model_error == 0.0 && left - 1.0 < kSigmas * doubt) return 0.0;
  double before = 0.0, after = 0.0, count = 0.0;
  Eigen::VectorXd old = Eigen::VectorXd::Zero(fit.data.layout.end), now = old;
  old.head(fit.nuisances_before.size()) = fit.nuisances_before;
  now << fit.nuisances, fit.set.effects;
  for (const GapPosture& posture : fit.data.postures) {
    const Eigen::Index loads = posture.right.size() - posture.position_rows;
    before += (posture.right - posture.columns * old).tail(loads).squaredNorm();
    after += (posture.right - posture.columns * now).tail(loads).squaredNorm();
    count += static_cast<double>(loads);
  }
  const double removed = std::sqrt(std::max(0.0, before - after) / count);
  constexpr double kShareOfRemoved = 0.1;
  const double limit =
      std::max(std::sqrt(fit.rules.least_drop / rows) * fit.data.state_noise, kShareOfRemoved * removed);
  const double error =
      fit.state.model_error == 0.0
          ? std::max(leftAtLargestLoad(fit), std::sqrt(std::max(0.0, left - 1.0)) * fit.data.state_noise)
          : leftAtLargestLoad(fit);
  return error > limit ? error : 0.0;
}

}  // namespace stiffscope
