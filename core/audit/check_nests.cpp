#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/audit/checks.h"
#include "core/audit/remarks.h"
#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"
#include "core/preparation/remarks.h"

namespace stiffscope::audit {

namespace {

/// Two nests whose reflectors would stand in each other; of coordinates in metres that pass for millimetres all do.
std::optional<Remark> nestsTooNear(const campaign::Campaign& campaign) {
  constexpr double kSmallestReflector = 12.7e-3;         // m, across
  std::map<std::pair<int, int>, Eigen::Vector3d> first;  // by station and nest
  for (const campaign::NestReading& row : campaign.nests->rows) {
    const auto [place, added] = first.try_emplace({row.station, row.nest}, row.point);
    if (!added) continue;
    for (const auto& [key, point] : first) {
      const double apart = (point - row.point).norm();
      if (key.first != row.station || key.second == row.nest || apart >= kSmallestReflector) continue;
      return Remark(RemarkId::nests_too_near, campaign.nest_ids[static_cast<std::size_t>(key.second)],
                    campaign.nest_ids[static_cast<std::size_t>(row.nest)], apart);
    }
  }
  return std::nullopt;
}

/// `station`: tested.
preparation::AuditCheck driftCheck(const AuditInput& input, const preparation::StationMotion& station) {
  const auto worst = std::max_element(station.epochs.begin(), station.epochs.end(),
                                      [&](const preparation::StationEpoch& a, const preparation::StationEpoch& b) {
                                        return station.significance(a) < station.significance(b);
                                      });
  const Eigen::Vector3d displacement = worst->motion.tail<3>();
  const double sigmas = std::sqrt(station.significance(*worst));
  preparation::AuditCheck check;
  check.id = "station_drift";
  check.value = displacement.norm();
  // What noise alone could show in the direction in which the station went.
  check.limit = sigmas > 0.0
                    ? *check.value * std::sqrt(station.moved_limit) / sigmas
                    : std::sqrt(station.moved_limit * worst->covariance.bottomRightCorner<3, 3>().trace() / 3.0);
  check.limit_source = preparation::byChance(Remark(LimitId::chi_square_of_displacement));
  const auto says = [&](std::vector<Remark> more) {
    return Remark(RemarkId::station_moved, *check.value, worst->motion.head<3>().norm(), worst->time_s,
                  std::move(more));
  };
  check.message = says({});
  if (!station.moved) return check;
  const double reading_variance = input.noise->covarianceAt(station.centre).trace();
  check.verdict = displacement.squaredNorm() > preparation::kFailVarianceRatio * reading_variance
                      ? preparation::AuditVerdict::fail
                      : preparation::AuditVerdict::warn;
  check.where = Remark(RemarkId::at_time, worst->time_s);
  std::vector<double> jumps;
  for (const preparation::StationEpoch& epoch : station.epochs) {
    if (epoch.jumped_at) jumps.push_back(*epoch.jumped_at);
  }
  constexpr double kMinute = 60.0;
  const double duration = std::max(kMinute, worst->time_s - station.epochs.front().time_s);
  check.message = says({jumps.empty() ? Remark(RemarkId::station_drifts, *check.value, duration)
                                      : Remark(RemarkId::station_jumps, jumps),
                        input.drift.taken_off ? Remark(RemarkId::motion_taken_off)
                                              : Remark(RemarkId::motion_not_taken_off, input.drift.reason)});
  return check;
}

preparation::AuditCheck nestCheck(const AuditInput& input) {
  const preparation::StationMotion& station = input.station;
  if (station.deformation_dof <= 0) {
    return preparation::notTestable("nest_moved", Remark(MissingId::few_nests_or_rounds));
  }
  preparation::AuditCheck check;
  check.id = "nest_moved";
  check.value = std::sqrt(station.deformation_chi2 / station.deformation_dof);
  check.limit = std::sqrt(station.deformation_limit / station.deformation_dof);
  check.limit_source = preparation::byChance(Remark(LimitId::chi_square, station.deformation_dof));
  const auto says = [&check](std::vector<Remark> more) {
    return Remark(RemarkId::nests_left, *check.value, std::move(more));
  };
  check.message = says({});
  if (*check.value <= *check.limit) return check;
  check.verdict = preparation::AuditVerdict::warn;
  if (station.moved_nest) {
    const std::string& name = input.campaign.nest_ids[static_cast<std::size_t>(*station.moved_nest)];
    check.where = station.moved_nest_line > 0 ? preparation::atRow(input.campaign.nests->file, station.moved_nest_line)
                                              : Remark(preparation::RemarkId::at_name, name);
    check.message = says({Remark(RemarkId::nest_moved, name, station.moved_nest_by)});
  } else {
    check.verdict = preparation::AuditVerdict::fail;
    check.message = says({Remark(RemarkId::nests_not_mended)});
  }
  return check;
}

/// Of each station that tells, else why none does.
Findings driftChecks(const AuditInput& input) {
  Findings findings;
  Remark why;
  for (std::size_t s = 0; s < input.stations->courses.size(); ++s) {
    const preparation::StationMotion& rounds = input.stations->courses[s].rounds;
    if (!rounds.tested) {
      why = rounds.reason;
      continue;
    }
    findings.push_back(driftCheck(input, rounds));
    findings.back().message =
        Remark(RemarkId::of_station, preparation::shownStation(input.campaign.stations[s]), findings.back().message);
  }
  if (findings.empty()) findings.push_back(preparation::notTestable("station_drift", why));
  return findings;
}

/// The network by which the stations were joined: whether the nests keep their shape from one to the other.
preparation::AuditCheck stationsCheck(const AuditInput& input) {
  const preparation::StationNetwork& network = input.stations->network;
  preparation::AuditCheck check;
  check.id = preparation::kStationsAgree;
  for (std::size_t s = 0; s < network.stations.size(); ++s) {
    const preparation::PoseUncertainty known = preparation::poseUncertainty(network.stations[s]);
    if (s == 0) continue;
    check.details.push_back(Remark(RemarkId::station_at_arm, preparation::shownStation(input.campaign.stations[s]),
                                   network.stations[s].common_nests, known.position, known.turn));
  }
  if (network.dof <= 0) {
    check.verdict = preparation::AuditVerdict::not_testable;
    check.message = Remark(MissingId::no_nest_to_spare);
    return check;
  }
  check.value = std::sqrt(network.chi2 / network.dof);
  check.limit = std::sqrt(network.limit / network.dof);
  check.limit_source = preparation::byChance(Remark(LimitId::chi_square, network.dof));
  std::vector<Remark> more;
  for (const preparation::OutlyingNest& apart : network.outlying) {
    const std::string& nest = input.campaign.nest_ids[static_cast<std::size_t>(apart.nest)];
    const std::string station = preparation::shownStation(input.campaign.stations[apart.station]);
    check.verdict = preparation::AuditVerdict::warn;
    if (apart.line) {
      check.where = preparation::atRow(input.campaign.nests->file, *apart.line);
      more.push_back(Remark(RemarkId::reading_read_apart, *apart.line, nest, station, apart.by));
    } else {
      check.where = Remark(preparation::RemarkId::at_name, nest);
      more.push_back(Remark(RemarkId::nest_read_apart, nest, station, apart.by));
    }
  }
  if (!network.consistent()) {
    check.verdict = preparation::AuditVerdict::fail;
    more.push_back(Remark(RemarkId::stations_not_mended));
  }
  check.message = Remark(RemarkId::stations_left, *check.value, std::move(more));
  return check;
}

Findings ofMotion(const AuditInput& input) {
  if (input.stations) {
    Findings findings = driftChecks(input);
    findings.push_back(input.station.tested ? nestCheck(input)
                                            : preparation::notTestable("nest_moved", input.station.reason));
    findings.push_back(stationsCheck(input));
    return findings;
  }
  if (!input.station.tested) {
    return {preparation::notTestable("station_drift", input.station.reason),
            preparation::notTestable("nest_moved", input.station.reason)};
  }
  return {driftCheck(input, input.station), nestCheck(input)};
}

}  // namespace

Findings checkNests(const AuditInput& input) {
  Findings findings = ofMotion(input);
  if (!input.campaign.nests) return findings;
  const std::optional<Remark> near = nestsTooNear(input.campaign);
  if (!near) return findings;
  for (preparation::AuditCheck& check : findings) {
    if (check.id != "nest_moved") continue;
    check.verdict = preparation::AuditVerdict::fail;
    check.message = *near;
    // How far they scatter says nothing then.
    check.value = check.limit = std::nullopt;
    check.limit_source = {};
  }
  return findings;
}

}  // namespace stiffscope::audit
