#include "core/diagnosis/chance_limit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <random>

namespace stiffscope {

double chanceLimit(const GapInput& input, const GapFit& fit, const std::vector<bool>& allowed, int draws,
                   double false_alarm, std::uint64_t seed) {
  const Eigen::VectorXd scale =
      fit.projection.matrix.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * fit.projection.matrix *
                                                              scale.asDiagonal());
  const Eigen::MatrixXd root =
      scale.cwiseInverse().unaryExpr([](double d) { return std::isfinite(d) ? d : 0.0; }).asDiagonal() *
      solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> best;
  for (int draw = 0; draw < draws; ++draw) {
    Projection noise = fit.projection;
    Eigen::VectorXd numbers(noise.right.size());
    for (double& number : numbers) number = normal(random);
    noise.right = root * numbers;
    noise.chi2_none = 0.0;
    noise.by_effects.resize(0, 0);  // the data's own stiffnesses say nothing here
    GapFit plain;
    plain.data.layout = fit.data.layout;
    plain.rules = fit.rules;
    plain.rules.given.clear();
    const Selector selector =
        selectorOf(input, plain, noise, static_cast<double>(fit.data.postures.size()), allowed);
    const auto ranked = selector.ranked(selector.nothing());
    best.push_back(ranked.empty() ? 0.0 : -ranked.front().score());
  }
  if (best.empty()) return 0.0;
  std::sort(best.begin(), best.end());
  const auto at = static_cast<std::size_t>((1.0 - false_alarm) * static_cast<double>(best.size() - 1));
  return std::max(0.0, best[at]);
}

}  // namespace stiffscope
