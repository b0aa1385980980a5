#include "core/preparation/drift_nests.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "core/frames/position_equations.h"
#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"
#include "core/preparation/remarks.h"
#include "metrology/linear_algebra.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::preparation {

namespace {

using Repeats = std::vector<const campaign::LoadingReading*>;

/// Repeats of one state within an interval of time, states of one reading left out.
std::vector<Repeats> repeatsWithin(const campaign::Loading& loading, double from_s, double to_s) {
  std::map<std::tuple<int, int, int>, Repeats> states;
  for (const campaign::LoadingReading& row : loading.rows) {
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
double scatterOf(const std::vector<Repeats>& states, const metrology::TrackerNoise& noise, const Place& place) {
  double chi2 = 0.0;
  for (const Repeats& repeats : states) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const campaign::LoadingReading* row : repeats) mean += place(*row) / static_cast<double>(repeats.size());
    const Eigen::Matrix3d weight = noise.covarianceAt(mean, repeats.front()->from).inverse();
    for (const campaign::LoadingReading* row : repeats) chi2 += (place(*row) - mean).dot(weight * (place(*row) - mean));
  }
  return chi2;
}

/// Times between postures within an interval, its start and its end.
std::vector<double> pauses(const campaign::Loading& loading, double from_s, double to_s) {
  std::map<int, std::pair<double, double>> spans;  // first and last reading of each posture
  for (const campaign::LoadingReading& row : loading.rows) {
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
double misfitOf(const campaign::Campaign& campaign, const metrology::TrackerNoise& noise,
                const StationMotion& station) {
  campaign::Campaign corrected = campaign;
  applyDriftCorrection(station, corrected);
  const frames::Frames frames = frames::measureFrames(corrected);
  constexpr double kAnyCompliance = 1e-6;  // rad/Nm; what it really is, is fitted
  const frames::LoadingGeometry geometry =
      frames::sweptGeometry(corrected, frames, JointVector::Constant(campaign.robot.joints(), kAnyCompliance));
  const frames::AbsoluteRows rows =
      frames::absoluteRows(corrected, frames, geometry, campaign::statePoints(corrected), noise);
  if (!rows.reason.empty()) return INFINITY;
  Eigen::MatrixXd columns(3 * static_cast<Eigen::Index>(rows.rows.size()), rows.parameters);
  Eigen::VectorXd left(columns.rows());
  Eigen::Index at = 0;
  for (const frames::AbsoluteRow& row : rows.rows) {
    const Eigen::Matrix3d root = row.weight.llt().matrixU();
    columns.middleRows<3>(at) = root * row.jacobian;
    left.segment<3>(at) = root * row.residual;
    at += 3;
  }
  const Eigen::VectorXd scale = columns.colwise().norm().cwiseMax(1e-300);
  columns = columns * scale.cwiseInverse().asDiagonal();
  return (left - columns * leastSquaresSolution(columns, left)).squaredNorm();
}

}  // namespace

double jumpTime(const campaign::Campaign& campaign, const metrology::TrackerNoise& noise, StationMotion station,
                std::size_t round) {
  const double from = station.epochs[round - 1].time_s, to = station.epochs[round].time_s;
  if (!campaign.loading || campaign.loading->frame != campaign::PointFrame::tracker) return 0.5 * (from + to);
  double best = INFINITY, best_time = 0.5 * (from + to);
  for (const double time : pauses(*campaign.loading, from, to)) {
    station.epochs[round].jumped_at = time;
    const double misfit = misfitOf(campaign, noise, station);
    if (misfit < best) best = misfit, best_time = time;
  }
  return best_time;
}

void findJumps(const campaign::Campaign& campaign, const metrology::TrackerNoise& noise, StationMotion& station) {
  if (!campaign.loading || campaign.loading->frame != campaign::PointFrame::tracker) return;
  constexpr double kDecisive = 10.0;  // log-likelihood ratio of 5: odds of 150 to one
  for (std::size_t e = 1; e < station.epochs.size(); ++e) {
    const double from = station.epochs[e - 1].time_s, to = station.epochs[e].time_s;
    const std::vector<Repeats> repeats = repeatsWithin(*campaign.loading, from, to);
    const double as_read = scatterOf(repeats, noise, [](const campaign::LoadingReading& row) { return row.point; });
    const double if_steady = scatterOf(repeats, noise, [&](const campaign::LoadingReading& row) {
      return Eigen::Vector3d(station.firstFrom(row.time_s) * row.point);
    });
    if (if_steady - as_read < kDecisive) continue;
    station.epochs[e].jumped_at = jumpTime(campaign, noise, station, e);
  }
}

namespace {

/// How far a nest went against the others, and its first reading that noise does not explain.
void describeMovedNest(const std::vector<NestRound>& rounds, const NestNetwork& others,
                       const metrology::TrackerNoise& noise, int nest, StationMotion& result) {
  StationMotion course;
  course.centre = result.centre;
  course.epochs = others.epochs;
  std::optional<Eigen::Vector3d> first;
  const double limit = numerics::chiSquareLimit(kLevel / static_cast<double>(rounds.size()), 3.0);
  for (const NestRound& round : rounds) {
    const auto found = round.readings.find(nest);
    if (found == round.readings.end()) continue;
    const Eigen::Vector3d place = course.firstFrom(round.time_s) * found->second->point;
    if (!first) first = place;
    const Eigen::Vector3d off = place - *first;
    result.moved_nest_by = std::max(result.moved_nest_by, off.norm());
    const double significance =
        mahalanobisSquared(off, 2.0 * noise.covarianceAt(found->second->point, found->second->from));
    if (significance > limit && result.moved_nest_line == 0) result.moved_nest_line = found->second->line;
  }
}

/// The nest without which the others are rigid, if there is one; needs three others.
void findMovedNest(const std::vector<NestRound>& rounds, const metrology::TrackerNoise& noise, std::size_t nests,
                   NestNetwork& network, StationMotion& result) {
  NestNetwork best = network;
  for (std::size_t nest = 0; nest < nests; ++nest) {
    const NestNetwork others = fitNestNetwork(rounds, noise, result.centre, static_cast<int>(nest));
    if (!others.determined || others.chi2 >= best.chi2) continue;
    best = others;
    result.moved_nest = static_cast<int>(nest);
  }
  if (!result.moved_nest) return;
  if (best.chi2 > numerics::chiSquareLimit(kLevel, best.dof)) {
    result.moved_nest.reset();  // more than one moved: none can be told apart
    return;
  }
  network = best;
  describeMovedNest(rounds, network, noise, *result.moved_nest, result);
}

}  // namespace

double StationMotion::significance(const StationEpoch& epoch) const {
  const Eigen::Vector3d displacement = epoch.motion.tail<3>();
  const Eigen::Matrix3d covariance = epoch.covariance.bottomRightCorner<3, 3>();
  if (covariance.isZero(0.0)) return 0.0;
  return mahalanobisSquared(displacement, covariance);
}

Eigen::Isometry3d StationMotion::firstFrom(double time_s) const {
  if (epochs.empty() || time_s <= epochs.front().time_s) return Eigen::Isometry3d::Identity();
  if (time_s >= epochs.back().time_s) return metrology::motionAbout(centre, epochs.back().motion);
  const auto after = std::upper_bound(epochs.begin(), epochs.end(), time_s,
                                      [](double time, const StationEpoch& epoch) { return time < epoch.time_s; });
  const auto before = std::prev(after);
  if (after->jumped_at)
    return metrology::motionAbout(centre, time_s < *after->jumped_at ? before->motion : after->motion);
  const double share = (time_s - before->time_s) / (after->time_s - before->time_s);
  return metrology::motionAbout(centre, (1.0 - share) * before->motion + share * after->motion);
}

StationMotion stationMotion(const campaign::Campaign& campaign, const std::optional<metrology::TrackerNoise>& noise) {
  StationMotion result;
  if (!campaign.nests) {
    result.reason = Remark(RemarkId::no_floor_nests);
    return result;
  }
  if (!noise) {
    result.reason = Remark(RemarkId::tracker_noise_not_declared);
    return result;
  }
  result.centre = whereTheArmWasRead(campaign);
  const std::vector<NestRound> rounds = nestRounds(*campaign.nests);
  constexpr int kNone = -1;
  NestNetwork network = fitNestNetwork(rounds, *noise, result.centre, kNone);
  if (!network.determined) {
    result.reason = Remark(RemarkId::too_few_nests);
    return result;
  }
  result.tested = true;
  result.deformation_chi2 = network.chi2;
  result.deformation_dof = network.dof;
  result.deformation_limit = network.dof > 0 ? numerics::chiSquareLimit(kLevel, network.dof) : 0.0;
  if (network.dof > 0 && network.chi2 > result.deformation_limit) {
    findMovedNest(rounds, *noise, campaign.nest_ids.size(), network, result);
  }
  result.epochs = network.epochs;
  result.rigid_chi2 = network.chi2;
  result.rigid_dof = network.dof;
  result.moved_limit = numerics::chiSquareLimit(kLevel / static_cast<double>(result.epochs.size()), 3.0);
  for (const StationEpoch& epoch : result.epochs) result.moved |= result.significance(epoch) > result.moved_limit;
  return result;
}

StationMotion inFrame(StationMotion station, const Eigen::Isometry3d& other_from_own) {
  const Eigen::Matrix3d turn = other_from_own.linear();
  Matrix6d both = Matrix6d::Zero();
  both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = turn;
  station.centre = other_from_own * station.centre;
  for (StationEpoch& epoch : station.epochs) {
    epoch.motion = both * epoch.motion;
    epoch.covariance = both * epoch.covariance * both.transpose();
  }
  return station;
}

namespace {

/// `motionOf(row)` of every reading that states a time, in the tracker's frame.
template <class Motion>
void moveReadings(campaign::Campaign& campaign, const Motion& motionOf) {
  forEachDriftingTable(campaign, [&](auto& table) {
    for (auto& row : table.rows) {
      if (std::isfinite(row.time_s)) row.point = motionOf(row) * row.point;
    }
  });
}

}  // namespace

void applyDriftCorrection(const StationMotion& station, campaign::Campaign& campaign) {
  moveReadings(campaign, [&](const auto& row) { return station.firstFrom(row.time_s); });
}

void putBackDrift(const StationMotion& station, campaign::Campaign& campaign) {
  moveReadings(campaign, [&](const auto& row) { return station.firstFrom(row.time_s).inverse(); });
}

void applyDriftCorrection(const std::vector<StationMotion>& stations, campaign::Campaign& campaign) {
  moveReadings(campaign,
               [&](const auto& row) { return stations[static_cast<std::size_t>(row.station)].firstFrom(row.time_s); });
}

void putBackDrift(const std::vector<StationMotion>& stations, campaign::Campaign& campaign) {
  moveReadings(campaign, [&](const auto& row) {
    return stations[static_cast<std::size_t>(row.station)].firstFrom(row.time_s).inverse();
  });
}

}  // namespace stiffscope::preparation
