#include <algorithm>
#include <map>
#include <set>

#include "core/audit/checks.h"
#include "core/audit/rows.h"

namespace stiffscope {

namespace {

/// The value that comes up most often; the larger of two that do.
int mostCommon(const std::map<int, int>& counts) {
  int best = 0, most = 0;
  for (const auto& [value, count] : counts) {
    if (count >= most) most = count, best = value;
  }
  return best;
}

class Inventory {
 public:
  explicit Inventory(const Campaign& campaign) : campaign_(campaign) {
    if (campaign.loading) {
      for (const LoadingReading& row : campaign.loading->rows) add(row.pose, row.step, row.target);
    } else {
      for (const Displacement& row : campaign.displacements->rows) add(row.pose, row.step, row.target);
    }
    for (const State& state : campaign.states->rows) states_.insert({state.pose, state.step});
    std::map<int, int> repeats;
    for (const auto& [pose, steps] : readings_) {
      for (const auto& [step, targets] : steps) {
        ++poses_with_[step];
        for (const auto& [target, count] : targets) ++repeats[count], targets_.insert(target);
      }
    }
    repeats_ = mostCommon(repeats);
  }

  std::vector<std::string> missing() const {
    std::vector<std::string> found;
    for (const auto& [pose, steps] : readings_) {
      for (const auto& [step, count] : poses_with_) {
        const auto has = steps.find(step);
        const std::string name = fmt::format("pose {}, step {}", poseName(campaign_, pose), step);
        if (has == steps.end()) {
          // A step that only some postures have is a choice, not a gap.
          if (2 * count > static_cast<int>(readings_.size())) found.push_back(name + ": no readings");
          continue;
        }
        describeState(name, has->second, found);
        if (!states_.contains({pose, step})) found.push_back(name + ": no row in states");
      }
    }
    for (std::size_t pose = 0; pose < campaign_.pose_ids.size(); ++pose) {
      if (!readings_.contains(static_cast<int>(pose))) {
        found.push_back(fmt::format("pose {}: no readings", campaign_.pose_ids[pose]));
      }
    }
    return found;
  }

  std::size_t size() const { return readings_.size(); }

 private:
  void add(int pose, int step, int target) { ++readings_[pose][step][target]; }

  void describeState(const std::string& name, const std::map<int, int>& targets,
                     std::vector<std::string>& found) const {
    for (const int target : targets_) {
      const auto has = targets.find(target);
      const int count = has == targets.end() ? 0 : has->second;
      if (count >= repeats_) continue;
      found.push_back(
          fmt::format("{}: {} of {} readings of {}", name, count, repeats_, targetName(campaign_, target)));
    }
  }

  const Campaign& campaign_;
  std::map<int, std::map<int, std::map<int, int>>> readings_;  ///< pose, step, target: count
  std::set<std::pair<int, int>> states_;
  std::map<int, int> poses_with_;  ///< by step
  std::set<int> targets_;
  int repeats_ = 0;
};

}  // namespace

Findings checkCompleteness(const Evidence& evidence) {
  const Campaign& campaign = evidence.campaign;
  if (!campaign.states || (!campaign.loading && !campaign.displacements)) {
    return {notTestable("completeness", "no load states: measure `states` with `loading`")};
  }
  const Inventory inventory(campaign);
  const std::vector<std::string> missing = inventory.missing();
  AuditCheck check;
  check.id = "completeness";
  check.value = static_cast<double>(missing.size());
  check.limit = 0.0;
  check.unit = "gaps";
  check.limit_source = "what most postures and states of this campaign have";
  check.message =
      fmt::format("every one of {} postures has all steps, reflectors and repeats", inventory.size());
  if (missing.empty()) return {check};
  check.verdict = AuditVerdict::warn;
  check.where = missing.front().substr(0, missing.front().find(':'));
  constexpr std::size_t kShown = 8;
  const std::vector<std::string> shown(
      missing.begin(), missing.begin() + static_cast<std::ptrdiff_t>(std::min(kShown, missing.size())));
  check.message =
      fmt::format("missing: {}{}", fmt::join(shown, "; "),
                  missing.size() > kShown ? fmt::format("; and {} more", missing.size() - kShown) : "");
  return {check};
}

}  // namespace stiffscope
