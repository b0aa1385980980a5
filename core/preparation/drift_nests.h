#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/preparation/nest_network.h"
#include "metrology/measured_points.h"
#include "metrology/remark.h"

namespace stiffscope::preparation {

/// The station's motion by floor nests, split from motion of the nests themselves: nests' places and one
/// rigid motion a round (6 parameters, the first round's zero), by least squares weighted with the declared
/// noise.
struct StationMotion {
  bool tested = false;
  Remark reason;                                     ///< why not
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< where the arm was read: mean of the loading's points
  std::vector<StationEpoch> epochs;
  bool moved = false;             ///< some round's displacement at the centre exceeds its noise
  double moved_limit = 0.0;       ///< chi-square limit of a round's displacement, three coordinates
  double deformation_chi2 = 0.0;  ///< what no rigid motion explains, of all nests
  int deformation_dof = 0;
  double deformation_limit = 0.0;
  double rigid_chi2 = 0.0;  ///< the same of the nests that `epochs` come from: without one that moved
  int rigid_dof = 0;
  std::optional<int> moved_nest;    ///< without it the others are rigid; left out of `epochs`
  double moved_nest_by = 0.0;       ///< how far it went at most against the others, m
  std::size_t moved_nest_line = 0;  ///< of its first reading away from its place

  /// Whether the nests lose their shape and no single one explains it: they are then no reference for the
  /// station.
  bool deforming() const { return deformation_dof > 0 && deformation_chi2 > deformation_limit && !moved_nest; }

  /// Squared displacement at the centre in parts of its variance.
  double significance(const StationEpoch& epoch) const;

  /// Brings a reading at this time onto the first round: motion between rounds is steady, or a jump where one
  /// was seen.
  Eigen::Isometry3d firstFrom(double time_s) const;
};

/// Rounds are told apart by nests that come again. A round of fewer than three nests is left out.
/// Not tested: no nests, no declared noise, fewer than three nests or two rounds.
StationMotion stationMotion(const campaign::Campaign& campaign, const std::optional<metrology::TrackerNoise>& noise);

/// Calls `visit(table)` with each table of the arm's readings that stand in the tracker's frame: those that a
/// moving station takes along.
template <class CampaignType, class Visit>
void forEachDriftingTable(CampaignType& campaign, const Visit& visit) {
  const auto inTrackerFrame = [&](auto& table) {
    if (table && table->frame == campaign::PointFrame::tracker) visit(*table);
  };
  inTrackerFrame(campaign.circle_sweeps);
  inTrackerFrame(campaign.wrist_sweep);
  inTrackerFrame(campaign.rail_sweep);
  inTrackerFrame(campaign.loading);
}

/// The same motion as another frame sees it, `other_from_own` of the frame of its readings.
StationMotion inFrame(StationMotion station, const Eigen::Isometry3d& other_from_own);

/// Takes the motion off the readings that state a time and are in the tracker's frame; the rest stays.
void applyDriftCorrection(const StationMotion& station, campaign::Campaign& campaign);

/// The contrary: the same readings as they were before.
void putBackDrift(const StationMotion& station, campaign::Campaign& campaign);

/// The same of several stations, by the index of each; a station whose entry has no rounds stood still.
void applyDriftCorrection(const std::vector<StationMotion>& stations, campaign::Campaign& campaign);
void putBackDrift(const std::vector<StationMotion>& stations, campaign::Campaign& campaign);

/// When the station jumped that did so between round `round` of the nests and the one before, s: between two
/// postures, where the unloaded positions then fit the arm best, or at the interval's start or end; its middle
/// where the positions cannot say.
double jumpTime(const campaign::Campaign& campaign, const metrology::TrackerNoise& noise, StationMotion station,
                std::size_t round);

/// Tells a jump of the station between two rounds from drift, and says when it jumped.
///
/// Repeats of one state follow each other within seconds: had the station drifted steadily as far as the
/// nests say, they would show it; where they scatter less as they were read, it jumped. When: between two
/// postures, where the unloaded positions then best fit forward kinematics, or before the first or after the
/// last of the interval.
void findJumps(const campaign::Campaign& campaign, const metrology::TrackerNoise& noise, StationMotion& station);

}  // namespace stiffscope::preparation
