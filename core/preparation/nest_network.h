#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/preparation/finding.h"
#include "metrology/measured_points.h"
#include "metrology/remark.h"

namespace stiffscope::preparation {

/// How the station stood at one round of the nests against the first round.
struct StationEpoch {
  double time_s = 0.0;
  /// Rotation vector (rad) then displacement at `centre` (m) that bring this round's readings onto the
  /// first's.
  Eigen::Matrix<double, 6, 1> motion = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< by the declared noise
  /// Where the station jumped between the round before and this one instead of drifting: when, s.
  std::optional<double> jumped_at;
};

/// One round of nest readings.
struct NestRound {
  double time_s = 0.0;  ///< mean of its readings
  std::map<int, const campaign::NestReading*> readings;
};

/// Rounds in the order of time; a nest that comes again starts the next one of its station. They point into `nests`.
std::vector<NestRound> nestRounds(const campaign::Nests& nests);

/// Readings that one motion brings onto those of the first set; a nest may be among them more than once.
struct NestSet {
  double time_s = 0.0;
  std::vector<const campaign::NestReading*> readings;
  metrology::TrackerNoise noise;  ///< of these readings
};

/// What a reading of a nest leaves once places and motions are fitted.
struct NestResidual {
  const campaign::NestReading* reading = nullptr;
  std::size_t round = 0;                                 ///< index into NestNetwork::epochs: its round, or its set
  Eigen::Vector3d off = Eigen::Vector3d::Zero();         ///< from its nest's place, in the first round's frame, m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of `off`, by the declared noise; singular where the
                                                         ///< motion takes up what the reading is off
  double chi2 = 0.0;                                     ///< `off` in parts of the reading's own noise
};

/// Places of the nests and motions of the station that fit the rounds best.
struct NestNetwork {
  bool determined = false;
  double chi2 = 0.0;
  int dof = 0;
  std::vector<StationEpoch> epochs;       ///< one a round
  std::map<int, Eigen::Vector3d> places;  ///< of the nests in the first round's frame
  std::vector<NestResidual> residuals;    ///< of every reading of the rounds used
};

/// Gauss-Newton on whitened residuals T_e p - X_n; rounds of fewer than three nests (`left_out` not counted)
/// are skipped. Undetermined: fewer than two such rounds, or nests on one line. `left_out` < 0: none is.
NestNetwork fitNestNetwork(const std::vector<NestRound>& rounds, const metrology::TrackerNoise& noise,
                           const Eigen::Vector3d& centre, int left_out);

/// The same of sets of readings, each with a noise of its own, whose readings are near those of the first set already:
/// within a few degrees, as the rotation vectors are added up. Undetermined also where a set has fewer than three
/// nests.
NestNetwork fitNestNetwork(const std::vector<NestSet>& sets, const Eigen::Vector3d& centre);

/// Mean of the loading's points; without a loading of the sweeps', else of the nests'. In the tracker's frame, m.
Eigen::Vector3d whereTheArmWasRead(const campaign::Campaign& campaign);

/// Readings of floor nests that stand apart from their nest's other readings, whatever the station did.
struct NestOutliers {
  bool tested = false;
  Remark reason;                          ///< why not
  std::vector<RejectedReading> readings;  ///< in the order of the table
  int rounds = 0;
  int rounds_of_three = 0;  ///< rounds of three nests or fewer, in which not every wrong reading can be told
};

/// A round's nests keep their shape, however the station moved. Two steps, both at the level of the audit shared by the
/// readings, times the nests' own median scatter where that is larger than declared:
///
/// 1. Distances between two nests against their median over the rounds. The nest that most distances of its round
///    speak against, two or more, is wrong there. Medians and majorities hold whatever size the errors have.
/// 2. One after the other, worst first, readings that stand apart from places and motions fitted to all that are left:
///    v^T Q_v^-1 v, v a reading's residual and Q_v its covariance, is chi-square with as many degrees of freedom as Q_v
///    has directions that the motion leaves open (Baarda, A testing procedure for use in geodetic networks, 1968).
///    Where others of the round mend it as well when left out, nobody can tell which is wrong, and all of them go.
///
/// Readings of one nest that stand apart together - two in a row where the day begins or ends, three anywhere - are a
/// nest that was moved, which core/preparation/drift_nests.h judges: they stay. So do more than one in twenty, and more
/// than three, by the second step: they are no single readings.
///
/// Of five nests an error across their plane leaves one or two in doubt and enough for the motion; four show only that
/// there is one, and the round is lost; three show it in their plane alone; of two none is known to be wrong. Not
/// tested: no nests, no declared noise, fewer than three rounds or three nests.
NestOutliers nestOutliers(const campaign::Campaign& campaign);

}  // namespace stiffscope::preparation
