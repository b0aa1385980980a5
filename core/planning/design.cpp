#include "core/planning/design.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace stiffscope::planning {

namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

/// Exchanges try millions of sums: most machines have six joints, and Matrix is of fixed size for them.
template <class Matrix>
double logDeterminantOf(const Matrix& matrix) {
  const Eigen::LLT<Matrix> cholesky(matrix);
  if (cholesky.info() != Eigen::Success) return kNever;
  double sum = 0.0;
  for (Eigen::Index j = 0; j < matrix.rows(); ++j) sum += std::log(cholesky.matrixLLT()(j, j));
  return 2.0 * sum;
}

/// Diagonal of the inverse of a positive definite matrix; empty where it is none.
template <class Matrix>
JointVector inverseDiagonalOf(const Matrix& matrix) {
  const Eigen::LLT<Matrix> cholesky(matrix);
  if (cholesky.info() != Eigen::Success) return {};
  const Matrix inverse = cholesky.solve(Matrix::Identity(matrix.rows(), matrix.cols()));
  return inverse.diagonal();
}

JointVector inverseDiagonal(const JointMatrix& matrix) {
  return matrix.rows() == 6 ? inverseDiagonalOf<Matrix6d>(matrix) : inverseDiagonalOf<JointMatrix>(matrix);
}

}  // namespace

double choleskyLogDeterminant(const JointMatrix& matrix) {
  return matrix.rows() == 6 ? logDeterminantOf<Matrix6d>(matrix) : logDeterminantOf<JointMatrix>(matrix);
}

double balanceOf(const JointVector& sd, const JointVector& reference, const robot::JointMask& unknown) {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < sd.size(); ++j) {
    if (!unknown[static_cast<std::size_t>(j)]) continue;
    const double square = sd[j] * sd[j] / (reference[j] * reference[j]);
    sum += square * square * square * square;
  }
  return -std::log(sum) / 8.0;
}

double logDeterminant(const JointMatrix& information, const robot::JointMask& unknown) {
  const identification::ScaledNormal normal = identification::scaledNormal(information, unknown);
  double logarithm = choleskyLogDeterminant(normal.matrix);
  for (std::size_t j = 0; j < unknown.size(); ++j) {
    if (!unknown[j]) continue;
    const double scale = normal.scale[static_cast<Eigen::Index>(j)];
    if (scale == 0.0) return kNever;
    logarithm -= 2.0 * std::log(scale);
  }
  return logarithm;
}

JointVector standardDeviations(const JointMatrix& information, const robot::JointMask& unknown) {
  const identification::ScaledNormal normal = identification::scaledNormal(information, unknown);
  const JointVector inverse = inverseDiagonal(normal.matrix);
  JointVector sd =
      JointVector::Constant(static_cast<Eigen::Index>(unknown.size()), std::numeric_limits<double>::quiet_NaN());
  const bool determined = inverse.size() > 0;
  for (Eigen::Index j = 0; j < sd.size(); ++j) {
    if (!unknown[static_cast<std::size_t>(j)]) continue;
    const bool seen = determined && normal.scale[j] > 0.0;
    sd[j] = seen ? normal.scale[j] * std::sqrt(inverse[j]) : std::numeric_limits<double>::infinity();
  }
  return sd;
}

double designValue(const JointMatrix& information, const robot::JointMask& unknown,
                   const std::optional<JointVector>& reference) {
  if (!reference) return logDeterminant(information, unknown);
  return balanceOf(standardDeviations(information, unknown), *reference, unknown);
}

namespace {

class Exchange {
 public:
  explicit Exchange(const DesignProblem& problem) : problem_(problem) {
    const Eigen::Index joints = problem.known.rows();
    scale_ = JointVector::Zero(joints);
    base_ = JointMatrix::Zero(joints, joints);
    JointVector mean = problem.known.diagonal();
    for (const JointMatrix& one : problem.information)
      mean += one.diagonal() / static_cast<double>(problem.information.size());
    for (Eigen::Index j = 0; j < joints; ++j) {
      const bool counts = problem.unknown[static_cast<std::size_t>(j)] && mean[j] > 0.0;
      scale_[j] = counts ? 1.0 / std::sqrt(mean[j]) : 0.0;
      base_(j, j) = counts ? 0.0 : 1.0;
    }
    // A ridge so small that it decides nothing keeps the first choices of a design comparable.
    constexpr double kRidge = 1e-10;
    base_ += scaled(problem.known) + kRidge * JointMatrix::Identity(joints, joints);
    for (const JointMatrix& one : problem.information) information_.push_back(scaled(one));
  }

  JointMatrix sumOf(const std::vector<std::size_t>& chosen) const {
    JointMatrix sum = base_;
    for (const std::size_t one : chosen) sum += information_[one];
    return sum;
  }

  /// designValue, on scaled sums.
  double valueOf(const JointMatrix& sum) const {
    if (!problem_.reference) return choleskyLogDeterminant(sum);
    const JointVector inverse = inverseDiagonal(sum);
    if (inverse.size() == 0) return kNever;
    return balanceOf(scale_.cwiseProduct(inverse.cwiseSqrt()), *problem_.reference, problem_.unknown);
  }

  /// The best candidate to join `others`; the candidate count where none may.
  std::pair<std::size_t, double> bestWith(const JointMatrix& sum, const std::vector<std::size_t>& others) const {
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
    JointMatrix sum = base_;
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
  JointMatrix scaled(const JointMatrix& matrix) const { return scale_.asDiagonal() * matrix * scale_.asDiagonal(); }

  const DesignProblem& problem_;
  JointVector scale_;
  JointMatrix base_;
  std::vector<JointMatrix> information_;
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

JointMatrix informationOf(const DesignProblem& problem, const std::vector<std::size_t>& chosen) {
  JointMatrix sum = problem.known;
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
    std::vector<std::size_t> chosen =
        given && start == 0 ? options.from : randomChoice(exchange, problem.information.size(), count, random);
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

bool alike(const PlanningArm& arm, const Candidate& a, const Candidate& b, double separation) {
  constexpr double kSameWay = 0.9;  // cosine
  if (arm.pull && a.direction.dot(b.direction) < kSameWay) return false;
  for (Eigen::Index joint = arm.pull ? 0 : 1; joint < a.q.size(); ++joint) {
    if (std::abs(std::remainder(a.q[joint] - b.q[joint], 2.0 * EIGEN_PI)) >= separation) return false;
  }
  return true;
}

void refineDesign(const PlanningArm& arm, const PostureRules& rules, const JointMatrix& known,
                  const robot::JointMask& unknown, const std::vector<Candidate>& measured, const RefineOptions& options,
                  std::vector<Candidate>& chosen) {
  const PostureLimits allowed(arm.geometry.arm, arm.joint_readings, rules);
  JointMatrix sum = known;
  for (const Candidate& one : chosen) sum += one.information;
  double value = designValue(sum, unknown, options.reference);
  if (!std::isfinite(value)) return;
  const auto apart = [&](const Candidate& moved, std::size_t place) {
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      if (k != place && alike(arm, moved, chosen[k], options.least_separation)) return false;
    }
    return std::none_of(measured.begin(), measured.end(),
                        [&](const Candidate& one) { return alike(arm, moved, one, options.least_separation); });
  };
  const auto tryMove = [&](std::size_t place, int joint, double step) {
    JointVector q = chosen[place].q;
    const robot::JointLimits& limits = allowed.box()[static_cast<std::size_t>(joint)];
    q[joint] = std::clamp(q[joint] + step, limits.lower, limits.upper);
    if (q[joint] == chosen[place].q[joint] || !allowed.hold(q)) return false;
    const Candidate moved = candidateAt(arm, q, chosen[place].direction);
    const JointMatrix with = sum - chosen[place].information + moved.information;
    const double found = designValue(with, unknown, options.reference);
    constexpr double kWorthwhile = 1e-6;  // of the logarithm
    if (!(found > value + kWorthwhile) || !apart(moved, place)) return false;
    const robot::ArmPosture posture = identification::unloadedPosture(arm.geometry.arm, moved.load_case);
    if (!robot::withinAxisLimits(arm.geometry.arm, q)) return false;
    if (brokenRule(arm, rules, posture, moved.direction) != PostureRule::none) return false;
    chosen[place] = moved, sum = with, value = found;
    return true;
  };
  constexpr int kMostPasses = 30;
  for (double step = options.first_step; step > options.last_step; step *= 0.5) {
    bool moved = true;
    for (int pass = 0; moved && pass < kMostPasses; ++pass) {
      moved = false;
      for (std::size_t place = 0; place < chosen.size(); ++place) {
        for (int joint = 0; joint < arm.geometry.arm.joints(); ++joint) {
          moved |= tryMove(place, joint, step) || tryMove(place, joint, -step);
        }
      }
    }
  }
}

RandomPostures randomPostures(const DesignProblem& problem, int count, int sets, std::uint64_t seed) {
  RandomPostures result;
  PerJoint<std::vector<double>> sds(problem.unknown.size());
  result.sd = JointVector::Constant(problem.known.rows(), std::numeric_limits<double>::quiet_NaN());
  double sum = 0.0;
  for (int set = 0; set < sets; ++set) {
    const auto chosen = randomDesign(problem, count, seed + static_cast<std::uint64_t>(set));
    result.postures = static_cast<int>(chosen.size());
    const JointMatrix information = informationOf(problem, chosen);
    sum += logDeterminant(information, problem.unknown);
    const JointVector sd = standardDeviations(information, problem.unknown);
    for (std::size_t j = 0; j < sds.size(); ++j) sds[j].push_back(sd[static_cast<Eigen::Index>(j)]);
  }
  if (sets < 1) return result;
  result.log_determinant = sum / sets;
  for (std::size_t j = 0; j < sds.size(); ++j) {
    const auto middle = sds[j].begin() + static_cast<std::ptrdiff_t>(sds[j].size() / 2);
    if (problem.unknown[j]) std::nth_element(sds[j].begin(), middle, sds[j].end());
    result.sd[static_cast<Eigen::Index>(j)] = *middle;
  }
  return result;
}

}  // namespace stiffscope::planning
