#include "core/comparison/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "metrology/tail_probability.h"

namespace stiffscope::comparison {

namespace {

using identification::CaseEquations;
using identification::Identification;
using identification::Method;

constexpr double kAboveNoise = 3.0;  // times: beyond what a tracker's declared noise may be wrong by
constexpr double kNearNoise = 1.3;   // times, where nothing else tells a misfit from noise
constexpr double kRecurs = 0.05;     // level of the test for a misfit in common
constexpr std::size_t kFewest = 6;   // postures whose products make a t test, after a fit to them

std::optional<Method> methodOfBoth(const Identification& before, const Identification& after) {
  for (const Method method : {Method::partial_pose, Method::complete_pose, Method::decoupled_partial_pose}) {
    const auto has = [&](const Identification& one) {
      return one.of(method).available && one.of(method).target_rows.size() == one.cases.size();
    };
    if (has(before) && has(after)) return method;
  }
  return std::nullopt;
}

std::vector<Eigen::VectorXd> residuals(const std::vector<CaseEquations>& equations, const robot::JointMask& joints) {
  const JointVector compliance = identification::solveNormal(identification::normalEquations(equations), joints);
  std::vector<Eigen::VectorXd> left;
  for (const CaseEquations& one : equations) left.emplace_back(one.right - one.matrix * compliance);
  return left;
}

/// Root mean square over degrees of freedom.
double sigmaOf(double squares, Eigen::Index rows, const robot::JointMask& joints) {
  const Eigen::Index unknowns = std::count(joints.begin(), joints.end(), true);
  return rows > unknowns ? std::sqrt(squares / static_cast<double>(rows - unknowns))
                         : std::numeric_limits<double>::quiet_NaN();
}

double sigmaOf(const std::vector<Eigen::VectorXd>& residuals, const robot::JointMask& joints) {
  double squares = 0.0;
  Eigen::Index rows = 0;
  for (const Eigen::VectorXd& one : residuals) squares += one.squaredNorm(), rows += one.size();
  return sigmaOf(squares, rows, joints);
}

std::optional<double> noiseOf(const Identification& result) {
  if (!result.noise || !(result.noise->per_coordinate > 0.0)) return std::nullopt;
  return result.noise->per_coordinate;
}

/// One-sided p-value of a mean of `values` that is not above zero.
double pOfNoMean(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value, squares += value * value;
  if (!(squares > 0.0)) return 1.0;
  const double n = static_cast<double>(values.size());
  const double spread = std::max(squares - sum * sum / n, std::numeric_limits<double>::min());
  const double t_squared = sum * sum / n / (spread / (n - 1.0));
  const double tail = 0.5 * metrology::fTail(t_squared, 1, n - 1.0);
  return sum > 0.0 ? tail : 1.0 - tail;
}

}  // namespace

bool CommonResidual::isNoise() const {
  if (!available) return false;
  const auto within = [](double left, const std::optional<double>& noise, double times) {
    return noise && left <= times * *noise;
  };
  if (!std::isfinite(recurs_p)) {
    return within(before, noise_before, kNearNoise) && within(after, noise_after, kNearNoise);
  }
  const bool above = (noise_before && !within(before, noise_before, kAboveNoise)) ||
                     (noise_after && !within(after, noise_after, kAboveNoise));
  return recurs_p >= kRecurs && !above;
}

bool CommonResidual::differenceAboveNoise() const {
  return available && noise_before && noise_after && std::isfinite(of_difference) &&
         of_difference > kAboveNoise * std::hypot(*noise_before, *noise_after);
}

namespace {

/// By fits to the postures of both: one to others would leave a misfit of its own.
void judgePairs(const campaign::Campaign& before_campaign, const Identification& before,
                const campaign::Campaign& after_campaign, const Identification& after, Method method,
                const std::vector<PosturePair>& pairs, CommonResidual& result) {
  robot::JointMask joints = before.of(method).estimate.identifiable;
  for (std::size_t j = 0; j < joints.size(); ++j) joints[j] = joints[j] && after.of(method).estimate.identifiable[j];
  std::vector<CaseEquations> rows_before, rows_after;
  for (const PosturePair& pair : pairs) {
    rows_before.push_back(before.of(method).target_rows[pair.before]);
    rows_after.push_back(after.of(method).target_rows[pair.after]);
  }
  const std::vector<Eigen::VectorXd> first = residuals(rows_before, joints), second = residuals(rows_after, joints);
  double squares_before = 0.0, squares_after = 0.0, squares = 0.0;
  Eigen::Index rows = 0;
  std::vector<double> products;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    double own = 0.0;
    for (const ReflectorPair& one : reflectorsInBoth(before_campaign, before.cases[pairs[p].before], after_campaign,
                                                     after.cases[pairs[p].after])) {
      const Eigen::Vector3d b = first[p].segment<3>(static_cast<Eigen::Index>(3 * one.before)),
                            a = second[p].segment<3>(static_cast<Eigen::Index>(3 * one.after));
      own += b.dot(a);
      squares_before += b.squaredNorm(), squares_after += a.squaredNorm(), squares += (a - b).squaredNorm();
      rows += 3;
    }
    products.push_back(own);
  }
  const double scale = std::sqrt(squares_before * squares_after);
  result.correlation = scale > 0.0 ? std::accumulate(products.begin(), products.end(), 0.0) / scale : 0.0;
  result.of_difference = sigmaOf(squares, rows, joints);
  result.recurs_p = pOfNoMean(products);
}

}  // namespace

CommonResidual commonResidual(const campaign::Campaign& before_campaign, const Identification& before,
                              const campaign::Campaign& after_campaign, const Identification& after,
                              const MatchedPostures& matched) {
  CommonResidual result;
  result.of_difference = result.correlation = result.recurs_p = std::numeric_limits<double>::quiet_NaN();
  const std::optional<Method> method = methodOfBoth(before, after);
  if (!method) return result;
  const robot::JointMask &joints_before = before.of(*method).estimate.identifiable,
                         &joints_after = after.of(*method).estimate.identifiable;
  result.available = true;
  result.before = sigmaOf(residuals(before.of(*method).target_rows, joints_before), joints_before);
  result.after = sigmaOf(residuals(after.of(*method).target_rows, joints_after), joints_after);
  result.noise_before = noiseOf(before), result.noise_after = noiseOf(after);
  if (matched.pairs.size() < kFewest) return result;

  judgePairs(before_campaign, before, after_campaign, after, *method, matched.pairs, result);
  return result;
}

}  // namespace stiffscope::comparison
