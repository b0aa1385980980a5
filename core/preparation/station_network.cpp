#include "core/preparation/station_network.h"

#include <Eigen/Dense>
#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"
#include "core/preparation/nest_network.h"
#include "metrology/registration.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::preparation {

namespace {

using Stations = std::vector<NestsOfStation>;

/// Poses by plain rigid registration, the station with most nests in common after the other; the order of joining.
std::vector<std::size_t> registerInOrder(const Stations& stations, std::vector<StationPose>& poses) {
  std::map<int, Eigen::Vector3d> places;
  std::vector<std::size_t> order;
  std::set<std::size_t> left;
  for (std::size_t s = 1; s < stations.size(); ++s) left.insert(s);
  const auto join = [&](std::size_t s) {
    poses[s].joined = StationPose::Joined::yes;
    order.push_back(s);
    for (const campaign::NestReading& reading : stations[s].readings)
      places.try_emplace(reading.nest, poses[s].first_from_station * reading.point);
  };
  join(0);
  for (bool joined = true; joined;) {
    joined = false;
    std::size_t best = 0;
    metrology::RigidRegistration best_fit;
    for (const std::size_t s : left) {
      std::vector<Eigen::Vector3d> own, first;
      std::map<int, Eigen::Vector3d> common;
      for (const campaign::NestReading& reading : stations[s].readings) {
        const auto place = places.find(reading.nest);
        if (place == places.end()) continue;
        own.push_back(reading.point);
        first.push_back(place->second);
        common.insert(*place);
      }
      poses[s].common_nests = static_cast<int>(common.size());
      if (common.size() < 3) continue;
      std::vector<Eigen::Vector3d> apart;
      for (const auto& [nest, place] : common) apart.push_back(place);
      const metrology::RigidRegistration fit = metrology::registerRigid(own, first);
      if (metrology::nearlyOnOneLine(apart) || !fit.determined) {
        poses[s].joined = StationPose::Joined::common_nests_on_one_line;
        continue;
      }
      if (joined && poses[s].common_nests <= poses[best].common_nests) continue;
      joined = true, best = s, best_fit = fit;
    }
    if (!joined) break;
    poses[best].first_from_station = best_fit.to_from_source;
    left.erase(best);
    join(best);
  }
  return order;
}

/// Readings with the first station's frame under them, for the network.
struct ReferredReadings {
  std::vector<std::vector<campaign::NestReading>> rows;  ///< by station in the order of joining
  std::vector<NestSet> sets;
};

ReferredReadings referred(const Stations& stations, const std::vector<StationPose>& poses,
                          const std::vector<std::size_t>& order) {
  ReferredReadings all;
  for (const std::size_t s : order) {
    const Eigen::Isometry3d& pose = poses[s].first_from_station;
    std::vector<campaign::NestReading>& rows = all.rows.emplace_back(stations[s].readings);
    for (campaign::NestReading& row : rows) row.point = pose * row.point;
    metrology::TrackerNoise noise = stations[s].noise;
    noise.station = pose * noise.station;
    all.sets.push_back({0.0, {}, noise});
  }
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    for (const campaign::NestReading& row : all.rows[i]) all.sets[i].readings.push_back(&row);
  }
  return all;
}

/// A network with what each of its readings leaves.
struct FittedStations {
  StationNetwork network;
  struct Residual {
    std::size_t station = 0;
    std::size_t reading = 0;  ///< index into the station's readings
    double chi2 = 0.0;
  };
  std::vector<Residual> residuals;
};

FittedStations fitStations(const Stations& stations, const Eigen::Vector3d& centre) {
  FittedStations fit;
  std::vector<StationPose>& poses = fit.network.stations;
  poses.resize(stations.size());
  for (StationPose& pose : poses) pose.centre = centre;
  const std::vector<std::size_t> order = registerInOrder(stations, poses);
  if (order.size() < 2) return fit;
  // Once more from the poses found: what the linearisation of a first step of some degrees left is then gone.
  constexpr int kPasses = 2;
  for (int pass = 0; pass < kPasses; ++pass) {
    const ReferredReadings all = referred(stations, poses, order);
    const NestNetwork network = fitNestNetwork(all.sets, centre);
    if (!network.determined) return fit;
    fit.residuals.clear();
    for (std::size_t i = 0; i < order.size(); ++i) {
      StationPose& pose = poses[order[i]];
      pose.first_from_station = metrology::motionAbout(centre, network.epochs[i].motion) * pose.first_from_station;
      pose.covariance = network.epochs[i].covariance;
    }
    for (const NestResidual& one : network.residuals) {
      const auto at = static_cast<std::size_t>(one.reading - all.rows[one.round].data());
      fit.residuals.push_back({order[one.round], at, one.chi2});
    }
    fit.network.places = network.places;
    fit.network.chi2 = network.chi2;
    fit.network.dof = network.dof;
  }
  fit.network.limit = fit.network.dof > 0 ? numerics::chiSquareLimit(kLevel, fit.network.dof) : 0.0;
  return fit;
}

bool joinsAsMany(const StationNetwork& network, const StationNetwork& as) {
  const auto joined = [](const StationNetwork& one) {
    return std::count_if(one.stations.begin(), one.stations.end(),
                         [](const StationPose& pose) { return pose.joined == StationPose::Joined::yes; });
  };
  return joined(network) == joined(as);
}

/// The largest distance of a station's readings of a nest, or of the one in that line, from where the network puts it.
double distanceOff(const NestsOfStation& readings, const StationNetwork& network, const OutlyingNest& outlying) {
  const auto place = network.places.find(outlying.nest);
  double largest = 0.0;
  for (const campaign::NestReading& reading : readings.readings) {
    if (place == network.places.end() || reading.nest != outlying.nest) continue;
    if (outlying.line && reading.line != *outlying.line) continue;
    const Eigen::Vector3d at = network.stations[outlying.station].first_from_station * reading.point;
    largest = std::max(largest, (at - place->second).norm());
  }
  return largest;
}

Stations withoutNest(Stations stations, std::size_t station, int nest) {
  std::erase_if(stations[station].readings, [&](const campaign::NestReading& one) { return one.nest == nest; });
  return stations;
}

/// Leaves out the readings that stand apart most, one by one, if at most three of them mend the network.
bool leaveOutReadings(Stations& stations, const Eigen::Vector3d& centre, FittedStations& fit) {
  constexpr int kMost = 3;
  Stations rest = stations;
  FittedStations now = fitStations(rest, centre);
  std::vector<OutlyingNest> found;
  for (int k = 0; k < kMost && !now.network.consistent(); ++k) {
    const auto worst = std::max_element(now.residuals.begin(), now.residuals.end(),
                                        [](const auto& a, const auto& b) { return a.chi2 < b.chi2; });
    if (worst == now.residuals.end()) return false;
    // Taken for a wrong reading only where the station has others of that nest to say so.
    auto& readings = rest[worst->station].readings;
    const campaign::NestReading off = readings[worst->reading];
    if (std::count_if(readings.begin(), readings.end(), [&](const auto& one) { return one.nest == off.nest; }) < 2)
      return false;
    found.push_back({worst->station, off.nest, off.line, 0.0});
    readings.erase(readings.begin() + static_cast<std::ptrdiff_t>(worst->reading));
    now = fitStations(rest, centre);
    if (!joinsAsMany(now.network, fit.network)) return false;
  }
  if (!now.network.consistent()) return false;
  for (OutlyingNest& one : found) one.by = distanceOff(stations[one.station], now.network, one);
  now.network.outlying = std::move(found);
  stations = std::move(rest);
  fit = std::move(now);
  return true;
}

/// Leaves out one station's readings of one nest after the other, each time those without which chi2 is least.
void leaveOutNests(const Stations& stations, const Eigen::Vector3d& centre, FittedStations& fit) {
  const std::size_t most = std::max<std::size_t>(1, fit.network.places.size() / 4);
  Stations rest = stations;
  FittedStations now = fit;
  std::vector<OutlyingNest> found;
  while (found.size() < most && !now.network.consistent()) {
    std::optional<OutlyingNest> best;
    FittedStations best_fit;
    for (std::size_t s = rest.size(); s-- > 0;) {  // of two that fit as well the later station
      std::set<int> nests;
      for (const campaign::NestReading& reading : rest[s].readings) nests.insert(reading.nest);
      for (const int nest : nests) {
        FittedStations other = fitStations(withoutNest(rest, s, nest), centre);
        if (!joinsAsMany(other.network, fit.network) || other.network.dof <= 0) continue;
        // Of a nest that two stations read chance decides nothing: a log-likelihood ratio of 5, odds of 150 to one.
        constexpr double kDecisive = 10.0;
        const auto excess = [](const FittedStations& one) { return one.network.chi2 - one.network.dof; };
        const double at_least = best && best->nest == nest ? kDecisive : 0.0;
        if (best && excess(other) >= excess(best_fit) - at_least) continue;
        best = OutlyingNest{s, nest, std::nullopt, 0.0};
        best_fit = std::move(other);
      }
    }
    if (!best) return;
    rest = withoutNest(std::move(rest), best->station, best->nest);
    found.push_back(*best);
    now = std::move(best_fit);
  }
  if (!now.network.consistent()) return;
  for (OutlyingNest& one : found) one.by = distanceOff(stations[one.station], now.network, one);
  now.network.outlying = std::move(found);
  fit = std::move(now);
}

}  // namespace

bool StationNetwork::allJoined() const {
  return std::all_of(stations.begin(), stations.end(),
                     [](const StationPose& pose) { return pose.joined == StationPose::Joined::yes; });
}

StationNetwork fitStationNetwork(const std::vector<NestsOfStation>& stations, const Eigen::Vector3d& centre) {
  if (stations.empty()) return {};
  Stations used = stations;
  FittedStations fit = fitStations(used, centre);
  if (!fit.network.consistent() && !leaveOutReadings(used, centre, fit)) leaveOutNests(used, centre, fit);
  return std::move(fit.network);
}

}  // namespace stiffscope::preparation
