#include "core/preparation/prepare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/campaign/row_names.h"
#include "core/frames/joint_axes.h"
#include "core/preparation/drift_nests.h"
#include "core/preparation/remarks.h"
#include "core/preparation/repeatability.h"

namespace stiffscope::preparation {

namespace {

/// Why the station's motion cannot or need not be taken off; empty where it should be.
Remark whyNot(const DriftModel& station) {
  if (station.moved()) return {};
  return station.course == StationCourse::still ? Remark(RemarkId::no_motion_beyond_noise) : station.remark;
}

/// Sweeps that state no time are taken to have been read row by row, evenly, between the first round of the nests and
/// the last one before the loading: what a drift did to them is then known to a part of itself. Returns how many
/// readings in the tracker's frame got their time so.
std::size_t spreadSweepTimes(const StationMotion& station, campaign::Campaign& campaign) {
  if (!campaign.circle_sweeps || !campaign.loading) return 0;
  double loading = std::numeric_limits<double>::infinity();
  for (const campaign::LoadingReading& row : campaign.loading->rows) {
    if (std::isfinite(row.time_s)) loading = std::min(loading, row.time_s);
  }
  const double first = station.epochs.front().time_s;
  double last = first;
  for (const StationEpoch& epoch : station.epochs) {
    if (epoch.time_s < loading) last = epoch.time_s;
  }
  const std::size_t count =
      campaign.circle_sweeps->rows.size() + (campaign.wrist_sweep ? campaign.wrist_sweep->rows.size() : 0);
  std::size_t at = 0, without_time = 0;
  const auto spread = [&](auto& table) {
    for (auto& row : table.rows) {
      ++at;
      if (std::isfinite(row.time_s)) continue;
      row.time_s = first + (last - first) * static_cast<double>(at) / static_cast<double>(count);
      without_time += table.frame == campaign::PointFrame::tracker;
    }
  };
  spread(*campaign.circle_sweeps);
  if (campaign.wrist_sweep) spread(*campaign.wrist_sweep);
  return without_time;
}

void countReadings(const campaign::Campaign& campaign, DriftCorrection& drift) {
  forEachDriftingTable(campaign, [&](const auto& table) {
    for (const auto& row : table.rows) ++(std::isfinite(row.time_s) ? drift.readings : drift.without_time);
  });
}

DriftCorrection correctDrift(const DriftModel& station, campaign::Campaign& campaign) {
  DriftCorrection drift;
  drift.reason = whyNot(station);
  if (!drift.reason.empty()) return drift;
  drift.taken_off = true;
  for (const StationEpoch& epoch : station.motion.epochs) {
    drift.displacement = std::max(drift.displacement, epoch.motion.tail<3>().norm());
    drift.turn = std::max(drift.turn, epoch.motion.head<3>().norm());
    if (epoch.jumped_at) drift.jumps_s.push_back(*epoch.jumped_at);
  }
  drift.until_s = station.motion.epochs.back().time_s;
  if (station.course == StationCourse::drifted) drift.spread = spreadSweepTimes(station.motion, campaign);
  countReadings(campaign, drift);
  applyDriftCorrection(station.motion, campaign);
  return drift;
}

}  // namespace

PreparedCampaign prepareCampaign(campaign::Campaign read) {
  Screening screening = screenReadings(std::move(read));
  PreparedCampaign prepared;
  prepared.campaign = std::move(screening.campaign);
  prepared.screening = std::move(screening.checks);
  prepared.preparation.rejected = std::move(screening.rejected);
  const std::optional<campaign::Tracker> declared = prepared.preparation.declared = prepared.campaign.tracker;
  const bool known = declaredNoise(prepared.campaign).has_value();
  prepared.scatter = repeatScatter(prepared.campaign);
  const auto shown = [&] { return asNoisyAs(*declared, noiseFactors(prepared.scatter)); };
  prepared.drift =
      stationCourse(prepared.campaign, known ? std::optional(frames::trackerNoise(shown())) : std::nullopt);
  prepared.preparation.drift = correctDrift(prepared.drift, prepared.campaign);
  // A drift that goes on between repeats is no scatter of the instrument.
  if (prepared.preparation.drift.taken_off) prepared.scatter = repeatScatter(prepared.campaign);
  prepared.noise = noiseModel(prepared.campaign, prepared.scatter);
  if (known) prepared.campaign.tracker = shown();
  return prepared;
}

PreparedCampaign asMeasured(PreparedCampaign prepared) {
  if (!prepared.preparation.drift.taken_off) return prepared;
  putBackDrift(prepared.drift.motion, prepared.campaign);
  prepared.preparation.drift = {};
  prepared.preparation.drift.reason = Remark(RemarkId::as_measured_asked_for);
  return prepared;
}

PreparedCampaign leaveRaw(campaign::Campaign read) {
  PreparedCampaign prepared;
  prepared.campaign = std::move(read);
  prepared.preparation.raw = true;
  prepared.preparation.declared = prepared.campaign.tracker;
  prepared.noise = noiseModel(prepared.campaign, repeatScatter(prepared.campaign));
  prepared.preparation.drift.reason = Remark(RemarkId::raw_asked_for);
  return prepared;
}

}  // namespace stiffscope::preparation
