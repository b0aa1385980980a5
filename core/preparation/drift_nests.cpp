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
#include "metrology/registration.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::preparation {

/// One round of nest readings.
struct NestRound {
  double time_s = 0.0;  ///< mean of its readings
  std::map<int, const campaign::NestReading*> readings;
};

/// Rounds in the order of time; a nest that comes again starts the next one.
std::vector<NestRound> nestRounds(const campaign::Nests& nests);

/// Places of the nests and motions of the station that fit the rounds best.
struct NestNetwork {
  bool determined = false;
  double chi2 = 0.0;
  int dof = 0;
  std::vector<StationEpoch> epochs;       ///< one a round
  std::map<int, Eigen::Vector3d> places;  ///< of the nests in the first round's frame
};

/// Gauss-Newton on whitened residuals T_e p - X_n; rounds of fewer than three nests (`left_out` not counted)
/// are skipped. Undetermined: fewer than two such rounds, or nests on one line.
NestNetwork fitNestNetwork(const std::vector<NestRound>& rounds, const metrology::TrackerNoise& noise,
                           const Eigen::Vector3d& centre, int left_out);

namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

std::vector<NestRound> usable(const std::vector<NestRound>& rounds, int left_out) {
  std::vector<NestRound> result = rounds;
  for (NestRound& round : result) round.readings.erase(left_out);
  std::erase_if(result, [](const NestRound& round) { return round.readings.size() < 3; });
  return result;
}

/// Starts at the rigid registration of each round onto the first.
bool start(const std::vector<NestRound>& rounds, const Eigen::Vector3d& centre, NestNetwork& network) {
  for (const auto& [nest, reading] : rounds.front().readings) network.places[nest] = reading->point;
  for (const NestRound& round : rounds) {
    std::vector<Eigen::Vector3d> now, first;
    for (const auto& [nest, reading] : round.readings) {
      const auto known = network.places.find(nest);
      if (known == network.places.end()) continue;
      now.push_back(reading->point);
      first.push_back(known->second);
    }
    const metrology::RigidRegistration fit = metrology::registerRigid(now, first);
    if (!fit.determined) return false;
    StationEpoch epoch;
    epoch.time_s = round.time_s;
    const Eigen::AngleAxisd turn(fit.to_from_source.linear());
    epoch.motion << turn.angle() * turn.axis(), fit.to_from_source * centre - centre;
    network.epochs.push_back(epoch);
    for (const auto& [nest, reading] : round.readings) {
      network.places.try_emplace(nest, fit.to_from_source * reading->point);
    }
  }
  network.epochs.front().motion.setZero();
  return true;
}

/// The normal equations of one Gauss-Newton step. A motion meets only its own round's places, so the motions go first,
/// each by itself, and the few places are what is left to solve together (Schur's complement): linear in the rounds.
struct RoundEquations {
  Matrix6d normal = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_places;
};

class NetworkStep {
 public:
  NetworkStep(std::size_t rounds, std::size_t places)
      : size_(3 * static_cast<Eigen::Index>(places)),
        rounds_(rounds),
        normal_(Eigen::MatrixXd::Zero(size_, size_)),
        right_(Eigen::VectorXd::Zero(size_)) {
    for (RoundEquations& round : rounds_) round.by_places.setZero(6, size_);
  }

  /// One reading: residual = moved - place. The first round does not move.
  void add(std::size_t round, Eigen::Index place, const Eigen::Matrix<double, 3, 6>& by_motion,
           const Eigen::Matrix3d& weight, const Eigen::Vector3d& residual) {
    normal_.block<3, 3>(3 * place, 3 * place) += weight;
    right_.segment<3>(3 * place) += weight * residual;
    if (round == 0) return;
    RoundEquations& own = rounds_[round];
    own.normal += by_motion.transpose() * weight * by_motion;
    own.right -= by_motion.transpose() * weight * residual;
    own.by_places.middleCols<3>(3 * place) -= by_motion.transpose() * weight;
  }

  /// Moves the network; the covariance of a motion is N_e^-1 + B S^-1 B^T, B = N_e^-1 N_ep.
  void apply(NestNetwork& network) const {
    Eigen::MatrixXd left = normal_;
    Eigen::VectorXd right = right_;
    // Of each round N_e^-1 of [N_ep, right, I].
    std::vector<Eigen::MatrixXd> own(rounds_.size());
    for (std::size_t e = 1; e < rounds_.size(); ++e) {
      Eigen::MatrixXd columns(6, size_ + 7);
      columns << rounds_[e].by_places, rounds_[e].right, Matrix6d::Identity();
      own[e] = solveSymmetric(rounds_[e].normal, columns);
      left -= rounds_[e].by_places.transpose() * own[e].leftCols(size_);
      right -= rounds_[e].by_places.transpose() * own[e].col(size_);
    }
    const Eigen::MatrixXd covariance = solveSymmetric(left, Eigen::MatrixXd::Identity(size_, size_));
    const Eigen::VectorXd moved = covariance * right;
    for (std::size_t e = 1; e < rounds_.size(); ++e) {
      const Eigen::MatrixXd carried = own[e].leftCols(size_);
      network.epochs[e].motion += own[e].col(size_) - carried * moved;
      network.epochs[e].covariance = own[e].rightCols(6) + carried * covariance * carried.transpose();
    }
    Eigen::Index at = 0;
    for (auto& [nest, place] : network.places) place += moved.segment<3>(at), at += 3;
  }

 private:
  Eigen::Index size_;
  std::vector<RoundEquations> rounds_;
  Eigen::MatrixXd normal_;  ///< of the places
  Eigen::VectorXd right_;
};

/// One step of Gauss-Newton; the covariance of the motions is that of the last.
void improve(const std::vector<NestRound>& rounds, const metrology::TrackerNoise& noise, const Eigen::Vector3d& centre,
             NestNetwork& network) {
  NetworkStep equations(rounds.size(), network.places.size());
  network.chi2 = 0.0;
  int coordinates = 0;
  for (std::size_t e = 0; e < rounds.size(); ++e) {
    const Eigen::Isometry3d first_from_now = metrology::motionAbout(centre, network.epochs[e].motion);
    const Eigen::Matrix3d turn = first_from_now.linear();
    for (const auto& [nest, reading] : rounds[e].readings) {
      const auto place = network.places.find(nest);
      const Eigen::Vector3d moved = first_from_now * reading->point;
      const Eigen::Vector3d residual = moved - place->second;
      const Eigen::Matrix3d weight = (turn * noise.covarianceAt(reading->point) * turn.transpose()).inverse();
      network.chi2 += residual.dot(weight * residual);
      coordinates += 3;
      Eigen::Matrix<double, 3, 6> by_motion;
      by_motion << -metrology::crossMatrix(moved - centre), Eigen::Matrix3d::Identity();
      equations.add(e, std::distance(network.places.begin(), place), by_motion, weight, residual);
    }
  }
  network.dof = coordinates - static_cast<int>(6 * (rounds.size() - 1) + 3 * network.places.size());
  equations.apply(network);
}

}  // namespace

std::vector<NestRound> nestRounds(const campaign::Nests& nests) {
  std::vector<const campaign::NestReading*> rows;
  for (const campaign::NestReading& row : nests.rows) rows.push_back(&row);
  std::stable_sort(rows.begin(), rows.end(), [](const campaign::NestReading* a, const campaign::NestReading* b) {
    return a->time_s < b->time_s;
  });
  std::vector<NestRound> rounds;
  for (const campaign::NestReading* row : rows) {
    if (rounds.empty() || rounds.back().readings.contains(row->nest)) rounds.emplace_back();
    rounds.back().readings[row->nest] = row;
  }
  for (NestRound& round : rounds) {
    for (const auto& [nest, row] : round.readings) {
      round.time_s += row->time_s / static_cast<double>(round.readings.size());
    }
  }
  return rounds;
}

NestNetwork fitNestNetwork(const std::vector<NestRound>& rounds, const metrology::TrackerNoise& noise,
                           const Eigen::Vector3d& centre, int left_out) {
  NestNetwork network;
  const std::vector<NestRound> used = usable(rounds, left_out);
  if (used.size() < 2 || !start(used, centre, network)) return network;
  constexpr int kSteps = 4;  // from a registration that is near the optimum already; the last gives chi2 there
  for (int step = 0; step < kSteps; ++step) improve(used, noise, centre, network);
  network.determined = true;
  return network;
}

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
    const Eigen::Matrix3d weight = noise.covarianceAt(mean).inverse();
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
  const frames::LoadingGeometry geometry = frames::sweptGeometry(corrected, frames, Vector6d::Constant(kAnyCompliance));
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

Eigen::Vector3d whereTheArmWasRead(const campaign::Campaign& campaign) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  const auto add = [&](const auto& table) {
    for (const auto& row : table.rows) sum += row.point, count += 1.0;
  };
  if (campaign.loading) {
    add(*campaign.loading);
  } else if (campaign.circle_sweeps) {
    add(*campaign.circle_sweeps);
  } else {
    add(*campaign.nests);
  }
  return count > 0.0 ? Eigen::Vector3d(sum / count) : sum;
}

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
    const double significance = mahalanobisSquared(off, 2.0 * noise.covarianceAt(found->second->point));
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
  result.moved_limit = numerics::chiSquareLimit(kLevel / static_cast<double>(result.epochs.size()), 3.0);
  for (const StationEpoch& epoch : result.epochs) result.moved |= result.significance(epoch) > result.moved_limit;
  return result;
}

namespace {

template <class Move>
void moveReadings(campaign::Campaign& campaign, const Move& motionAt) {
  forEachDriftingTable(campaign, [&](auto& table) {
    for (auto& row : table.rows) {
      if (std::isfinite(row.time_s)) row.point = motionAt(row.time_s) * row.point;
    }
  });
}

}  // namespace

void applyDriftCorrection(const StationMotion& station, campaign::Campaign& campaign) {
  moveReadings(campaign, [&](double time_s) { return station.firstFrom(time_s); });
}

void putBackDrift(const StationMotion& station, campaign::Campaign& campaign) {
  moveReadings(campaign, [&](double time_s) { return station.firstFrom(time_s).inverse(); });
}

}  // namespace stiffscope::preparation
