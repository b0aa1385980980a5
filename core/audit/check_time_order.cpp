#include <cmath>
#include <limits>
#include <map>

#include "core/audit/checks.h"
#include "core/audit/rows.h"

namespace stiffscope {

namespace {

struct Span {
  double first = INFINITY, last = -INFINITY;
  std::size_t line = 0;  ///< of its first row
};

/// Rows that come before the last one of an earlier step of their posture.
template <class Row>
std::vector<std::string> outOfOrder(const Campaign& campaign, const Table<Row>& table) {
  std::map<int, std::map<int, Span>> poses;
  for (const Row& row : table.rows) {
    if (!std::isfinite(row.time_s)) continue;
    Span& span = poses[row.pose][row.step];
    if (row.time_s < span.first) span.first = row.time_s, span.line = row.line;
    span.last = std::max(span.last, row.time_s);
  }
  std::vector<std::string> found;
  for (const auto& [pose, steps] : poses) {
    const Span* before = nullptr;
    int step_before = 0;
    for (const auto& [step, span] : steps) {
      if (before != nullptr && span.first < before->last) {
        found.push_back(fmt::format("{} (pose {}: step {} before step {} ends)",
                                    rowName(table.file, span.line), poseName(campaign, pose), step,
                                    step_before));
      }
      before = &span;
      step_before = step;
    }
  }
  return found;
}

/// Load states whose row is older or younger than all readings of another step than its own.
std::vector<std::string> statesApart(const Campaign& campaign) {
  std::map<std::pair<int, int>, Span> readings;
  for (const LoadingReading& row : campaign.loading->rows) {
    Span& span = readings[{row.pose, row.step}];
    span.first = std::min(span.first, row.time_s);
    span.last = std::max(span.last, row.time_s);
  }
  std::vector<std::string> found;
  for (const State& state : campaign.states->rows) {
    const auto own = readings.find({state.pose, state.step});
    if (own == readings.end() || !std::isfinite(state.time_s)) continue;
    const auto end = readings.upper_bound({state.pose, std::numeric_limits<int>::max()});
    for (auto other = readings.lower_bound({state.pose, std::numeric_limits<int>::min()}); other != end; ++other) {
      const auto& [key, span] = *other;
      if (key.second == state.step) continue;
      const bool within = state.time_s > span.first && state.time_s < span.last;
      const bool beyond = (span.first > own->second.last && state.time_s >= span.first) ||
                          (span.last < own->second.first && state.time_s <= span.last);
      if (!within && !beyond) continue;
      found.push_back(fmt::format("{} (pose {}: the state of step {} was taken during step {})",
                                  rowName(campaign.states->file, state.line), poseName(campaign, state.pose),
                                  state.step, key.second));
      break;
    }
  }
  return found;
}

}  // namespace

Findings checkTimeOrder(const Evidence& evidence) {
  const Campaign& campaign = evidence.campaign;
  if (!campaign.states && !campaign.loading)
    return {notTestable("time_order", "no `states` and no `loading`")};
  std::vector<std::string> found;
  if (campaign.loading) found = outOfOrder(campaign, *campaign.loading);
  if (campaign.states) {
    const auto states = outOfOrder(campaign, *campaign.states);
    found.insert(found.end(), states.begin(), states.end());
  }
  if (campaign.loading && campaign.states && found.empty()) found = statesApart(campaign);
  AuditCheck check;
  check.id = "time_order";
  check.value = static_cast<double>(found.size());
  check.limit = 0.0;
  check.unit = "steps";
  check.limit_source = "later steps follow in time (campaign format)";
  check.message = "steps follow each other in time in every posture";
  if (found.empty()) return {check};
  check.verdict = AuditVerdict::fail;
  check.where = found.front().substr(0, found.front().find(' '));
  check.message = fmt::format("steps out of order: {}", fmt::join(found, "; "));
  return {check};
}

}  // namespace stiffscope
