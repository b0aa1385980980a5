#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "metrology/measured_points.h"

namespace stiffscope::preparation {

/// What one tracker station read of the floor nests while it stood still, in its own frame.
struct NestsOfStation {
  std::vector<campaign::NestReading> readings;  ///< in any number of rounds
  metrology::TrackerNoise noise;                ///< its origin in its own frame
};

/// How a station stands against the first one.
struct StationPose : campaign::StationPlace {
  enum class Joined { yes, too_few_common_nests, common_nests_on_one_line };

  Joined joined = Joined::too_few_common_nests;
  int common_nests = 0;  ///< with the stations that it is joined to
};

/// A nest, or one of its readings, that the others contradict.
struct OutlyingNest {
  std::size_t station = 0;  ///< whose readings were left out
  int nest = 0;
  /// One reading alone; else all of this station's are apart: the nest moved between two stations. Of a nest that two
  /// stations read nobody can tell at which of them it was wrong: the later one is named.
  std::optional<std::size_t> line;
  double by = 0.0;  ///< largest distance from where the others put it, m
};

/// The stations of a day against the first, by the nests that they have in common.
struct StationNetwork {
  std::vector<StationPose> stations;      ///< one a station; the first is the identity
  std::map<int, Eigen::Vector3d> places;  ///< of the nests in the first station's frame, m
  double chi2 = 0.0;                      ///< of what is left, by the declared noise
  int dof = 0;
  double limit = 0.0;                  ///< of chi2 by chance, at the audit's level
  std::vector<OutlyingNest> outlying;  ///< left out, in the order in which they were found

  bool allJoined() const;
  /// Whether the nests keep their shape from station to station once the outlying ones are left out.
  bool consistent() const { return dof == 0 || chi2 <= limit; }
};

/// Least squares over all readings, weighted along and across the beam of the station that read them:
///
///   sum |T_s p - X_n|^2 by (R_s C(p) R_s^T)^-1, T_1 = 1; poses T_s and places X_n are unknown
///
/// (fitNestNetwork, one set of readings a station, brought near the first one's by rigid registration; the weights are
/// then those of the fitted poses). dof = 3 readings - 6 (stations - 1) - 3 places.
///
/// A station is joined by three nests or more, not on one line, that the first one or stations joined before it read,
/// too; the one with most of them comes next.
///
/// Where chi2 is beyond its limit the reading that stands apart most is left out if that mends it (three readings at
/// most); else the readings that one station has of one nest, one nest after the other as long as chi2 stays beyond and
/// more than three nests join every station, one nest in four at most. Where nothing mends it all stay, and
/// consistent() is false.
///
/// Assumes stations that do not drift: a drift is taken off each of them first. Correlations between the poses of a
/// third station and a second, by the nests' places that they share, are not given.
StationNetwork fitStationNetwork(const std::vector<NestsOfStation>& stations, const Eigen::Vector3d& centre);

}  // namespace stiffscope::preparation
