#include "core/extended_model/hidden_effects.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/numerics/random.h"

namespace stiffscope::extended_model {

namespace {

using numerics::RandomStream;

double exponential(RandomStream& random) { return -std::log(random.uniform()); }

/// Gamma of shape `halves` / 2 and scale 1.
double gammaOfHalves(std::size_t halves, RandomStream& random) {
  double sum = 0.0;
  for (std::size_t k = 0; k < halves / 2; ++k) sum += exponential(random);
  if (halves % 2 == 1) {
    const double z = random.normal();
    sum += 0.5 * z * z;
  }
  return sum;
}

/// N(mean, sd^2) given that it is positive.
double positiveNormal(double mean, double sd, RandomStream& random) {
  const double least = -mean / sd;  // of the standard normal number
  constexpr double kTail = 5.0;
  if (least < kTail) {
    const double above = 0.5 * std::erfc(least / std::sqrt(2.0));
    const double p = std::clamp(random.uniform() * above, 1e-300, 1.0 - 1e-16);
    return std::max(0.0, mean - sd * numerics::inverseNormal(p));
  }
  // Beyond it by rejection from an exponential (Robert, Statistics and Computing 5, 1995, 121).
  for (;;) {
    const double beyond = exponential(random) / least;
    if (std::log(random.uniform()) <= -0.5 * beyond * beyond) return sd * beyond;
  }
}

class Sampler {
 public:
  Sampler(const EffectEvidence& evidence, std::uint64_t seed)
      : evidence_(evidence), random_(seed, "what could hide"), x_(Eigen::VectorXd::Zero(evidence.right.size())) {
    for (std::size_t i = 0; i < evidence.positive.size(); ++i)
      (evidence.positive[i] ? positive_ : free_).push_back(static_cast<Eigen::Index>(i));
    const std::size_t groups =
        evidence.group.empty() ? 0 : *std::max_element(evidence.group.begin(), evidence.group.end()) + 1;
    members_.resize(groups, 0);
    for (std::size_t i = 0; i < evidence.group.size(); ++i) members_[evidence.group[i]] += !known(i);
    scale_of_ = evidence.scale;
    if (scale_of_.empty()) {
      scale_of_.resize(evidence.group.size());
      std::iota(scale_of_.begin(), scale_of_.end(), 0);
    }
    const std::size_t scales = scale_of_.empty() ? 0 : *std::max_element(scale_of_.begin(), scale_of_.end()) + 1;
    sharers_.resize(scales, 0);
    for (std::size_t i = 0; i < scale_of_.size(); ++i) sharers_[scale_of_[i]] += !known(i);
    local_ = local_mix_ = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(scales));
    effect_ = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(groups), kUsual * kUsual);
    effect_mix_ = Eigen::VectorXd::Ones(effect_.size());
    among_free_ = evidence.normal(free_, free_);
    free_positive_ = evidence.normal(free_, positive_);
    among_positive_ = evidence.normal(positive_, positive_);
  }

  const Eigen::VectorXd& next() {
    drawParameters();
    drawScales();
    return x_;
  }

 private:
  bool known(std::size_t i) const { return i < evidence_.known_sd.size() && evidence_.known_sd[i] > 0.0; }
  double priorWeight(Eigen::Index i) const {
    const auto at = static_cast<std::size_t>(i);
    if (known(at)) return 1.0 / (evidence_.known_sd[at] * evidence_.known_sd[at]);
    return 1.0 / (local_[scaleOf(i)] * effect_[groupOf(i)]);
  }
  Eigen::Index scaleOf(Eigen::Index i) const {
    return static_cast<Eigen::Index>(scale_of_[static_cast<std::size_t>(i)]);
  }
  Eigen::Index groupOf(Eigen::Index i) const {
    return static_cast<Eigen::Index>(evidence_.group[static_cast<std::size_t>(i)]);
  }

  void drawParameters() {
    // Parameters of either sign by a factor of their own block, rows and columns scaled to a unit diagonal.
    Eigen::MatrixXd block = among_free_;
    for (Eigen::Index i = 0; i < block.rows(); ++i) block(i, i) += priorWeight(free_[static_cast<std::size_t>(i)]);
    const Eigen::VectorXd scale = block.diagonal().cwiseSqrt().cwiseInverse();
    block = scale.asDiagonal() * block * scale.asDiagonal();
    block.diagonal().array() += kRounding;
    const Eigen::LLT<Eigen::MatrixXd> factor(block);
    Eigen::MatrixXd through = scale.asDiagonal() * free_positive_;
    if (through.size() > 0) factor.matrixL().solveInPlace(through);
    const Eigen::VectorXd turned = factor.matrixL().solve(scale.cwiseProduct(evidence_.right(free_).eval()));
    drawPositive(through, turned);
    Eigen::VectorXd noise(block.rows());
    for (double& one : noise) one = random_.normal();
    const Eigen::VectorXd whitened = turned - through * x_(positive_).eval() + noise;
    x_(free_) = scale.cwiseProduct(Eigen::VectorXd(factor.matrixU().solve(whitened)));
  }

  /// One after the other, those of either sign integrated out.
  void drawPositive(const Eigen::MatrixXd& through, const Eigen::VectorXd& turned) {
    Eigen::MatrixXd weight = among_positive_ - through.transpose() * through;
    for (Eigen::Index i = 0; i < weight.rows(); ++i)
      weight(i, i) = std::max(weight(i, i), 0.0) + priorWeight(positive_[static_cast<std::size_t>(i)]);
    Eigen::VectorXd y = x_(positive_);
    Eigen::VectorXd slope = evidence_.right(positive_).eval() - through.transpose() * turned - weight * y;
    constexpr int kSweeps = 4;  // cheap beside the factor, and neighbours in a class follow each other slowly
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      for (Eigen::Index i = 0; i < y.size(); ++i) {
        const double variance = 1.0 / weight(i, i);
        const double drawn = positiveNormal(y[i] + variance * slope[i], std::sqrt(variance), random_);
        slope -= weight.col(i) * (drawn - y[i]);
        y[i] = drawn;
      }
    }
    x_(positive_) = y;
  }

  void drawScales() {
    const auto square = [&](Eigen::Index i) { return std::max(x_[i] * x_[i], kLeastSquare); };
    Eigen::VectorXd of_scale = Eigen::VectorXd::Zero(local_.size()), of_effect = Eigen::VectorXd::Zero(effect_.size());
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      if (!known(static_cast<std::size_t>(i))) of_scale[scaleOf(i)] += square(i) / effect_[groupOf(i)];
    }
    for (Eigen::Index l = 0; l < local_.size(); ++l) {
      const std::size_t sharers = sharers_[static_cast<std::size_t>(l)];
      if (sharers == 0) continue;
      local_[l] = (1.0 / local_mix_[l] + 0.5 * of_scale[l]) / gammaOfHalves(sharers + 1, random_);
      local_mix_[l] = (1.0 + 1.0 / local_[l]) / exponential(random_);
    }
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      if (!known(static_cast<std::size_t>(i))) of_effect[groupOf(i)] += square(i) / local_[scaleOf(i)];
    }
    for (Eigen::Index g = 0; g < effect_.size(); ++g) {
      const std::size_t members = members_[static_cast<std::size_t>(g)];
      effect_[g] = (1.0 / effect_mix_[g] + 0.5 * of_effect[g]) / gammaOfHalves(members + 1, random_);
      effect_mix_[g] = (1.0 / (kUsual * kUsual) + 1.0 / effect_[g]) / exponential(random_);
    }
  }

  static constexpr double kRounding = 1e-10, kLeastSquare = 1e-60;

  const EffectEvidence& evidence_;
  RandomStream random_;
  Eigen::VectorXd x_;
  std::vector<Eigen::Index> free_, positive_;
  std::vector<std::size_t> members_;                         ///< parameters of each effect
  std::vector<std::size_t> scale_of_, sharers_;              ///< the l of each parameter; parameters of each l
  Eigen::VectorXd local_, local_mix_, effect_, effect_mix_;  ///< l^2, t^2 and what mixes them
  Eigen::MatrixXd among_free_, free_positive_, among_positive_;
};

}  // namespace

Eigen::MatrixXd drawEffects(const EffectEvidence& evidence, const PosteriorOptions& options) {
  Eigen::MatrixXd draws(evidence.right.size(), options.draws);
  if (draws.size() == 0) return draws;
  Sampler sampler(evidence, options.seed);
  for (int i = 0; i < options.warm_up; ++i) sampler.next();
  for (int i = 0; i < options.draws; ++i) draws.col(i) = sampler.next();
  return draws;
}

}  // namespace stiffscope::extended_model
