#include "core/preparation/prepare.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/campaign/row_names.h"
#include "core/frames/joint_axes.h"
#include "core/preparation/drift_nests.h"
#include "core/preparation/repeatability.h"

namespace stiffscope::preparation {

namespace {

/// Why the station's motion cannot or need not be taken off; empty where it should be.
std::string whyNot(const StationMotion& station) {
  if (!station.tested) return station.reason;
  if (station.deforming()) {
    return "the nests themselves moved against each other, more than one of them: they are no reference";
  }
  if (!station.moved) return "the nests show no motion of the station beyond their noise";
  return {};
}

void countReadings(const campaign::Campaign& campaign, DriftCorrection& drift) {
  forEachDriftingTable(campaign, [&](const auto& table) {
    for (const auto& row : table.rows) ++(std::isfinite(row.time_s) ? drift.readings : drift.without_time);
  });
}

DriftCorrection correctDrift(const StationMotion& station, campaign::Campaign& campaign) {
  DriftCorrection drift;
  drift.reason = whyNot(station);
  if (!drift.reason.empty()) return drift;
  drift.taken_off = true;
  for (const StationEpoch& epoch : station.epochs) {
    drift.displacement = std::max(drift.displacement, epoch.motion.tail<3>().norm());
    drift.turn = std::max(drift.turn, epoch.motion.head<3>().norm());
    if (epoch.jumped_at) drift.jumps_s.push_back(*epoch.jumped_at);
  }
  drift.until_s = station.epochs.back().time_s;
  countReadings(campaign, drift);
  applyDriftCorrection(station, campaign);
  return drift;
}

}  // namespace

PreparedCampaign prepareCampaign(campaign::Campaign read) {
  Screening screening = screenReadings(std::move(read));
  PreparedCampaign prepared;
  prepared.campaign = std::move(screening.campaign);
  prepared.screening = std::move(screening.checks);
  prepared.preparation.rejected = std::move(screening.rejected);
  prepared.scatter = repeatScatter(prepared.campaign);
  std::optional<metrology::TrackerNoise> noise;
  if (declaredNoise(prepared.campaign))
    noise = frames::trackerNoise(asNoisyAs(*prepared.campaign.tracker, noiseFactors(prepared.scatter)));
  prepared.station = stationMotion(prepared.campaign, noise);
  if (prepared.station.moved && !prepared.station.deforming()) {
    findJumps(prepared.campaign, *noise, prepared.station);
  }
  prepared.preparation.drift = correctDrift(prepared.station, prepared.campaign);
  return prepared;
}

PreparedCampaign leaveRaw(campaign::Campaign read) {
  PreparedCampaign prepared;
  prepared.campaign = std::move(read);
  prepared.preparation.raw = true;
  prepared.preparation.drift.reason = "raw readings were asked for";
  return prepared;
}

}  // namespace stiffscope::preparation
