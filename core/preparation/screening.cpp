#include "core/preparation/screening.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/campaign/read_table.h"
#include "core/campaign/row_names.h"
#include "core/preparation/finding.h"
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
  if (campaign.loading && campaign.loading->rows.empty()) campaign.loading.reset();
  if (campaign.nests && campaign.nests->rows.empty()) campaign.nests.reset();
}

std::vector<RejectedReading> lostBeams(const campaign::Campaign& campaign) {
  std::vector<RejectedReading> found;
  campaign::forEachPointTable(campaign, [&](const auto& table) {
    for (const auto& row : table.rows) {
      if (row.point.isZero(0.0)) found.push_back({table.file, row.line, "lost beam: the point is (0, 0, 0)"});
    }
  });
  return found;
}

std::vector<RejectedReading> duplicates(const campaign::Campaign& campaign) {
  std::vector<RejectedReading> found;
  campaign::forEachPointTable(campaign, [&](const auto& table) {
    campaign::RepeatCheck seen(table.rows.size());
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const auto& row = table.rows[i];
      campaign::KeyHash place;
      for (const double coordinate : row.point) place.add(coordinate);
      const std::size_t first =
          seen.add(i, place, [&](std::size_t other) { return table.rows[other].point == row.point; });
      if (first == campaign::RepeatCheck::kNew) continue;
      found.push_back(
          {table.file, row.line, fmt::format("the same point to the last digit as line {}", table.rows[first].line)});
    }
  });
  return found;
}

AuditCheck countCheck(const std::string& id, const std::vector<RejectedReading>& found, AuditVerdict verdict,
                      const std::string& what, const std::string& source) {
  AuditCheck check;
  check.id = id;
  check.value = static_cast<double>(found.size());
  check.limit = 0.0;
  check.unit = "readings";
  check.limit_source = source;
  check.message = found.empty() ? "none" : fmt::format("{} {}", found.size(), what);
  if (found.empty()) return check;
  check.verdict = verdict;
  check.where = campaign::rowName(found.front().file, found.front().line);
  return check;
}

}  // namespace

Screening screenReadings(campaign::Campaign campaign) {
  Screening result{std::move(campaign), {}, {}};
  const auto screen = [&](const std::string& id, AuditVerdict verdict, const std::vector<RejectedReading>& found,
                          const std::string& what, const std::string& source) {
    result.checks.push_back(countCheck(id, found, verdict, what, source));
    result.rejected.insert(result.rejected.end(), found.begin(), found.end());
    dropRejected(found, result.campaign);
  };
  bool any_points = false;
  campaign::forEachPointTable(result.campaign, [&](const auto&) { any_points = true; });
  if (!any_points) {
    for (const char* id : {"lost_beam", "duplicate_readings", "repeat_outliers"}) {
      AuditCheck check;
      check.id = id;
      check.verdict = AuditVerdict::not_testable;
      check.message = "no readings of points: measure `circle_sweeps`, `wrist_sweep` or `loading`";
      result.checks.push_back(check);
    }
    return result;
  }
  screen("lost_beam", AuditVerdict::fail, lostBeams(result.campaign), "readings at (0, 0, 0): the beam was lost",
         "no reflector stands inside the station");
  screen("duplicate_readings", AuditVerdict::warn, duplicates(result.campaign),
         "readings repeat another's coordinates to the last digit: copied, or the beam still on another "
         "reflector",
         "two readings do not agree to the last digit by chance");
  const RepeatScatter scatter = repeatScatter(result.campaign);
  if (scatter.tested) {
    screen("repeat_outliers", AuditVerdict::warn, scatter.outliers,
           "repeats stand apart from the others of their state",
           byChance("chi-square of a reading against its state's others, three coordinates"));
  } else {
    AuditCheck check;
    check.id = "repeat_outliers";
    check.verdict = AuditVerdict::not_testable;
    check.message = scatter.reason;
    result.checks.push_back(check);
  }
  return result;
}

}  // namespace stiffscope::preparation
