#include "core/extended_model/hidden_effects.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/extended_model/horseshoe.h"
#include "core/numerics/parallel.h"
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

/// N(mean, sd^2) given that it is positive.
double positiveNormal(double mean, double sd, RandomStream& random) {
  return std::max(0.0, mean + sd * numerics::normalBetween(-mean / sd, kInfinity, random.uniform()));
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
    findRivals();
    for (std::size_t i = 0; i < shares_.size(); ++i)
      shares_[i] = 1.0 / (1.0 + std::exp(kEnds - kEndsStep * static_cast<double>(i)));
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

  /// Parameters that share one l, all of them positive.
  struct Alike {
    std::size_t local = 0, effect = 0;  ///< l and t
    bool alone = false;                 ///< the effect has no others
    std::vector<Eigen::Index> of;       ///< counted among those that are positive
    const ScaleMixture* mixture = nullptr;
  };

  /// Two such groups that the data hardly tell apart: either may be what explains them.
  struct Rivals {
    std::array<Alike, 2> groups;
    std::vector<Eigen::Index> both;  ///< parameters of the one, then of the other
  };

  std::vector<Alike> alikeGroups() {
    std::vector<Alike> groups;
    std::vector<int> of_effect(effect_.of.size(), 0);
    for (std::size_t s = 0; s < local_.of.size(); ++s) {
      const std::vector<Eigen::Index>& of = local_.of[s];
      if (of.empty()) continue;
      const auto effect = static_cast<std::size_t>(effect_of_[static_cast<std::size_t>(of.front())]);
      ++of_effect[effect];
      if (of.front() < either_sign_) continue;
      groups.push_back({s, effect, false, of, nullptr});
      for (Eigen::Index& i : groups.back().of) i -= either_sign_;
    }
    for (Alike& one : groups) {
      one.alone = of_effect[one.effect] == 1;
      one.mixture = &mixtures_.try_emplace({one.of.size(), one.alone}, one.of.size(), one.alone).first->second;
    }
    return groups;
  }

  void findRivals() {
    const Eigen::Index count = x_.size() - either_sign_;
    if (count == 0) return;
    // Where the other parameters may have any size that is physical, as these may.
    Eigen::MatrixXd block = all_.normal.topLeftCorner(either_sign_, either_sign_);
    block.diagonal().array() += 1.0;
    const Eigen::MatrixXd through =
        ScaledFactor(std::move(block)).lower(all_.normal.topRightCorner(either_sign_, count));
    Eigen::MatrixXd seen = all_.normal.bottomRightCorner(count, count) - through.transpose() * through;
    seen.diagonal() = seen.diagonal().cwiseMax(0.0).array() + 1.0;
    const std::vector<Alike> groups = alikeGroups();
    for (std::size_t a = 0; a < groups.size(); ++a) {
      const std::vector<Eigen::Index>& of_a = groups[a].of;
      const Eigen::LLT<Eigen::MatrixXd> factor_a(seen(of_a, of_a));
      for (std::size_t b = 0; b < a; ++b) {
        const std::vector<Eigen::Index>& of_b = groups[b].of;
        const Eigen::LLT<Eigen::MatrixXd> factor_b(seen(of_b, of_b));
        const Eigen::MatrixXd half = factor_a.matrixL().solve(Eigen::MatrixXd(seen(of_a, of_b)));
        const Eigen::MatrixXd common = factor_b.matrixL().solve(half.transpose());
        constexpr double kRivals = 0.8;  // largest canonical correlation
        if (Eigen::JacobiSVD<Eigen::MatrixXd>(common).singularValues()[0] < kRivals) continue;
        rivals_.push_back({{groups[a], groups[b]}, of_a});
        rivals_.back().both.insert(rivals_.back().both.end(), of_b.begin(), of_b.end());
      }
    }
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
      if (sweep + 1 == kSweeps) {
        for (const Rivals& one : rivals_) exchange(one, seen);
      }
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
      const double step = mean + sd * numerics::normalBetween((low - mean) / sd, (high - mean) / sd, random_.uniform());
      if (!std::isfinite(step)) continue;
      seen.slope -= step * along;
      x = (x + step * line).cwiseMax(0.0);
    }
  }

  /// Sum of squares of a group's parameters along a line, in units of its scale's usual square.
  struct SquaresAlong {
    double here = 0.0, cross = 0.0, of_line = 0.0, unit = 1.0;

    double at(double step) const { return std::max(here + step * (2.0 * cross + step * of_line), kLeastSquare) / unit; }
  };

  /// One explanation for the other: both groups' parameters along a line, and their scales with them. Few lines lead
  /// from where one group is as good as zero to where the other is, and with the scales held hardly a step of them is
  /// ever made. So the step is drawn with both scales integrated out, and the scales are drawn for it; what both
  /// densities lose between their places is made good by taking or leaving the whole (Metropolis and Hastings).
  void exchange(const Rivals& rivals, Seen& seen) {
    // As many random numbers whatever comes of them.
    const Eigen::VectorXd normal = normals(static_cast<Eigen::Index>(rivals.both.size()), 1);
    std::array<double, 6> uniform;
    for (double& one : uniform) one = random_.uniform();

    auto x = x_.tail(seen.slope.size());
    Eigen::MatrixXd block = seen.normal(rivals.both, rivals.both);
    block.diagonal().array() += 1.0;
    const Eigen::VectorXd line = ScaledFactor(std::move(block)).upper(normal);
    Eigen::VectorXd along = Eigen::VectorXd::Zero(seen.slope.size());
    for (Eigen::Index k = 0; k < line.size(); ++k)
      along += line[k] * seen.normal.col(rivals.both[static_cast<std::size_t>(k)]);
    std::array<SquaresAlong, 2> squares;
    double curvature = 0.0, slope = 0.0, low = -kInfinity, high = kInfinity;
    for (Eigen::Index k = 0; k < line.size(); ++k) {
      const Eigen::Index i = rivals.both[static_cast<std::size_t>(k)];
      SquaresAlong& own = squares[k < std::ssize(rivals.groups[0].of) ? 0 : 1];
      own.here += x[i] * x[i], own.cross += x[i] * line[k], own.of_line += line[k] * line[k];
      curvature += line[k] * along[i], slope += line[k] * seen.slope[i];
      if (line[k] > 0.0) low = std::max(low, -x[i] / line[k]);
      if (line[k] < 0.0) high = std::min(high, -x[i] / line[k]);
    }
    if (!(curvature > kLeastSquare)) return;
    const double mean = slope / curvature, sd = 1.0 / std::sqrt(curvature);
    constexpr double kFar = 5.0;
    low = std::max(low, mean - kFar * sd), high = std::min(high, mean + kFar * sd);
    if (!(low < 0.0 && high > 0.0)) return;

    // step = low + (high - low) / (1 + exp(-u)): as fine at both ends, where the prior has its poles, as need be.
    const double length = high - low;
    const auto logSeen = [&](double step) { return -0.5 * (step - mean) * (step - mean) * curvature; };
    for (std::size_t g = 0; g < 2; ++g) squares[g].unit = unitOf(rivals.groups[g]);
    std::array<double, PiecewiseDensity::kPlaces> density;
    for (std::size_t i = 0; i < density.size(); ++i) {
      const double step = low + length * shares_[i];
      density[i] = logSeen(step);
      for (std::size_t g = 0; g < 2; ++g) density[i] += rivals.groups[g].mixture->logMarginal(squares[g].at(step));
    }
    const double most = *std::max_element(density.begin(), density.end());
    for (std::size_t i = 0; i < density.size(); ++i)
      density[i] = std::exp(density[i] - most) * shares_[i] * (1.0 - shares_[i]);
    const PiecewiseDensity steps(-kEnds, kEndsStep, density);
    const double u = steps.draw(uniform[0]), share = 1.0 / (1.0 + std::exp(-u)), step = low + length * share;
    const double share_now = -low / length, u_now = std::log(-low / high);
    double ratio = logSeen(step) - logSeen(0.0) + steps.logDensity(u_now) - steps.logDensity(u) +
                   std::log(share * (1.0 - share) / (share_now * (1.0 - share_now)));
    std::array<double, 2> scale;
    for (std::size_t g = 0; g < 2; ++g) {
      const ScaleMixture& mixture = *rivals.groups[g].mixture;
      const double now = std::log(squareOf(rivals.groups[g]) / squares[g].unit);
      const double sum_now = squares[g].at(0.0), sum = squares[g].at(step);
      const PiecewiseDensity back = mixture.scaleGiven(sum_now), there = mixture.scaleGiven(sum);
      scale[g] = there.draw(uniform[1 + g]);
      ratio += mixture.logJoint(sum, scale[g]) - there.logDensity(scale[g]);
      ratio -= mixture.logJoint(sum_now, now) - back.logDensity(now);
    }
    if (!(std::log(uniform[3]) < ratio)) return;
    seen.slope -= step * along;
    for (Eigen::Index k = 0; k < line.size(); ++k) {
      double& one = x[rivals.both[static_cast<std::size_t>(k)]];
      one = std::max(0.0, one + step * line[k]);
    }
    for (std::size_t g = 0; g < 2; ++g) takeScale(rivals.groups[g], std::exp(scale[g]), uniform[4 + g]);
  }

  double unitOf(const Alike& group) const {
    return group.alone ? kUsual * kUsual : effect_.square[static_cast<Eigen::Index>(group.effect)];
  }

  /// (l t)^2
  double squareOf(const Alike& group) const {
    return local_.square[static_cast<Eigen::Index>(group.local)] *
           effect_.square[static_cast<Eigen::Index>(group.effect)];
  }

  /// `share`: that in units.
  void takeScale(const Alike& group, double share, double uniform) {
    double& local = local_.square[static_cast<Eigen::Index>(group.local)];
    local = share;
    if (!group.alone) return;
    const double of_effect = factorOfProduct(share, uniform);
    local = share / of_effect;
    effect_.square[static_cast<Eigen::Index>(group.effect)] = of_effect * kUsual * kUsual;
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

  /// A scale times f > 0, its parameters times f: chi2 is quadratic in f, and of the prior only the half-Cauchy
  /// changes, under a height of which f is drawn (slice sampling; Neal, Annals of Statistics 31, 2003, 705).
  void stretch(const std::vector<Eigen::Index>& of, Eigen::Index first, double usual, double& square, Seen& seen) {
    Eigen::VectorXd along = Eigen::VectorXd::Zero(seen.slope.size());
    for (const Eigen::Index i : of) along += seen.normal.col(i - first) * x_[i];
    double curvature = 0.0, slope = 0.0;
    for (const Eigen::Index i : of) curvature += x_[i] * along[i - first], slope += x_[i] * seen.slope[i - first];
    const double height = random_.uniform(), place = random_.uniform();
    if (!(curvature > kLeastSquare)) return;
    const double mean = 1.0 + slope / curvature, sd = 1.0 / std::sqrt(curvature);
    const double most = std::sqrt(1.0 + (usual / square + 1.0) * (1.0 / height - 1.0));
    const double factor = mean + sd * numerics::normalBetween(-mean / sd, (most - mean) / sd, place);
    const double stretched = factor * factor * square;
    if (!(factor > 0.0 && stretched > kLeastSquare)) return;
    square = stretched;
    seen.slope -= (factor - 1.0) * along;
    for (const Eigen::Index i : of) x_[i] *= factor;
  }

  static constexpr double kLeastSquare = 1e-60;
  static constexpr double kEnds = 15.0;  // of u: to 3e-7 of a line's length from its ends
  static constexpr double kEndsStep = 2.0 * kEnds / static_cast<double>(PiecewiseDensity::kPlaces - 1);

  RandomStream random_;
  std::vector<Eigen::Index> order_;                 ///< of the evidence, here
  Eigen::Index either_sign_ = 0;                    ///< how many are not positive by physics
  Seen all_;                                        ///< of all parameters
  Eigen::VectorXd right_;                           ///< b
  Eigen::VectorXd x_;                               ///< the parameters
  std::vector<double> known_weight_;                ///< of those that are declared, 1 / sd^2; else 0
  std::vector<Eigen::Index> local_of_, effect_of_;  ///< the scales of each parameter
  Scales local_, effect_;                           ///< l and t
  std::map<std::pair<std::size_t, bool>, ScaleMixture> mixtures_;
  std::vector<Rivals> rivals_;
  std::array<double, PiecewiseDensity::kPlaces> shares_{};  ///< of a line's length, where its density is asked for
};

}  // namespace

Eigen::MatrixXd drawEffects(const EffectEvidence& evidence, const PosteriorOptions& options) {
  Eigen::MatrixXd draws(evidence.right.size(), options.draws);
  if (draws.size() == 0) return draws;
  const auto chains = static_cast<std::size_t>(options.chains);
  numerics::onAllCores(chains, [&](std::size_t c) {
    const auto firstOf = [&](std::size_t chain) {
      return draws.cols() * static_cast<Eigen::Index>(chain) / options.chains;
    };
    Sampler sampler(evidence, options.seed * chains + c);
    for (int i = 0; i < options.warm_up; ++i) sampler.next();
    for (Eigen::Index i = firstOf(c); i < firstOf(c + 1); ++i) draws.col(i) = sampler.next();
  });
  return draws;
}

}  // namespace stiffscope::extended_model
