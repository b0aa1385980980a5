#include <algorithm>
#include <cmath>

#include "core/audit/checks.h"
#include "core/campaign/row_names.h"
#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"

namespace stiffscope::audit {

namespace {

preparation::AuditCheck driftCheck(const AuditInput& input) {
  const preparation::StationMotion& station = input.station;
  const auto worst = std::max_element(station.epochs.begin(), station.epochs.end(),
                                      [&](const preparation::StationEpoch& a, const preparation::StationEpoch& b) {
                                        return station.significance(a) < station.significance(b);
                                      });
  const Eigen::Vector3d displacement = worst->motion.tail<3>();
  const double sigmas = std::sqrt(station.significance(*worst));
  preparation::AuditCheck check;
  check.id = "station_drift";
  check.value = 1e6 * displacement.norm();
  // What noise alone could show in the direction in which the station went.
  check.limit = sigmas > 0.0
                    ? *check.value * std::sqrt(station.moved_limit) / sigmas
                    : 1e6 * std::sqrt(station.moved_limit * worst->covariance.bottomRightCorner<3, 3>().trace() / 3.0);
  check.unit = "um";
  check.limit_source =
      preparation::byChance("chi-square of the displacement where the arm stands, by the nests' declared noise");
  check.message =
      fmt::format("at the arm the station moved by {:.0f} um and turned by {:.1f} urad at most, at {:.0f} s",
                  *check.value, 1e6 * worst->motion.head<3>().norm(), worst->time_s);
  if (!station.moved) return check;
  const double reading_variance = input.noise->covarianceAt(station.centre).trace();
  check.verdict = displacement.squaredNorm() > preparation::kFailVarianceRatio * reading_variance
                      ? preparation::AuditVerdict::fail
                      : preparation::AuditVerdict::warn;
  check.where = fmt::format("{:.0f} s", worst->time_s);
  std::string jumps;
  for (const preparation::StationEpoch& epoch : station.epochs) {
    if (epoch.jumped_at) jumps += fmt::format("{}{:.0f} s", jumps.empty() ? "" : ", ", *epoch.jumped_at);
  }
  const double minutes = std::max(1.0, (worst->time_s - station.epochs.front().time_s) / 60.0);
  check.message += jumps.empty() ? fmt::format("; a drift of {:.2f} um/min on average", *check.value / minutes)
                                 : fmt::format("; it jumped at about {}: the tracker was moved", jumps);
  check.message += input.drift.taken_off
                       ? "; readings with a time are referred to the first round, here and in identification"
                       : "; not taken off the readings: " + input.drift.reason;
  return check;
}

preparation::AuditCheck nestCheck(const AuditInput& input) {
  const preparation::StationMotion& station = input.station;
  if (station.deformation_dof <= 0) {
    return preparation::notTestable("nest_moved",
                                    "too few nests or rounds to tell a moving nest from the station: measure four");
  }
  preparation::AuditCheck check;
  check.id = "nest_moved";
  check.value = std::sqrt(station.deformation_chi2 / station.deformation_dof);
  check.limit = std::sqrt(station.deformation_limit / station.deformation_dof);
  check.unit = "of noise sd";
  check.limit_source =
      preparation::byChance(fmt::format("chi-square of {} degrees of freedom", station.deformation_dof));
  check.message = fmt::format("what no motion of the station explains is {:.2f} of the noise", *check.value);
  if (*check.value <= *check.limit) return check;
  check.verdict = preparation::AuditVerdict::warn;
  if (station.moved_nest) {
    const std::string& name = input.campaign.nest_ids[static_cast<std::size_t>(*station.moved_nest)];
    check.where =
        station.moved_nest_line > 0 ? campaign::rowName(input.campaign.nests->file, station.moved_nest_line) : name;
    check.message += fmt::format(
        "; nest {} moved by up to {:.0f} um against the others and is left out of the station's "
        "motion",
        name, 1e6 * station.moved_nest_by);
  } else {
    check.verdict = preparation::AuditVerdict::fail;
    check.message += "; leaving out any one nest does not mend it: more than one moved, or the readings are wrong";
  }
  return check;
}

}  // namespace

Findings checkNests(const AuditInput& input) {
  if (!input.station.tested) {
    return {preparation::notTestable("station_drift", input.station.reason),
            preparation::notTestable("nest_moved", input.station.reason)};
  }
  return {driftCheck(input), nestCheck(input)};
}

}  // namespace stiffscope::audit
