#include "core/extended_model/hidden_effects.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"
#include "core/preparation/standing_motion.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::extended_model {

namespace {

/// Of each posture from -1 to 1 over the day; empty where a time is missing or all are one.
std::map<int, double> placesInDay(const campaign::Campaign& campaign) {
  std::map<int, std::pair<double, int>> sums;
  for (const campaign::State& row : campaign.states->rows) {
    if (!std::isfinite(row.time_s)) return {};
    sums[row.pose].first += row.time_s, ++sums[row.pose].second;
  }
  std::map<int, double> places;
  double low = 0.0, high = 0.0;
  for (const auto& [pose, sum] : sums) {
    const double time = places[pose] = sum.first / sum.second;
    low = pose == sums.begin()->first ? time : std::min(low, time);
    high = pose == sums.begin()->first ? time : std::max(high, time);
  }
  if (!(high > low)) return {};
  for (auto& [pose, place] : places) place = 2.0 * (place - low) / (high - low) - 1.0;
  return places;
}

// c, and beta times the size of c
constexpr int kMostUnknowns = kMostJoints + 1;
using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostUnknowns, 1>;
using Normal = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostUnknowns, kMostUnknowns>;

/// beta and t.
struct Trend {
  double share = 0.0, t = 0.0, dof = 0.0;
};

std::optional<Trend> trendOf(const identification::MethodResult& method, const std::map<int, double>& places) {
  const JointVector& c = method.estimate.compliance;
  const Eigen::Index joints = c.size(), size = joints + 1;
  struct Posture {
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, Eigen::Dynamic, kMostUnknowns> rows;
    Eigen::VectorXd right;
  };
  std::map<int, std::vector<Posture>> postures;
  Normal normal = Normal::Zero(size, size);
  Unknowns sum = Unknowns::Zero(size);
  for (const identification::CaseEquations& one : method.target_rows) {
    const auto place = places.find(one.posture);
    if (place == places.end()) return std::nullopt;
    Posture own{{one.right.size(), size}, one.right};
    for (Eigen::Index j = 0; j < joints; ++j) {
      const bool known = method.estimate.identifiable[static_cast<std::size_t>(j)];
      own.rows.col(j) = known ? Eigen::VectorXd(one.matrix.col(j) * c[j]) : Eigen::VectorXd::Zero(one.right.size());
    }
    own.rows.col(joints) = place->second * (one.matrix * c);
    normal += own.rows.transpose() * own.rows;
    sum += own.rows.transpose() * own.right;
    postures[one.posture].push_back(std::move(own));
  }
  for (Eigen::Index j = 0; j < joints; ++j)
    if (normal(j, j) == 0.0) normal(j, j) = 1.0;
  const double unknowns = 1.0 + static_cast<double>(std::count(method.estimate.identifiable.begin(),
                                                               method.estimate.identifiable.end(), true));
  const double n = static_cast<double>(postures.size());
  constexpr double kFewest = 6.0;
  if (n < unknowns + kFewest) return std::nullopt;
  const Eigen::MatrixXd inverse = solveSymmetric(normal, Normal::Identity(size, size));
  const Unknowns found = inverse * sum;
  double variance = 0.0;
  for (const auto& [pose, parts] : postures) {
    Unknowns score = Unknowns::Zero(size);
    for (const Posture& one : parts) score += one.rows.transpose() * (one.right - one.rows * found);
    const double influence = inverse.row(joints).dot(score);
    variance += influence * influence;
  }
  variance *= n / (n - unknowns);
  if (!(variance > 0.0)) return std::nullopt;
  return Trend{found[joints], found[joints] / std::sqrt(variance), n - unknowns};
}

}  // namespace

CourseOfDay courseOfDay(const campaign::Campaign& campaign, const identification::Identification& at) {
  CourseOfDay course;
  if (const preparation::StandingMotion motion = preparation::standingMotion(campaign); motion.significant())
    course.standing = motion.share;
  const std::map<int, double> places = placesInDay(campaign);
  if (places.empty()) return course;
  const identification::Method which = identification::bestMethod(at);
  if (!at.of(which).available) return course;
  const std::optional<Trend> trend = trendOf(at.of(which), places);
  if (!trend || std::abs(trend->t) <= numerics::studentLimit(preparation::kLevel, trend->dof)) return course;
  course.over_day = trend->share;
  course.over_day_t = trend->t;
  return course;
}

void addCourse(const CourseOfDay& course, const identification::Identification& at, Declared& declared) {
  const auto add = [&](BudgetSource source, double share) {
    if (share == 0.0) return;
    Declared::Column column{source, {}};
    for (const identification::Method which : identification::kMethods) {
      JointVector& change = column.compliance[static_cast<std::size_t>(which)];
      change.setZero(at.of(which).estimate.joints());
      if (at.of(which).available) change = share * at.of(which).estimate.compliance;
    }
    declared.columns.push_back(column);
  };
  constexpr double kUnseen = 2.0;
  add(BudgetSource::standing_load, kUnseen * course.standing);
  add(BudgetSource::over_day, kUnseen * course.over_day);
}

}  // namespace stiffscope::extended_model
