#include "core/extended_model/hidden_effects.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/numerics/random.h"

namespace stiffscope::extended_model {

namespace {

using numerics::RandomStream;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

/// A standard normal number given that it lies between these, which may be infinite; `low` where nothing lies between.
double normalBetween(double low, double high, RandomStream& random) {
  if (!(low < high)) return low;
  if (low + high < 0.0) return -normalBetween(-high, -low, random);
  // From here on the upper tail is the smaller one, and its probabilities are exact.
  constexpr double kTail = 5.0;
  if (low < kTail) {
    const auto above = [](double x) { return 0.5 * std::erfc(x / std::sqrt(2.0)); };
    const double least = above(high);
    const double p = std::clamp(least + random.uniform() * (above(low) - least), 1e-300, 1.0 - 1e-16);
    return std::clamp(-numerics::inverseNormal(p), low, high);
  }
  // Beyond it by rejection from an exponential (Robert, Statistics and Computing 5, 1995, 121).
  const double share = -std::expm1(-low * (high - low));
  for (;;) {
    const double beyond = -std::log1p(-random.uniform() * share) / low;
    if (std::log(random.uniform()) <= -0.5 * beyond * beyond) return std::min(low + beyond, high);
  }
}

/// N(mean, sd^2) given that it is positive.
double positiveNormal(double mean, double sd, RandomStream& random) {
  return std::max(0.0, mean + sd * normalBetween(-mean / sd, kInfinity, random));
}

/// What the data say of some parameters: chi2 = x^T normal x - 2 right^T x + const.
struct Seen {
  Eigen::MatrixXd normal;
  Eigen::VectorXd slope;  ///< right - normal x, where the parameters are now
};

/// Scales of the prior with half-Cauchy priors of their own: l of parameters, t of effects.
struct Scales {
  double usual = 1.0;                         ///< of the half-Cauchy
  std::vector<std::vector<Eigen::Index>> of;  ///< parameters of each, rising; in none are those whose size is declared
  Eigen::VectorXd square;                     ///< of each scale
};

/// Factor U^T U of a positive definite matrix, its rows and columns scaled to a unit diagonal.
class ScaledFactor {
 public:
  explicit ScaledFactor(Eigen::MatrixXd matrix) : scale_(matrix.diagonal().cwiseSqrt().cwiseInverse()) {
    matrix = scale_.asDiagonal() * matrix * scale_.asDiagonal();
    constexpr double kRounding = 1e-10;
    matrix.diagonal().array() += kRounding;
    factor_.compute(matrix);
  }

  /// U^-T of these columns, and U^-1 of them.
  Eigen::MatrixXd lower(const Eigen::MatrixXd& columns) const {
    Eigen::MatrixXd solved = scale_.asDiagonal() * columns;
    if (solved.size() > 0) factor_.matrixL().solveInPlace(solved);
    return solved;
  }
  Eigen::MatrixXd upper(Eigen::MatrixXd columns) const {
    if (columns.size() > 0) factor_.matrixU().solveInPlace(columns);
    return scale_.asDiagonal() * columns;
  }

 private:
  Eigen::VectorXd scale_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

/// Parameters of either sign stand first, those that are positive after them.
class Sampler {
 public:
  Sampler(const EffectEvidence& evidence, std::uint64_t seed) : random_(seed, "what could hide") {
    const std::size_t count = evidence.group.size();
    for (const bool positive : {false, true}) {
      for (std::size_t i = 0; i < count; ++i) {
        if (evidence.positive[i] == positive) order_.push_back(static_cast<Eigen::Index>(i));
      }
      if (!positive) either_sign_ = static_cast<Eigen::Index>(order_.size());
    }
    all_.normal = evidence.normal(order_, order_);
    right_ = evidence.right(order_);
    x_.setZero(right_.size());
    for (const Eigen::Index from : order_) {
      const auto i = static_cast<std::size_t>(from);
      const double sd = i < evidence.known_sd.size() ? evidence.known_sd[i] : 0.0;
      known_weight_.push_back(sd > 0.0 ? 1.0 / (sd * sd) : 0.0);
      local_of_.push_back(static_cast<Eigen::Index>(evidence.scale.empty() ? i : evidence.scale[i]));
      effect_of_.push_back(static_cast<Eigen::Index>(evidence.group[i]));
    }
    local_ = scalesOf(local_of_, 1.0);
    effect_ = scalesOf(effect_of_, kUsual);
  }

  /// The parameters in the evidence's order.
  Eigen::VectorXd next() {
    const Eigen::Index positive = x_.size() - either_sign_;
    Eigen::MatrixXd block = all_.normal.topLeftCorner(either_sign_, either_sign_);
    for (Eigen::Index i = 0; i < either_sign_; ++i) block(i, i) += priorWeight(i);
    const ScaledFactor factor(std::move(block));
    const Eigen::MatrixXd through = factor.lower(all_.normal.topRightCorner(either_sign_, positive));
    const Eigen::VectorXd turned = factor.lower(right_.head(either_sign_));
    drawPositive(through, turned);
    x_.head(either_sign_) = factor.upper(turned - through * x_.tail(positive) + normals(either_sign_, 1));
    all_.slope = right_ - all_.normal * x_;
    drawScales(0, all_);
    Eigen::VectorXd in_order(x_.size());
    in_order(order_) = x_;
    return in_order;
  }

 private:
  double priorWeight(Eigen::Index i) const {
    const auto at = static_cast<std::size_t>(i);
    if (known_weight_[at] > 0.0) return known_weight_[at];
    return 1.0 / (local_.square[local_of_[at]] * effect_.square[effect_of_[at]]);
  }

  Scales scalesOf(const std::vector<Eigen::Index>& of, double usual) const {
    Scales scales;
    scales.usual = usual;
    scales.of.resize(of.empty() ? 0 : static_cast<std::size_t>(*std::max_element(of.begin(), of.end())) + 1);
    for (std::size_t i = 0; i < of.size(); ++i) {
      if (known_weight_[i] == 0.0) scales.of[static_cast<std::size_t>(of[i])].push_back(static_cast<Eigen::Index>(i));
    }
    scales.square = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(scales.of.size()), usual * usual);
    return scales;
  }

  Eigen::MatrixXd normals(Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd drawn(rows, columns);
    for (double& one : drawn.reshaped()) one = random_.normal();
    return drawn;
  }

  /// Those that are positive, and their scales, with those of either sign integrated out.
  void drawPositive(const Eigen::MatrixXd& through, const Eigen::VectorXd& turned) {
    const Eigen::Index count = x_.size() - either_sign_;
    if (count == 0) return;
    Seen seen;
    seen.normal = all_.normal.bottomRightCorner(count, count) - through.transpose() * through;
    seen.normal.diagonal() = seen.normal.diagonal().cwiseMax(0.0);
    seen.slope = right_.tail(count) - through.transpose() * turned - seen.normal * x_.tail(count);
    constexpr int kSweeps = 2;  // cheap beside the factor
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      drawOneByOne(seen);
      drawAcross(seen);
      drawScales(either_sign_, seen);
    }
  }

  void drawOneByOne(Seen& seen) {
    for (Eigen::Index i = 0; i < seen.slope.size(); ++i) {
      double& x = x_[either_sign_ + i];
      const double prior = priorWeight(either_sign_ + i), variance = 1.0 / (seen.normal(i, i) + prior);
      const double drawn = positiveNormal(x + variance * (seen.slope[i] - prior * x), std::sqrt(variance), random_);
      seen.slope -= seen.normal.col(i) * (drawn - x);
      x = drawn;
    }
  }

  /// Along lines as far as all stay positive: two that the data hardly tell apart go to and fro together. The lines'
  /// directions are drawn from the normal distribution that the parameters would have if they could be negative.
  void drawAcross(Seen& seen) {
    auto x = x_.tail(seen.slope.size());
    Eigen::VectorXd prior(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) prior[i] = priorWeight(either_sign_ + i);
    Eigen::MatrixXd both = seen.normal;
    both.diagonal() += prior;
    constexpr Eigen::Index kLines = 12;
    const Eigen::MatrixXd lines = ScaledFactor(std::move(both)).upper(normals(x.size(), kLines));
    for (Eigen::Index k = 0; k < kLines; ++k) {
      const auto line = lines.col(k);
      const Eigen::VectorXd along = seen.normal * line;
      const double curvature = line.dot(along) + line.cwiseAbs2().dot(prior);
      const double sd = 1.0 / std::sqrt(curvature);
      const double mean = (line.dot(seen.slope) - line.cwiseProduct(prior).dot(x)) / curvature;
      double low = -kInfinity, high = kInfinity;
      for (Eigen::Index i = 0; i < x.size(); ++i) {
        if (line[i] > 0.0) low = std::max(low, -x[i] / line[i]);
        if (line[i] < 0.0) high = std::min(high, -x[i] / line[i]);
      }
      const double step = mean + sd * normalBetween((low - mean) / sd, (high - mean) / sd, random_);
      if (!std::isfinite(step)) continue;
      seen.slope -= step * along;
      x = (x + step * line).cwiseMax(0.0);
    }
  }

  /// The scales of which all parameters stand from `first` on, which are those of `seen`.
  void drawScales(Eigen::Index first, Seen& seen) {
    drawScales(local_, effect_, effect_of_, first, seen);
    drawScales(effect_, local_, local_of_, first, seen);
  }

  /// Each scale twice (interweaving; Yu and Meng, Journal of Computational and Graphical Statistics 20, 2011, 531):
  /// with its parameters' shares of it held, so that they go with it, and with the parameters held. The one is quick
  /// where the data do not see them, the other where they do. `others`: of the other kind, by parameter `other_of`.
  void drawScales(Scales& scales, const Scales& others, const std::vector<Eigen::Index>& other_of, Eigen::Index first,
                  Seen& seen) {
    for (std::size_t s = 0; s < scales.of.size(); ++s) {
      const std::vector<Eigen::Index>& of = scales.of[s];
      if (of.empty() || of.front() < first) continue;
      double& square = scales.square[static_cast<Eigen::Index>(s)];
      const double usual = scales.usual * scales.usual;
      stretch(of, first, usual, square, seen);
      const double mix = (1.0 / usual + 1.0 / square) / exponential(random_);
      double sum = 0.0;
      for (const Eigen::Index i : of)
        sum += std::max(x_[i] * x_[i], kLeastSquare) / others.square[other_of[static_cast<std::size_t>(i)]];
      square = (1.0 / mix + 0.5 * sum) / gammaOfHalves(of.size() + 1, random_);
    }
  }

  /// A scale times f, its parameters times f: chi2 is quadratic in f, and of the prior only the half-Cauchy changes,
  /// by which f > 0 is taken or not (Metropolis and Hastings).
  void stretch(const std::vector<Eigen::Index>& of, Eigen::Index first, double usual, double& square, Seen& seen) {
    Eigen::VectorXd along = Eigen::VectorXd::Zero(seen.slope.size());
    for (const Eigen::Index i : of) along += seen.normal.col(i - first) * x_[i];
    double curvature = 0.0, slope = 0.0;
    for (const Eigen::Index i : of) curvature += x_[i] * along[i - first], slope += x_[i] * seen.slope[i - first];
    if (!(curvature > kLeastSquare)) return;
    const double factor = positiveNormal(1.0 + slope / curvature, 1.0 / std::sqrt(curvature), random_);
    const double stretched = factor * factor * square;
    if (!(stretched > kLeastSquare) || random_.uniform() * (usual + stretched) > usual + square) return;
    square = stretched;
    seen.slope -= (factor - 1.0) * along;
    for (const Eigen::Index i : of) x_[i] *= factor;
  }

  static constexpr double kLeastSquare = 1e-60;

  RandomStream random_;
  std::vector<Eigen::Index> order_;                 ///< of the evidence, here
  Eigen::Index either_sign_ = 0;                    ///< how many are not positive by physics
  Seen all_;                                        ///< of all parameters
  Eigen::VectorXd right_;                           ///< b
  Eigen::VectorXd x_;                               ///< the parameters
  std::vector<double> known_weight_;                ///< of those that are declared, 1 / sd^2; else 0
  std::vector<Eigen::Index> local_of_, effect_of_;  ///< the scales of each parameter
  Scales local_, effect_;                           ///< l and t
};

}  // namespace

Eigen::MatrixXd drawEffects(const EffectEvidence& evidence, const PosteriorOptions& options) {
  Eigen::MatrixXd draws(evidence.right.size(), options.draws);
  if (draws.size() == 0) return draws;
  Sampler sampler(evidence, options.seed);
  for (int i = 0; i < options.warm_up; ++i) sampler.next();
  for (int i = 0; i < options.draws; ++i) {
    for (int k = 1; k < options.one_of; ++k) sampler.next();
    draws.col(i) = sampler.next();
  }
  return draws;
}

}  // namespace stiffscope::extended_model
