#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/preparation/station_course.h"
#include "core/preparation/station_network.h"
#include "metrology/measured_points.h"

namespace stiffscope::preparation {

/// The stations of a day as they were joined.
struct JoinedStations {
  StationNetwork network;             ///< one pose a station of the campaign, in their order
  std::vector<DriftModel> courses;    ///< of each station by its own rounds of the nests, in the first one's frame
  std::vector<std::size_t> readings;  ///< of the arm, from each station
};

/// Largest standard uncertainties of a pose over all directions, where the arm was read: m, rad.
struct PoseUncertainty {
  double position = 0.0, turn = 0.0;
};
PoseUncertainty poseUncertainty(const campaign::StationPlace& place);

/// "station 'B'", or what the one of the rows that name none is called.
std::string shownStation(const campaign::StationPlace& place);

/// Whether the tables name stations.
inline bool hasStations(const campaign::Campaign& campaign) { return campaign.stations.size() > 1; }

/// The readings from one station alone, of all tables of points.
campaign::Campaign ofStation(campaign::Campaign campaign, int station);

/// Brings the readings of all stations into the frame of the first one, by the nests that they have in common
/// (core/preparation/station_network.h), and says where each reading was taken from (`from`), and how the stations
/// stand (Campaign::stations).
///
/// `as_drifted`: without taking each station's own motion off first. Else the arm's readings with a time, and the
/// nests, are referred to the first round of their own station where its rounds show a motion beyond noise
/// (stationCourse), and the network joins the nests as they are then.
///
/// Uncertainty: the pose of a station is one rigid motion of all that was read from it. Displacements are of readings
/// from one station (checkCampaign) and keep their length; their direction is off by the pose's rotation, some 1e-5 of
/// them. Absolute positions have it whole: Campaign::stations states it, and it is in the covariances of positions that
/// are held against those of other stations, reading by reading; that they share it is left out.
///
/// `noise`: of the tracker, the same instrument at all stations, in the frame of its own readings. Throws InputError
/// where a station has fewer than three nests in common with the others, or nests on one line.
JoinedStations joinStations(const metrology::TrackerNoise& noise, bool as_drifted, campaign::Campaign& campaign);

}  // namespace stiffscope::preparation
