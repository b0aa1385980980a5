#include "core/preparation/screening.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/campaign/read_table.h"
#include "core/campaign/row_names.h"
#include "core/preparation/finding.h"
#include "core/preparation/nest_outliers.h"
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
      found.push_back({table.file, row.line, Remark(RemarkId::same_as_line, table.rows[first].line)});
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

}  // namespace

Screening screenReadings(campaign::Campaign campaign) {
  Screening result{std::move(campaign), {}, {}};
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
  screen("duplicate_readings", AuditVerdict::warn, duplicates(result.campaign), RemarkId::readings_repeated,
         Remark(RemarkId::no_chance_of_same_digits));
  const RepeatScatter scatter = repeatScatter(result.campaign);
  if (scatter.tested) {
    screen("repeat_outliers", AuditVerdict::warn, scatter.outliers, RemarkId::repeats_stand_apart,
           byChance(Remark(RemarkId::chi_square_of_repeat)));
  } else {
    result.checks.push_back(notTestable("repeat_outliers", scatter.reason));
  }
  const NestOutliers nests = nestOutliers(result.campaign);
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

}  // namespace stiffscope::preparation
