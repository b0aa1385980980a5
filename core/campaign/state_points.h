#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "metrology/measured_points.h"

namespace stiffscope::campaign {

/// One reflector in one state of the arm: the mean of its readings. Of a long sweep there are a million.
struct ReflectorMean {
  int target = 0;
  int readings = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  std::size_t line = 0;                      ///< of its first reading
  int station = 0;                           ///< from which it was read, index into Campaign::stations
  Eigen::Vector3d from = kStationOfTracker;  ///< where the instrument stood there

  /// Of the mean, m^2.
  Eigen::Matrix3d covariance(const metrology::TrackerNoise& noise) const {
    return noise.covarianceAt(point, from) / readings;
  }
  /// With that of its station's pose, m^2: of an absolute position beside those of other stations.
  Eigen::Matrix3d absoluteCovariance(const Campaign& campaign, const metrology::TrackerNoise& noise) const {
    return covariance(noise) + stationCovariance(campaign, station, point);
  }
};

/// The reflectors while the arm stood still: one index of a sweep, or one load state.
struct StatePoints {
  enum class Source { circle_sweeps, wrist_sweep, loading };
  Source source = Source::loading;
  int axis = 0;       ///< of a circle sweep
  std::string index;  ///< of a sweep
  int pose = -1;      ///< -1 in sweeps
  int step = 0;       ///< 0 in sweeps: no load
  std::vector<ReflectorMean> reflectors;

  const ReflectorMean* of(int target) const;
};

/// The table a state is from, and its name for people: "pose 3, step 1", "axis 4, index 7".
const std::string& fileOf(const Campaign& campaign, const StatePoints& state);
std::string nameOf(const Campaign& campaign, const StatePoints& state);

/// All states of circle sweeps, wrist sweep and loading, in that order; for the loading in the order of its
/// rows.
std::vector<StatePoints> statePoints(const Campaign& campaign);

/// A day of unloaded postures: readings of them, and no wrench that is not zero, whether a load cell is declared or
/// not.
bool isUnloadedDay(const Campaign& campaign);

}  // namespace stiffscope::campaign
