#include "core/planning/exchange_design.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace stiffscope {

namespace {


class Exchange {
 public:
  explicit Exchange(const DesignProblem& problem) : problem_(problem) {
    Vector6d mean = problem.known.diagonal();
    for (const Matrix6d& one : problem.information)
      mean += one.diagonal() / static_cast<double>(problem.information.size());
    for (int j = 0; j < 6; ++j) {
      const bool counts = problem.unknown[static_cast<std::size_t>(j)] && mean[j] > 0.0;
      scale_[j] = counts ? 1.0 / std::sqrt(mean[j]) : 0.0;
      base_(j, j) = counts ? 0.0 : 1.0;
    }
    // A ridge so small that it decides nothing keeps the first choices of a design comparable.
    constexpr double kRidge = 1e-10;
    base_ += scaled(problem.known) + kRidge * Matrix6d::Identity();
    for (const Matrix6d& one : problem.information) information_.push_back(scaled(one));
  }

  Matrix6d sumOf(const std::vector<std::size_t>& chosen) const {
    Matrix6d sum = base_;
    for (const std::size_t one : chosen) sum += information_[one];
    return sum;
  }

  /// designValue, on scaled sums.
  double valueOf(const Matrix6d& sum) const {
    if (!problem_.reference) return choleskyLogDeterminant(sum);
    const Eigen::LLT<Matrix6d> cholesky(sum);
    if (cholesky.info() != Eigen::Success) return kNever;
    const Matrix6d inverse = cholesky.solve(Matrix6d::Identity());
    return balanceOf(scale_.cwiseProduct(inverse.diagonal().cwiseSqrt()), *problem_.reference,
                     problem_.unknown);
  }

  /// The best candidate to join `others`; the candidate count where none may.
  std::pair<std::size_t, double> bestWith(const Matrix6d& sum, const std::vector<std::size_t>& others) const {
    std::pair<std::size_t, double> best{information_.size(), kNever};
    for (std::size_t j = 0; j < information_.size(); ++j) {
      if (!mayJoin(j, others)) continue;
      const double value = valueOf(sum + information_[j]);
      if (value > best.second) best = {j, value};
    }
    return best;
  }

  bool mayJoin(std::size_t candidate, const std::vector<std::size_t>& others) const {
    if (!problem_.barred.empty() && problem_.barred[candidate]) return false;
    return std::none_of(others.begin(), others.end(), [&](std::size_t other) {
      return other == candidate || (!problem_.excludes.empty() && problem_.excludes[candidate][other]);
    });
  }

  /// Exchanges until none helps. Returns the passes made.
  int improve(std::vector<std::size_t>& chosen, int most_passes) const {
    constexpr double kWorthwhile = 1e-9;  // of the logarithm
    double value = valueOf(sumOf(chosen));
    for (int pass = 1; pass <= most_passes; ++pass) {
      const double before = value;
      for (std::size_t place = 0; place < chosen.size(); ++place) {
        std::vector<std::size_t> others = chosen;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(place));
        const auto [candidate, found] = bestWith(sumOf(others), others);
        if (found > value + kWorthwhile) chosen[place] = candidate, value = found;
      }
      if (value <= before + kWorthwhile) return pass;
    }
    return most_passes;
  }

  /// Ordered so that each next one adds most.
  std::vector<std::size_t> ordered(std::vector<std::size_t> chosen) const {
    std::vector<std::size_t> order;
    Matrix6d sum = base_;
    while (!chosen.empty()) {
      const auto best = std::max_element(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) {
        return choleskyLogDeterminant(sum + information_[a]) < choleskyLogDeterminant(sum + information_[b]);
      });
      sum += information_[*best];
      order.push_back(*best);
      chosen.erase(best);
    }
    return order;
  }

 private:
  Matrix6d scaled(const Matrix6d& matrix) const { return scale_.asDiagonal() * matrix * scale_.asDiagonal(); }

  const DesignProblem& problem_;
  Vector6d scale_ = Vector6d::Zero();
  Matrix6d base_ = Matrix6d::Zero();
  std::vector<Matrix6d> information_;
};

std::vector<std::size_t> randomChoice(const Exchange& exchange, std::size_t candidates, int count,
                                      std::mt19937_64& random) {
  std::vector<std::size_t> order(candidates), chosen;
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = 0; i < candidates && static_cast<int>(chosen.size()) < count; ++i) {
    std::swap(order[i],
              order[i + random() % (candidates - i)]);  // Fisher-Yates; the bias of % is below 1e-15 here
    if (exchange.mayJoin(order[i], chosen)) chosen.push_back(order[i]);
  }
  return chosen;
}

}  // namespace

Matrix6d informationOf(const DesignProblem& problem, const std::vector<std::size_t>& chosen) {
  Matrix6d sum = problem.known;
  for (const std::size_t one : chosen) sum += problem.information[one];
  return sum;
}

std::vector<std::size_t> randomDesign(const DesignProblem& problem, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  return randomChoice(Exchange(problem), problem.information.size(), count, random);
}

Design exchangeDesign(const DesignProblem& problem, int count, const ExchangeOptions& options) {
  const Exchange exchange(problem);
  std::mt19937_64 random(options.seed);
  Design best;
  double best_value = kNever;
  const bool given = !options.from.empty();
  for (int start = 0; start < std::max(1, options.starts + (given ? 1 : 0)); ++start) {
    std::vector<std::size_t> chosen = given && start == 0
                                          ? options.from
                                          : randomChoice(exchange, problem.information.size(), count, random);
    best.passes += exchange.improve(chosen, options.most_passes);
    const double value = exchange.valueOf(exchange.sumOf(chosen));
    if (start > 0 &&
        (chosen.size() < best.chosen.size() || (chosen.size() == best.chosen.size() && value <= best_value)))
      continue;
    best_value = value;
    best.chosen = std::move(chosen);
  }
  best.chosen = exchange.ordered(std::move(best.chosen));
  best.log_determinant = logDeterminant(informationOf(problem, best.chosen), problem.unknown);
  return best;
}

}  // namespace stiffscope
