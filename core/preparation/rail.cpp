#include "core/preparation/rail.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace stiffscope::preparation {

double RailCourse::scaleSd() const {
  const Eigen::Vector3d along = per_metre.normalized();
  return std::sqrt(along.dot(covariance * along));
}

std::optional<RailCourse> fitRailCourse(const campaign::Campaign& campaign,
                                        const std::optional<metrology::TrackerNoise>& noise) {
  if (!campaign.rail_sweep || campaign.rail_sweep->rows.empty()) return std::nullopt;
  const std::vector<campaign::RailReading>& rows = campaign.rail_sweep->rows;
  RailCourse course;
  course.lowest = std::numeric_limits<double>::infinity();
  course.highest = -course.lowest;
  std::map<int, Eigen::Index> place;  // of each reflector's a_t among the unknowns
  for (const campaign::RailReading& row : rows) {
    course.lowest = std::min(course.lowest, row.rail);
    course.highest = std::max(course.highest, row.rail);
    place.emplace(row.target, 0);
  }
  if (!(course.highest > course.lowest)) return std::nullopt;
  Eigen::Index unknowns = 3;
  for (auto& [target, at] : place) at = std::exchange(unknowns, unknowns + 3);

  // About the middle of the travel, so that places and direction are told apart well.
  const double middle = 0.5 * (course.lowest + course.highest);
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
  for (const campaign::RailReading& row : rows) {
    const Eigen::Matrix3d weight = noise ? Eigen::Matrix3d(noise->covarianceAt(row.point, row.from).inverse()) : one;
    const double r = row.rail - middle;
    const Eigen::Index at = place[row.target];
    normal.topLeftCorner<3, 3>() += r * r * weight;
    normal.block<3, 3>(0, at) += r * weight;
    normal.block<3, 3>(at, 0) += r * weight;
    normal.block<3, 3>(at, at) += weight;
    right.head<3>() += r * weight * row.point;
    right.segment<3>(at) += weight * row.point;
  }
  const Eigen::LDLT<Eigen::MatrixXd> factors(normal);
  const Eigen::VectorXd solution = factors.solve(right);
  course.per_metre = solution.head<3>();
  course.covariance = factors.solve(Eigen::MatrixXd::Identity(unknowns, unknowns)).topLeftCorner<3, 3>();
  course.readings = static_cast<int>(rows.size());

  /// What is left at one position of the carriage, over its reflectors.
  struct Stop {
    Eigen::Vector3d left = Eigen::Vector3d::Zero();
    Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
    double readings = 0.0;
  };
  std::map<std::string, Stop> stops;
  const Eigen::Vector3d along = course.per_metre.normalized();
  double chi2 = 0.0, along_sum = 0.0, across_sum = 0.0;
  for (const campaign::RailReading& row : rows) {
    const Eigen::Vector3d left =
        row.point - solution.segment<3>(place[row.target]) - (row.rail - middle) * course.per_metre;
    chi2 += noise ? left.dot(noise->covarianceAt(row.point, row.from).inverse() * left) : left.squaredNorm();
    Stop& stop = stops[row.index];
    stop.left += left;
    if (noise) stop.noise += noise->covarianceAt(row.point, row.from);
    stop.readings += 1.0;
    const double by_travel = along.dot(left);
    along_sum += by_travel * by_travel;
    across_sum += left.squaredNorm() - by_travel * by_travel;
    if (left.norm() < course.farthest) continue;
    course.farthest = left.norm();
    course.farthest_file = campaign.rail_sweep->file;
    course.farthest_line = row.line;
  }
  course.along_rms = std::sqrt(along_sum / static_cast<double>(rows.size()));
  course.across_rms = std::sqrt(across_sum / static_cast<double>(rows.size()));
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& [index, stop] : stops)
    scatter += (stop.left * stop.left.transpose() - stop.noise) / (stop.readings * stop.readings);
  scatter /= std::max(1.0, static_cast<double>(stops.size()) - 2.0);  // a line takes two numbers a coordinate
  const double by_stop = std::max(0.0, along.dot(scatter * along));
  const double aside = std::max(0.0, 0.5 * (scatter.trace() - along.dot(scatter * along)));
  course.of_stop = by_stop * along * along.transpose() + aside * (one - along * along.transpose());
  const double dof = 3.0 * static_cast<double>(rows.size()) - static_cast<double>(unknowns);
  const double variance = dof > 0.0 ? chi2 / dof : 0.0;
  course.covariance *= noise ? std::max(1.0, variance) : variance;
  return course;
}

namespace {

/// Calls `carry(row, by)` with each reading of the arm and how far from its zero the carriage stood, by the rows'
/// `rail` and in the frame of the reading's table, m.
template <class Carry>
void forEachCarried(const std::optional<RailCourse>& course, campaign::Campaign& campaign, const Carry& carry) {
  const auto perMetre = [&](campaign::PointFrame frame) -> Eigen::Vector3d {
    if (frame == campaign::PointFrame::base_link) return campaign.robot.rail->direction_in_base;
    return course ? course->per_metre : Eigen::Vector3d(Eigen::Vector3d::Zero());
  };
  const auto ofSweep = [&](auto& table) {
    if (!table) return;
    const Eigen::Vector3d d = perMetre(table->frame);
    for (auto& row : table->rows) carry(row, row.rail * d);
  };
  ofSweep(campaign.circle_sweeps);
  ofSweep(campaign.wrist_sweep);
  if (!campaign.states || !campaign.loading) return;
  std::map<std::pair<int, int>, double> at;
  for (const campaign::State& row : campaign.states->rows) at.emplace(std::pair(row.pose, row.step), row.rail);
  const Eigen::Vector3d d = perMetre(campaign.loading->frame);
  for (campaign::LoadingReading& row : campaign.loading->rows) {
    const auto position = at.find({row.pose, row.step});
    if (position != at.end()) carry(row, Eigen::Vector3d(position->second * d));
  }
}

/// All rows that say where the carriage stood.
template <class Visit>
void forEachPlaced(campaign::Campaign& campaign, const Visit& visit) {
  const auto each = [&](auto& table) {
    if (!table) return;
    for (auto& row : table->rows) visit(row);
  };
  each(campaign.circle_sweeps);
  each(campaign.wrist_sweep);
  each(campaign.states);
}

}  // namespace

void referToCarriageAtZero(const std::optional<RailCourse>& course, campaign::Campaign& campaign) {
  if (!campaign.robot.rail) return;
  const Eigen::Vector3d station =
      campaign.tracker ? campaign.tracker->station : Eigen::Vector3d(Eigen::Vector3d::Zero());
  // The instrument stays where it was: seen from the carriage it stands as much further back.
  forEachCarried(course, campaign, [&](auto& row, const Eigen::Vector3d& by) {
    row.point -= by;
    row.from = (row.from.allFinite() ? row.from : station) - by;
  });
  bool moves = false;
  if (campaign.states) {
    const double first = campaign.states->rows.empty() ? 0.0 : campaign.states->rows.front().rail;
    for (const campaign::State& row : campaign.states->rows) moves |= row.rail < first || row.rail > first;
    // Whether a controller counts the carriage into the poses that it states is not known.
    for (campaign::State& row : campaign.states->rows) {
      if (moves && row.hasExtras()) row.extras().tool_pose = {};
    }
  }
  forEachPlaced(campaign, [](auto& row) {
    if (std::isnan(row.carriage)) row.carriage = row.rail;  // else it has been referred before
    row.rail = 0.0;
  });
}

void referToWhereItStood(const std::optional<RailCourse>& course, campaign::Campaign& campaign) {
  if (!campaign.robot.rail) return;
  forEachPlaced(campaign, [](auto& row) {
    if (!std::isnan(row.carriage)) row.rail = std::exchange(row.carriage, campaign::kNotGiven);
  });
  forEachCarried(course, campaign, [](auto& row, const Eigen::Vector3d& by) {
    row.point += by;
    row.from += by;
  });
}

}  // namespace stiffscope::preparation
