#include "core/preparation/prepare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/campaign/row_names.h"
#include "core/frames/joint_axes.h"
#include "core/io/input_error.h"
#include "core/numerics/parallel.h"
#include "core/preparation/drift_nests.h"
#include "core/preparation/nest_network.h"
#include "core/preparation/remarks.h"
#include "core/preparation/repeatability.h"

namespace stiffscope::preparation {

namespace {

void dropRejected(const std::vector<RejectedReading>& rejected, campaign::Campaign& campaign) {
  if (rejected.empty()) return;
  std::map<std::string, std::set<std::size_t>> lines;
  for (const RejectedReading& reading : rejected) lines[reading.file].insert(reading.line);
  campaign::forEachPointTable(campaign, [&](auto& table) {
    const auto found = lines.find(table.file);
    if (found == lines.end()) return;
    std::erase_if(table.rows, [&](const auto& row) { return found->second.contains(row.line); });
  });
  // A table whose every reading was rejected is a measurement that the day did not produce.
  if (campaign.circle_sweeps && campaign.circle_sweeps->rows.empty()) campaign.circle_sweeps.reset();
  if (campaign.wrist_sweep && campaign.wrist_sweep->rows.empty()) campaign.wrist_sweep.reset();
  if (campaign.rail_sweep && campaign.rail_sweep->rows.empty()) campaign.rail_sweep.reset();
  if (campaign.loading && campaign.loading->rows.empty()) campaign.loading.reset();
  if (campaign.nests && campaign.nests->rows.empty()) campaign.nests.reset();
}

std::vector<RejectedReading> lostBeams(const campaign::Campaign& campaign) {
  std::vector<RejectedReading> found;
  campaign::forEachPointTable(campaign, [&](const auto& table) {
    for (const auto& row : table.rows) {
      if (row.point.isZero(0.0)) found.push_back({table.file, row.line, Remark(RemarkId::beam_lost)});
    }
  });
  return found;
}

AuditCheck countCheck(const std::string& id, const std::vector<RejectedReading>& found, AuditVerdict verdict,
                      RemarkId what, Remark source) {
  AuditCheck check;
  check.id = id;
  check.value = static_cast<double>(found.size());
  check.limit = 0.0;
  check.limit_source = std::move(source);
  check.message = found.empty() ? Remark(RemarkId::no_such_readings) : Remark(what, found.size());
  if (found.empty()) return check;
  check.verdict = verdict;
  check.where = atRow(found.front().file, found.front().line);
  return check;
}

/// A campaign without the readings that should not be used, and the checks that found them.
struct Screening {
  campaign::Campaign campaign;
  std::vector<RejectedReading> rejected;
  std::vector<AuditCheck> checks;        ///< lost_beam, duplicate_readings, repeat_outliers, nest_outliers
  std::optional<RepeatScatter> scatter;  ///< of the readings that are left, where no repeat was rejected
};

/// Takes out, one kind after the other: points at exactly (0, 0, 0), which a tracker writes when it has lost
/// its beam; points that repeat another's coordinates to the last digit, which is the other reading copied or
/// the beam still on the other reflector; repeats of one state that stand apart from the others by more
/// than noise; and single readings of floor nests that the other nests contradict (core/preparation/nest_network.h).
Screening screenReadings(campaign::Campaign campaign, const Rounded& rounded) {
  Screening result{std::move(campaign), {}, {}, {}};
  const auto screen = [&](const std::string& id, AuditVerdict verdict, const std::vector<RejectedReading>& found,
                          RemarkId what, const Remark& source) {
    result.checks.push_back(countCheck(id, found, verdict, what, source));
    result.rejected.insert(result.rejected.end(), found.begin(), found.end());
    dropRejected(found, result.campaign);
  };
  bool any_points = false;
  campaign::forEachPointTable(result.campaign, [&](const auto&) { any_points = true; });
  if (!any_points) {
    for (const char* id : {"lost_beam", "duplicate_readings", "repeat_outliers", "nest_outliers"}) {
      result.checks.push_back(notTestable(id, Remark(RemarkId::no_point_readings)));
    }
    return result;
  }
  screen("lost_beam", AuditVerdict::fail, lostBeams(result.campaign), RemarkId::readings_at_zero,
         Remark(RemarkId::nothing_inside_station));
  // What each finds, while none before it rejects a reading: three searches at the same time.
  std::vector<RejectedReading> same;
  RepeatScatter scatter;
  NestOutliers nests;
  numerics::onAllCores(3, [&](std::size_t part) {
    if (part == 0) scatter = repeatScatter(result.campaign, rounded);
    if (part == 1) same = duplicateReadings(result.campaign);
    if (part == 2) nests = nestOutliers(result.campaign);
  });
  screen("duplicate_readings", AuditVerdict::warn, same, RemarkId::readings_repeated,
         Remark(RemarkId::no_chance_of_same_digits));
  if (!same.empty()) scatter = repeatScatter(result.campaign, rounded);
  if (scatter.tested) {
    screen("repeat_outliers", AuditVerdict::warn, scatter.outliers, RemarkId::repeats_stand_apart,
           byChance(Remark(RemarkId::chi_square_of_repeat)));
  } else {
    result.checks.push_back(notTestable("repeat_outliers", scatter.reason));
  }
  if (!same.empty() || !scatter.outliers.empty()) nests = nestOutliers(result.campaign);
  if (scatter.outliers.empty()) result.scatter = std::move(scatter);
  if (!nests.tested) {
    result.checks.push_back(notTestable("nest_outliers", nests.reason));
    return result;
  }
  screen("nest_outliers", AuditVerdict::warn, nests.readings, RemarkId::nests_stand_apart,
         byChance(Remark(RemarkId::chi_square_of_nest_reading)));
  if (nests.rounds_of_three > 0)
    result.checks.back().details.push_back(Remark(RemarkId::rounds_of_few_nests, nests.rounds_of_three, nests.rounds));
  return result;
}

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
  const auto rowsOf = [](const auto& table) { return table ? table->rows.size() : 0; };
  const std::size_t count = rowsOf(campaign.circle_sweeps) + rowsOf(campaign.wrist_sweep) + rowsOf(campaign.rail_sweep);
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
  if (campaign.rail_sweep) spread(*campaign.rail_sweep);
  return without_time;
}

void countReadings(const campaign::Campaign& campaign, DriftCorrection& drift) {
  forEachDriftingTable(campaign, [&](const auto& table) {
    for (const auto& row : table.rows) ++(std::isfinite(row.time_s) ? drift.readings : drift.without_time);
  });
}

/// A motion that is taken off, beside those of other stations.
void addTakenOff(const StationMotion& motion, DriftCorrection& drift) {
  const double until_s = motion.epochs.back().time_s;
  drift.until_s = drift.taken_off ? std::max(drift.until_s, until_s) : until_s;
  drift.taken_off = true;
  for (const StationEpoch& epoch : motion.epochs) {
    drift.displacement = std::max(drift.displacement, epoch.motion.tail<3>().norm());
    drift.turn = std::max(drift.turn, epoch.motion.head<3>().norm());
    if (epoch.jumped_at) drift.jumps_s.push_back(*epoch.jumped_at);
  }
}

DriftCorrection correctDrift(const DriftModel& station, campaign::Campaign& campaign) {
  DriftCorrection drift;
  drift.reason = whyNot(station);
  if (!drift.reason.empty()) return drift;
  addTakenOff(station.motion, drift);
  if (station.course == StationCourse::drifted) drift.spread = spreadSweepTimes(station.motion, campaign);
  countReadings(campaign, drift);
  applyDriftCorrection(station.motion, campaign);
  return drift;
}

void standOnCarriage(PreparedCampaign& prepared) {
  if (!prepared.campaign.robot.rail) return;
  const bool known = declaredNoise(prepared.campaign).has_value();
  prepared.rail = fitRailCourse(prepared.campaign,
                                known ? std::optional(frames::trackerNoise(*prepared.campaign.tracker)) : std::nullopt);
  referToCarriageAtZero(prepared.rail, prepared.campaign);
}

/// What each station did, as one.
DriftCorrection driftOf(const JoinedStations& stations, const campaign::Campaign& campaign) {
  DriftCorrection drift;
  for (const DriftModel& course : stations.courses) {
    if (!course.moved()) {
      if (drift.reason.empty()) drift.reason = whyNot(course);
      continue;
    }
    addTakenOff(course.motion, drift);
  }
  if (!drift.taken_off) return drift;
  drift.reason = {};
  forEachDriftingTable(campaign, [&](const auto& table) {
    for (const auto& row : table.rows) {
      if (!stations.courses[static_cast<std::size_t>(row.station)].moved()) continue;
      ++(std::isfinite(row.time_s) ? drift.readings : drift.without_time);
    }
  });
  return drift;
}

/// What is left of the stations' motion once each one's own is taken off and they are joined. More than noise is
/// nests that moved between them, which no motion of a station takes off.
DriftModel leftOfStations(const campaign::Campaign& joined, const metrology::TrackerNoise& noise) {
  DriftModel left = stationCourse(joined, noise);
  if (!left.moved()) return left;
  left.course = StationCourse::not_tested;
  left.remark = Remark(RemarkId::stations_disagree);
  return left;
}

/// Throws InputError where the day has several stations and no noise that says how their nests weigh.
metrology::TrackerNoise noiseForStations(const campaign::Campaign& campaign, const NoiseFactors& factors) {
  if (!declaredNoise(campaign)) {
    throw io::InputError({(campaign.folder / "campaign.xml").string(), 0, "tracker"}, "",
                         "expected a tracker with its noise: nests join stations by it");
  }
  return frames::trackerNoise(asNoisyAs(*campaign.tracker, factors));
}

/// The stations joined and each one's motion taken off.
void prepareStations(const NoiseFactors& of_nests, PreparedCampaign& prepared) {
  const metrology::TrackerNoise noise = noiseForStations(prepared.campaign, of_nests);
  constexpr bool kAsDrifted = false;
  prepared.preparation.stations = joinStations(noise, kAsDrifted, prepared.campaign);
  prepared.preparation.drift = driftOf(*prepared.preparation.stations, prepared.campaign);
  prepared.drift = leftOfStations(prepared.campaign, noise);
}

/// The motions of stations that were taken off, by station.
std::vector<StationMotion> takenOff(const JoinedStations& stations) {
  std::vector<StationMotion> motions;
  for (const DriftModel& course : stations.courses) motions.push_back(course.moved() ? course.motion : StationMotion());
  return motions;
}

}  // namespace

PreparedCampaign prepareCampaign(campaign::Campaign read) {
  const Rounding rounding = roundingOf(read);
  Screening screening = screenReadings(std::move(read), rounding.arm);
  PreparedCampaign prepared;
  prepared.campaign = std::move(screening.campaign);
  prepared.screening = std::move(screening.checks);
  prepared.preparation.rejected = std::move(screening.rejected);
  const std::optional<campaign::Tracker> declared = prepared.preparation.declared = prepared.campaign.tracker;
  const bool known = declaredNoise(prepared.campaign).has_value();
  prepared.scatter = screening.scatter ? *std::move(screening.scatter) : repeatScatter(prepared.campaign, rounding.arm);
  const NoiseFactors of_nests = rounding.nests.factors * noiseFactors(prepared.scatter);
  if (hasStations(prepared.campaign)) {
    prepareStations(of_nests, prepared);
  } else {
    prepared.drift = stationCourse(
        prepared.campaign, known ? std::optional(frames::trackerNoise(asNoisyAs(*declared, of_nests))) : std::nullopt);
    prepared.preparation.drift = correctDrift(prepared.drift, prepared.campaign);
  }
  // A drift that goes on between repeats is no scatter of the instrument.
  if (prepared.preparation.drift.taken_off) prepared.scatter = repeatScatter(prepared.campaign, rounding.arm);
  prepared.noise = noiseModel(prepared.campaign, prepared.scatter, rounding.arm);
  if (known) prepared.campaign.tracker = asNoisyAs(*declared, rounding.arm.factors * noiseFactors(prepared.scatter));
  // Last, because the noise of a reading is by where the reflector was seen, and the nests are not on the rail.
  standOnCarriage(prepared);
  return prepared;
}

PreparedCampaign asMeasured(PreparedCampaign prepared) {
  if (!prepared.preparation.drift.taken_off) return prepared;
  // A station that turned moved readings by where they were read, metres along the rail from where they are referred
  // to.
  referToWhereItStood(prepared.rail, prepared.campaign);
  if (prepared.preparation.stations) {
    putBackDrift(takenOff(*prepared.preparation.stations), prepared.campaign);
  } else {
    putBackDrift(prepared.drift.motion, prepared.campaign);
  }
  referToCarriageAtZero(prepared.rail, prepared.campaign);
  prepared.preparation.drift = {};
  prepared.preparation.drift.reason = Remark(RemarkId::as_measured_asked_for);
  return prepared;
}

PreparedCampaign leaveRaw(campaign::Campaign read) {
  PreparedCampaign prepared;
  prepared.campaign = std::move(read);
  prepared.preparation.raw = true;
  prepared.preparation.declared = prepared.campaign.tracker;
  const Rounding rounding = roundingOf(prepared.campaign);
  if (hasStations(prepared.campaign)) {
    constexpr bool kAsDrifted = true;
    prepared.preparation.stations =
        joinStations(noiseForStations(prepared.campaign, rounding.nests.factors), kAsDrifted, prepared.campaign);
  }
  prepared.noise = noiseModel(prepared.campaign, repeatScatter(prepared.campaign, rounding.arm), rounding.arm);
  prepared.preparation.drift.reason = Remark(RemarkId::raw_asked_for);
  standOnCarriage(prepared);
  return prepared;
}

}  // namespace stiffscope::preparation
