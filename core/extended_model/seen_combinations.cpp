#include "core/extended_model/hidden_effects.h"

#include <algorithm>
#include <cmath>

namespace stiffscope::extended_model {

std::vector<SeenCombination> seenCombinations(const std::vector<HiddenParameter>& parameters,
                                              const Eigen::MatrixXd& moved, const Eigen::MatrixXd& off,
                                              const JointMatrix& own,
                                              const identification::StiffnessEstimate& estimate) {
  std::vector<SeenCombination> seen;
  const auto draws = static_cast<double>(std::max<Eigen::Index>(1, moved.cols()));
  for (int j = 0; j < estimate.joints(); ++j) {
    if (!estimate.identifiable[static_cast<std::size_t>(j)] || !std::isfinite(own(j, j))) continue;
    const double apart = moved.row(j).squaredNorm() / draws, rest = std::max(0.0, own(j, j));
    double least = apart;
    SeenCombination best;
    best.joint = j;
    for (Eigen::Index k = 0; k < off.rows(); ++k) {
      const double square = off.row(k).squaredNorm() / draws, product = moved.row(j).dot(off.row(k)) / draws;
      if (!(square > 0.0)) continue;
      const double left = apart - product * product / square;
      if (left >= least) continue;
      least = left;
      best.parameter = parameters[static_cast<std::size_t>(k)];
      best.ratio = -product / square;
    }
    constexpr double kBetter = 9.0;  // three times the standard uncertainty, squared
    if (!(apart + rest > kBetter * (std::max(0.0, least) + rest))) continue;
    best.value = estimate.compliance[j] + best.ratio * best.parameter.fit;
    best.sd = std::sqrt(std::max(0.0, least) + rest);
    seen.push_back(best);
  }
  return seen;
}

}  // namespace stiffscope::extended_model
