#pragma once

#include <optional>
#include <vector>

#include "core/preparation/drift_nests.h"
#include "core/preparation/finding.h"
#include "core/preparation/join_stations.h"
#include "core/preparation/rail.h"
#include "core/preparation/repeatability.h"
#include "core/preparation/station_course.h"

namespace stiffscope::preparation {

/// The station's motion that was taken off the readings, or why it was not.
struct DriftCorrection {
  bool taken_off = false;
  Remark reason;                 ///< why not
  double displacement = 0.0;     ///< largest of all nest rounds against the first, where the arm was read, m
  double turn = 0.0;             ///< largest of all rounds, rad
  double until_s = 0.0;          ///< time of the last round
  std::vector<double> jumps_s;   ///< where the station jumped instead of drifting: when
  std::size_t readings = 0;      ///< referred to the first round
  std::size_t without_time = 0;  ///< in the tracker's frame, but no time says how the station stood: as read
  std::size_t spread = 0;        ///< among them: of sweeps that state no time, taken as read evenly before the loading
};

/// What was done to a campaign before anything was computed from it.
struct Preparation {
  bool raw = false;  ///< as it was read, because that was asked for
  std::vector<RejectedReading> rejected;
  DriftCorrection drift;                      ///< of all stations together
  std::optional<JoinedStations> stations;     ///< of a day of several; its readings are in the first one's frame
  std::optional<campaign::Tracker> declared;  ///< the tracker as campaign.xml has it
};

/// A day as audit, identification and diagnosis all see it.
struct PreparedCampaign {
  /// Readings that are used; its tracker is as noisy as the repeats show where that is beyond what is declared by more
  /// than chance, so that one cause gives one finding, and has the rounding of its readings in its noise.
  campaign::Campaign campaign;
  Preparation preparation;
  std::vector<AuditCheck> screening;  ///< the checks that found the rejected readings
  RepeatScatter scatter;              ///< of the repeats that are left, against the declared noise and rounding
  NoiseModel noise;
  DriftModel drift;                ///< by the nests; of several stations what is left once each one's own is taken off
  std::optional<RailCourse> rail;  ///< by the rail sweep, of an arm on a rail
};

/// A campaign as identification should see it: without the readings that screening rejects (lost beams,
/// duplicates, outlying repeats and nest readings), and referred to the first round of the floor nests where these show
/// that the station moved: one jump or a steady drift where either fits the rounds, else from round to round. The
/// motion is taken off only where it is larger than noise explains (chi-square at the audit's level) and where the
/// nests, one that moved left out, keep their shape: nests that do not are no reference. Sweeps that state no time are
/// taken to have been read row by row, evenly, between the first round of the nests and the last one before the
/// loading, where the station drifted. Of an arm on a rail everything is referred to its carriage at zero.
///
/// A day of several stations: each one's motion is found by its own rounds of the nests and taken off, to its own first
/// round; then the stations are joined (core/preparation/join_stations.h), and all readings are in the first one's
/// frame. Sweeps that state no time keep what a drift did to them. Throws InputError where a station cannot be joined.
PreparedCampaign prepareCampaign(campaign::Campaign read);

/// The same readings with the station's motion put back on them: as they were measured, but for rounding, and with the
/// carriage of a rail where the preparation has it.
PreparedCampaign asMeasured(PreparedCampaign prepared);

/// The same campaign untouched, with a preparation that says so; several stations are joined, as read.
PreparedCampaign leaveRaw(campaign::Campaign read);

}  // namespace stiffscope::preparation
