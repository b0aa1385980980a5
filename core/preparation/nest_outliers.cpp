
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/frames/joint_axes.h"
#include "core/numerics/distributions.h"
#include "core/numerics/resampling.h"
#include "core/preparation/drift_nests.h"
#include "core/preparation/join_stations.h"
#include "core/preparation/nest_network.h"
#include "core/preparation/remarks.h"
#include "core/preparation/repeatability.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::preparation {

namespace {

using Readings = std::set<const campaign::NestReading*>;

/// Distances between the nests of each round, less their medians over the rounds.
class NestDistances {
 public:
  struct Change {
    double by = 0.0;  ///< m
    double sd = 0.0;  ///< m, of the change
  };

  NestDistances(const std::vector<NestRound>& rounds, const metrology::TrackerNoise& noise) : changes_(rounds.size()) {
    std::map<Pair, std::vector<double>> lengths;
    for (std::size_t e = 0; e < rounds.size(); ++e) {
      for (const auto& [a, first] : rounds[e].readings) {
        for (const auto& [b, second] : rounds[e].readings) {
          if (a >= b) continue;
          const Eigen::Vector3d between = second->point - first->point;
          const Eigen::Vector3d along = between.normalized();
          const Eigen::Matrix3d covariance =
              noise.covarianceAt(first->point, first->from) + noise.covarianceAt(second->point, second->from);
          // The median is of few readings: as uncertain as one of them at most.
          changes_[e][{a, b}] = {between.norm(), std::sqrt(2.0 * along.dot(covariance * along))};
          lengths[{a, b}].push_back(between.norm());
        }
      }
    }
    constexpr std::size_t kMajority = 3;  // of two lengths nobody can tell which is wrong
    std::vector<double> squares;
    for (auto& round : changes_) {
      std::erase_if(round, [&](const auto& one) { return lengths[one.first].size() < kMajority; });
    }
    std::map<Pair, double> medians;
    for (const auto& [pair, all] : lengths) medians[pair] = numerics::upperMedian(all);
    for (auto& round : changes_) {
      for (auto& [pair, change] : round) {
        change.by -= medians[pair];
        squares.push_back(std::pow(change.by / change.sd, 2));
      }
    }
    if (squares.empty()) return;
    const double scale = std::max(1.0, numerics::upperMedian(squares) / numerics::chiSquareLimit(0.5, 1.0));
    limit_ = std::sqrt(scale) * numerics::normalLimit(kLevel / static_cast<double>(squares.size()));
  }

  /// Of nest `a` to nest `b` in a round; null where there is none to compare with.
  const Change* of(std::size_t round, int a, int b) const {
    const auto found = changes_[round].find(std::minmax(a, b));
    return found == changes_[round].end() ? nullptr : &found->second;
  }
  bool beyond(const Change& change) const { return std::abs(change.by) > limit_ * change.sd; }

  /// Whether a nest stands in two rounds at the same place among the others.
  bool alike(int nest, std::size_t one, std::size_t other) const {
    for (const auto& [pair, change] : changes_[one]) {
      if (pair.first != nest && pair.second != nest) continue;
      const auto found = changes_[other].find(pair);
      if (found == changes_[other].end()) continue;
      if (std::abs(change.by - found->second.by) > limit_ * std::hypot(change.sd, found->second.sd)) return false;
    }
    return true;
  }

 private:
  using Pair = std::pair<int, int>;
  std::vector<std::map<Pair, Change>> changes_;  ///< by round
  double limit_ = 0.0;                           ///< of |by| / sd
};

/// How many of a nest's distances to `others` in its round are wrong, and how many there are.
std::pair<int, int> wrongDistances(const NestDistances& distances, std::size_t round, int nest,
                                   const std::set<int>& others) {
  std::pair<int, int> counted{0, 0};
  for (const int other : others) {
    const NestDistances::Change* change = other == nest ? nullptr : distances.of(round, nest, other);
    if (change == nullptr) continue;
    counted.first += distances.beyond(*change);
    ++counted.second;
  }
  return counted;
}

/// Step 1: the readings against which most distances of their round speak.
Readings strayByDistance(const std::vector<NestRound>& rounds, const NestDistances& distances) {
  Readings stray;
  for (std::size_t e = 0; e < rounds.size(); ++e) {
    std::set<int> left;
    for (const auto& [nest, reading] : rounds[e].readings) left.insert(nest);
    for (;;) {
      int most = 1, worst = -1;
      for (const int nest : left) {
        const auto [wrong, of] = wrongDistances(distances, e, nest, left);
        if (wrong > most && 2 * wrong > of) most = wrong, worst = nest;
      }
      if (worst < 0) break;
      stray.insert(rounds[e].readings.at(worst));
      left.erase(worst);
    }
  }
  return stray;
}

std::vector<NestRound> without(const Readings& stray, const std::set<int>& nests, std::vector<NestRound> rounds) {
  for (NestRound& round : rounds) {
    std::erase_if(round.readings,
                  [&](const auto& one) { return nests.contains(one.first) || stray.contains(one.second); });
  }
  return rounds;
}

/// A reading's squared distance from where the others put it, in parts of its covariance, and in how many directions;
/// none where the motion takes up whatever it is off.
struct Apart {
  double chi2 = 0.0;
  int dof = 0;
};

Apart apart(const NestResidual& one, const metrology::TrackerNoise& noise) {
  // What the fit leaves of a reading's variance in a direction that the motion takes up is rounding, and curvature.
  constexpr double kShown = 1e-3;
  const double least = kShown * noise.covarianceAt(one.reading->point, one.reading->from).trace() / 3.0;
  const SymmetricEigen parts = symmetricEigen(one.covariance);
  Apart result;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (parts.values[k] < least) continue;
    const double off = parts.vectors.col(k).dot(one.off);
    result.chi2 += off * off / parts.values[k];
    ++result.dof;
  }
  return result;
}

/// How far a network's readings stand apart, and what chance allows.
struct ApartInNetwork {
  std::vector<Apart> of;  ///< by residual
  double scale = 1.0;     ///< of the nests' own scatter against the declared noise
  int judged = 0;         ///< residuals with a direction in which something shows

  double share(std::size_t i) const {
    if (of[i].dof == 0) return 0.0;
    return of[i].chi2 / (scale * numerics::chiSquareLimit(kLevel / judged, of[i].dof));
  }
};

ApartInNetwork apartIn(const NestNetwork& network, const metrology::TrackerNoise& noise) {
  ApartInNetwork all;
  std::vector<double> scatter;
  const std::array<double, 4> middle{0.0, numerics::chiSquareLimit(0.5, 1.0), numerics::chiSquareLimit(0.5, 2.0),
                                     numerics::chiSquareLimit(0.5, 3.0)};
  for (const NestResidual& one : network.residuals) {
    all.of.push_back(apart(one, noise));
    const Apart& last = all.of.back();
    if (last.dof > 0) scatter.push_back(last.chi2 / middle[static_cast<std::size_t>(last.dof)]);
  }
  all.judged = static_cast<int>(scatter.size());
  if (!scatter.empty()) all.scale = std::max(1.0, numerics::upperMedian(scatter));
  return all;
}

/// Step 2: adds to `stray` the readings that stand apart from the network of the others, and to `undecided` those of
/// them that another of their round may be wrong instead of. `moved` nests take no part.
void findStrayInNetwork(const std::vector<NestRound>& rounds, const metrology::TrackerNoise& noise,
                        const Eigen::Vector3d& centre, const std::set<int>& moved, std::size_t readings,
                        Readings& stray, Readings& undecided) {
  const Readings before = stray;
  const std::size_t most = std::max<std::size_t>(3, readings / 20);
  constexpr int kNone = -1;
  for (std::size_t found = 0; found <= most; ++found) {
    const NestNetwork network = fitNestNetwork(without(stray, moved, rounds), noise, centre, kNone);
    if (!network.determined) return;
    const ApartInNetwork all = apartIn(network, noise);
    std::size_t worst = 0;
    for (std::size_t i = 1; i < all.of.size(); ++i) {
      if (all.share(i) > all.share(worst)) worst = i;
    }
    if (all.share(worst) <= 1.0) return;
    // Without which other reading would the round be mended as well?
    const double as_well = all.of[worst].chi2 - all.scale * numerics::chiSquareLimit(kLevel / all.judged, 3.0);
    Readings mending;
    for (std::size_t i = 0; i < all.of.size(); ++i) {
      const bool same_round = network.residuals[i].round == network.residuals[worst].round;
      if (same_round && all.share(i) > 1.0 && all.of[i].chi2 >= as_well) mending.insert(network.residuals[i].reading);
    }
    if (mending.size() > 1) undecided.insert(mending.begin(), mending.end());
    stray.merge(mending);
  }
  stray = before;  // the nests do not keep their shape: no single readings
  undecided.clear();
}

/// Takes back what is no single reading of its nest; returns the nests that were moved.
std::set<int> takeBackMoved(const std::vector<NestRound>& rounds, const NestDistances& distances, Readings& stray) {
  std::map<int, std::vector<std::size_t>> rounds_of;
  for (std::size_t e = 0; e < rounds.size(); ++e) {
    for (const auto& [nest, reading] : rounds[e].readings) rounds_of[nest].push_back(e);
  }
  std::set<int> moved;
  for (const auto& [nest, own] : rounds_of) {
    const auto reading = [&rounds, &own = own, nest = nest](std::size_t k) { return rounds[own[k]].readings.at(nest); };
    const auto astray = [&](std::size_t k) { return stray.contains(reading(k)); };
    for (std::size_t first = 0; first < own.size();) {
      std::size_t end = first + 1;
      if (astray(first)) {
        while (end < own.size() && astray(end) && distances.alike(nest, own[end - 1], own[end])) ++end;
        const bool at_an_end = first == 0 || end == own.size();
        if (end - first >= (at_an_end ? 2u : 3u)) {
          moved.insert(nest);
          for (std::size_t k = first; k < end; ++k) stray.erase(reading(k));
        }
      }
      first = end;
    }
  }
  return moved;
}

/// How far a stray reading is from its nest by what the others say of the station, m.
double distanceFrom(const NestNetwork& network, const Eigen::Vector3d& centre, const NestDistances& distances,
                    const std::vector<NestRound>& rounds, std::size_t round, int nest) {
  const auto place = network.places.find(nest);
  if (network.determined && place != network.places.end()) {
    StationMotion course;
    course.centre = centre;
    course.epochs = network.epochs;
    return (course.firstFrom(rounds[round].time_s) * rounds[round].readings.at(nest)->point - place->second).norm();
  }
  double largest = 0.0;
  for (const auto& [other, reading] : rounds[round].readings) {
    const NestDistances::Change* change = other == nest ? nullptr : distances.of(round, nest, other);
    if (change != nullptr) largest = std::max(largest, std::abs(change->by));
  }
  return largest;
}

}  // namespace

namespace {

/// Each station's own, in one list.
NestOutliers outliersByStation(const campaign::Campaign& campaign) {
  NestOutliers all;
  for (std::size_t s = 0; s < campaign.stations.size(); ++s) {
    NestOutliers own = nestOutliers(ofStation(campaign, static_cast<int>(s)));
    all.rounds += own.rounds;
    all.rounds_of_three += own.rounds_of_three;
    all.readings.insert(all.readings.end(), own.readings.begin(), own.readings.end());
    if (!own.tested && all.reason.empty()) all.reason = own.reason;
    all.tested = all.tested || own.tested;
  }
  std::sort(all.readings.begin(), all.readings.end(),
            [](const RejectedReading& a, const RejectedReading& b) { return a.line < b.line; });
  return all;
}

}  // namespace

NestOutliers nestOutliers(const campaign::Campaign& campaign) {
  if (hasStations(campaign)) return outliersByStation(campaign);
  NestOutliers found;
  if (!campaign.nests) {
    found.reason = Remark(RemarkId::no_floor_nests);
    return found;
  }
  if (!declaredNoise(campaign)) {
    found.reason = Remark(RemarkId::tracker_noise_not_declared);
    return found;
  }
  const metrology::TrackerNoise noise =
      frames::trackerNoise(asNoisyAs(*campaign.tracker, roundingOf(campaign).nests.factors));
  const std::vector<NestRound> rounds = nestRounds(*campaign.nests);
  constexpr std::size_t kLeast = 3;
  std::size_t of_enough = 0, readings = 0;
  for (const NestRound& round : rounds) {
    of_enough += round.readings.size() >= kLeast;
    readings += round.readings.size();
    found.rounds_of_three += round.readings.size() <= kLeast;
  }
  found.rounds = static_cast<int>(rounds.size());
  if (of_enough < kLeast) {
    found.reason = Remark(RemarkId::too_few_rounds_to_tell);
    return found;
  }
  found.tested = true;
  const Eigen::Vector3d centre = whereTheArmWasRead(campaign);
  const NestDistances distances(rounds, noise);
  Readings stray = strayByDistance(rounds, distances);
  std::set<int> moved = takeBackMoved(rounds, distances, stray);
  Readings undecided;
  findStrayInNetwork(rounds, noise, centre, moved, readings, stray, undecided);
  moved.merge(takeBackMoved(rounds, distances, stray));
  if (stray.empty()) return found;
  const NestNetwork network = fitNestNetwork(without(stray, moved, rounds), noise, centre, -1);
  for (std::size_t e = 0; e < rounds.size(); ++e) {
    for (const auto& [nest, reading] : rounds[e].readings) {
      if (!stray.contains(reading)) continue;
      Remark reason(RemarkId::one_of_round_wrong);
      if (!undecided.contains(reading)) {
        reason = Remark(RemarkId::stands_from_nest, distanceFrom(network, centre, distances, rounds, e, nest),
                        campaign.nest_ids[static_cast<std::size_t>(nest)]);
      }
      found.readings.push_back({campaign.nests->file, reading->line, std::move(reason)});
    }
  }
  std::sort(found.readings.begin(), found.readings.end(),
            [](const RejectedReading& a, const RejectedReading& b) { return a.line < b.line; });
  return found;
}

}  // namespace stiffscope::preparation
