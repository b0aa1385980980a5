#pragma once

#include <map>
#include <vector>

#include "core/audit/station_motion.h"

namespace stiffscope {

/// One round of nest readings.
struct NestRound {
  double time_s = 0.0;  ///< mean of its readings
  std::map<int, const NestReading*> readings;
};

/// Rounds in the order of time; a nest that comes again starts the next one.
std::vector<NestRound> nestRounds(const Nests& nests);

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
NestNetwork fitNestNetwork(const std::vector<NestRound>& rounds, const TrackerNoise& noise,
                           const Eigen::Vector3d& centre, int left_out);

}  // namespace stiffscope
