#include "core/audit/station_jumps.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "core/audit/absolute_rows.h"

namespace stiffscope {

namespace {

using Repeats = std::vector<const LoadingReading*>;

/// Repeats of one state within an interval of time, states of one reading left out.
std::vector<Repeats> repeatsWithin(const Loading& loading, double from_s, double to_s) {
  std::map<std::tuple<int, int, int>, Repeats> states;
  for (const LoadingReading& row : loading.rows) {
    if (row.time_s > from_s && row.time_s < to_s) states[{row.pose, row.step, row.target}].push_back(&row);
  }
  std::vector<Repeats> found;
  for (auto& [key, rows] : states) {
    if (rows.size() >= 2) found.push_back(std::move(rows));
  }
  return found;
}

/// Scatter of repeats in parts of the noise, as `place` puts the readings.
template <class Place>
double scatterOf(const std::vector<Repeats>& states, const TrackerNoise& noise, const Place& place) {
  double chi2 = 0.0;
  for (const Repeats& repeats : states) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const LoadingReading* row : repeats) mean += place(*row) / static_cast<double>(repeats.size());
    const Eigen::Matrix3d weight = noise.covarianceAt(mean).inverse();
    for (const LoadingReading* row : repeats) chi2 += (place(*row) - mean).dot(weight * (place(*row) - mean));
  }
  return chi2;
}

/// Times between postures within an interval, its start and its end.
std::vector<double> pauses(const Loading& loading, double from_s, double to_s) {
  std::map<int, std::pair<double, double>> spans;  // first and last reading of each posture
  for (const LoadingReading& row : loading.rows) {
    if (!std::isfinite(row.time_s)) continue;
    const auto [place, added] = spans.try_emplace(row.pose, row.time_s, row.time_s);
    place->second.first = std::min(place->second.first, row.time_s);
    place->second.second = std::max(place->second.second, row.time_s);
  }
  std::set<double> times{from_s, to_s};
  for (const auto& [pose, span] : spans) {
    if (span.first > from_s && span.first < to_s) times.insert(span.first - 1e-3);  // just before it
  }
  return {times.begin(), times.end()};
}

/// Whitened squared misfit of the unloaded positions with the station's motion taken off; places, axes and the
/// sag of each joint are free, because they are larger than a jump may be.
double misfitOf(const Campaign& campaign, const TrackerNoise& noise, const StationMotion& station) {
  Campaign corrected = campaign;
  takeOffDrift(station, corrected);
  const Frames frames = measureFrames(corrected);
  constexpr double kAnyCompliance = 1e-6;  // rad/Nm; what it really is, is fitted
  const LoadingGeometry geometry = sweptGeometry(corrected, frames, Vector6d::Constant(kAnyCompliance));
  const AbsoluteRows rows = absoluteRows(corrected, frames, geometry, statePoints(corrected), noise);
  if (!rows.reason.empty()) return INFINITY;
  Eigen::MatrixXd columns(3 * static_cast<Eigen::Index>(rows.rows.size()), rows.parameters);
  Eigen::VectorXd left(columns.rows());
  Eigen::Index at = 0;
  for (const AbsoluteRow& row : rows.rows) {
    const Eigen::Matrix3d root = row.weight.llt().matrixU();
    columns.middleRows<3>(at) = root * row.jacobian;
    left.segment<3>(at) = root * row.residual;
    at += 3;
  }
  const Eigen::VectorXd scale = columns.colwise().norm().cwiseMax(1e-300);
  columns = columns * scale.cwiseInverse().asDiagonal();
  return (left - columns * columns.completeOrthogonalDecomposition().solve(left)).squaredNorm();
}

}  // namespace

double jumpTime(const Campaign& campaign, const TrackerNoise& noise, StationMotion station, std::size_t round) {
  const double from = station.epochs[round - 1].time_s, to = station.epochs[round].time_s;
  if (!campaign.loading || campaign.loading->frame != PointFrame::tracker) return 0.5 * (from + to);
  double best = INFINITY, best_time = 0.5 * (from + to);
  for (const double time : pauses(*campaign.loading, from, to)) {
    station.epochs[round].jumped_at = time;
    const double misfit = misfitOf(campaign, noise, station);
    if (misfit < best) best = misfit, best_time = time;
  }
  return best_time;
}

void findJumps(const Campaign& campaign, const TrackerNoise& noise, StationMotion& station) {
  if (!campaign.loading || campaign.loading->frame != PointFrame::tracker) return;
  constexpr double kDecisive = 10.0;  // log-likelihood ratio of 5: odds of 150 to one
  for (std::size_t e = 1; e < station.epochs.size(); ++e) {
    const double from = station.epochs[e - 1].time_s, to = station.epochs[e].time_s;
    const std::vector<Repeats> repeats = repeatsWithin(*campaign.loading, from, to);
    const double as_read = scatterOf(repeats, noise, [](const LoadingReading& row) { return row.point; });
    const double if_steady = scatterOf(repeats, noise, [&](const LoadingReading& row) {
      return Eigen::Vector3d(station.firstFrom(row.time_s) * row.point);
    });
    if (if_steady - as_read < kDecisive) continue;
    station.epochs[e].jumped_at = jumpTime(campaign, noise, station, e);
  }
}

}  // namespace stiffscope
