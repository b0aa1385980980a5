#include "core/diagnosis/gap_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/audit/day.h"
#include "core/audit/repeat_scatter.h"
#include "core/audit/screening.h"
#include "core/diagnosis/start_state.h"
#include "core/identification/describe_loads.h"
#include "core/identification/geometry_calibration.h"

namespace stiffscope {

namespace {

/// Stiffnesses to start from: those of identification on the largest load.
Vector6d startCompliance(const Campaign& campaign, LoadedArm arm) {
  return arm.cases.empty() ? Vector6d(Vector6d::Zero()) : sagCompliance(campaign, {}, arm);
}

bool sameFrame(const Campaign& campaign) {
  return campaign.circle_sweeps && campaign.loading &&
         campaign.circle_sweeps->frame == campaign.loading->frame &&
         (!campaign.wrist_sweep || campaign.wrist_sweep->frame == campaign.loading->frame);
}

/// Sweeps that state no time are taken to have been read row by row, evenly, between the first round of the
/// nests and the last one before the loading: what a drift did to them is then known to a part of itself.
void spreadSweepTimes(const StationMotion& station, Campaign& campaign) {
  if (!campaign.circle_sweeps || !campaign.loading) return;
  double loading = std::numeric_limits<double>::infinity();
  for (const LoadingReading& row : campaign.loading->rows) {
    if (std::isfinite(row.time_s)) loading = std::min(loading, row.time_s);
  }
  const double first = station.epochs.front().time_s;
  double last = first;
  for (const StationEpoch& epoch : station.epochs) {
    if (epoch.time_s < loading) last = epoch.time_s;
  }
  auto& circles = campaign.circle_sweeps->rows;
  const std::size_t count = circles.size() + (campaign.wrist_sweep ? campaign.wrist_sweep->rows.size() : 0);
  std::size_t at = 0;
  const auto spread = [&](auto& rows) {
    for (auto& row : rows) {
      ++at;
      if (!std::isfinite(row.time_s))
        row.time_s = first + (last - first) * static_cast<double>(at) / static_cast<double>(count);
    }
  };
  spread(circles);
  if (campaign.wrist_sweep) spread(campaign.wrist_sweep->rows);
}

}  // namespace

NoiseFloor noiseFloor(const Campaign& campaign) {
  NoiseFloor floor;
  if (!campaign.tracker) {
    floor.source = "the tracker's noise is not declared";
    return floor;
  }
  floor.noise = trackerNoise(*campaign.tracker);
  floor.known = floor.noise.range_fixed + floor.noise.range_per_m > 0.0 &&
                floor.noise.angle_fixed + floor.noise.angle_per_m > 0.0;
  floor.source = "the tracker's declared noise";
  if (!floor.known || !campaign.loading) return floor;
  const RepeatScatter scatter = repeatScatter(campaign);
  constexpr int kEnough = 30;
  if (scatter.along_dof < kEnough) {
    floor.source += ", because there are too few repeats to check it";
    return floor;
  }
  floor.along_factor = std::sqrt(scatter.along_chi2 / scatter.along_dof);
  floor.across_factor = std::sqrt(scatter.across_chi2 / scatter.across_dof);
  floor.noise.range_fixed *= floor.along_factor;
  floor.noise.range_per_m *= floor.along_factor;
  floor.noise.angle_fixed *= floor.across_factor;
  floor.noise.angle_per_m *= floor.across_factor;
  floor.degrees = scatter.along_dof + scatter.across_dof;
  floor.source = fmt::format(
      "repeats ({} degrees of freedom), {:.2f} of the declared noise along the beam, {:.2f} across",
      scatter.along_dof + scatter.across_dof, floor.along_factor, floor.across_factor);
  return floor;
}

GapStart gapStart(const Campaign& campaign, bool take_off_station) {
  GapStart start;
  start.campaign = screenReadings(campaign).campaign;
  std::optional<TrackerNoise> declared;
  if (campaign.tracker) declared = trackerNoise(*campaign.tracker);
  start.station = stationCourse(start.campaign, declared);
  const bool moved =
      start.station.course == StationCourse::jumped || start.station.course == StationCourse::drifted;
  if (start.station.course == StationCourse::drifted) spreadSweepTimes(start.station.motion, start.campaign);
  if (moved && take_off_station) takeOffDrift(start.station.motion, start.campaign);
  start.campaign.nests.reset();  // they have said what they know
  start.noise = noiseFloor(start.campaign);
  const SettledDay day = settleDay(start.campaign);
  start.geometry = day.arm.geometry;
  start.absolute = start.campaign.loading && start.geometry.r0_from_loading.has_value();
  // A sag that is not known would be taken for geometry, frames and springs.
  if (!start.geometry.weight.links_known) start.absolute = false;
  start.sweeps = start.absolute && day.frames.arm.points_placed && sameFrame(start.campaign);
  LoadedArm arm = day.arm;
  if (start.campaign.loading && !start.geometry.r0_from_loading) {
    const GeometryCalibration calibration = calibrateGeometry(start.campaign, start.geometry);
    start.absolute = calibration.done && start.geometry.weight.links_known;
    if (!calibration.done) {
      start.reason = "the readings cannot be brought into the robot's frame: " + calibration.reason;
      return start;
    }
    start.geometry = calibration.geometry;
    arm = loadedArm(start.campaign, start.geometry, day.frames.wrist, {*heaviestStep(start.campaign)});
  }
  if (arm.cases.empty()) {
    start.reason =
        "no posture has readings unloaded and under load that can be brought into the robot's frame";
    return start;
  }
  const Vector6d compliance = startCompliance(start.campaign, arm);
  start.geometric_stiffness_share = geometricStiffnessShare(arm, compliance);
  if (start.geometry.weight.links_known) start.geometry.compliance = compliance;
  start.state = startState(start.campaign, start.geometry, arm.cases);
  start.state.at.compliance = compliance;
  if (!start.noise.known)
    start.reason = start.noise.source + ": effects cannot be told from noise; state `tracker`";
  return start;
}

}  // namespace stiffscope
