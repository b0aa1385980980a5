#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "core/comparison/matched_postures.h"
#include "core/fleet/fleet.h"

namespace stiffscope::fleet {

namespace {

robot::ArmAxes axesOf(const CampaignResult& day) { return {day.axes.begin(), day.axes.end()}; }

/// Why `compare` would refuse two campaigns as of different machines; empty where it would not.
Remark differenceOfArms(const CampaignResult& before, const CampaignResult& after) {
  if (before.joints() != after.joints())
    return Remark(comparison::RemarkId::other_joint_count, before.joints(), after.joints());
  robot::Robot first, second;
  first.axes_in_base_at_zero = axesOf(before), second.axes_in_base_at_zero = axesOf(after);
  return comparison::differenceOfMachines(first, second);
}

bool sameDescription(const CampaignResult& one, const CampaignResult& other) {
  return one.joints() == other.joints() &&
         std::equal(one.axes.begin(), one.axes.end(), other.axes.begin(), other.axes.end(),
                    [](const auto& a, const auto& b) { return a.point == b.point && a.direction == b.direction; });
}

/// An arm as it grows by one campaign after another.
struct GrowingArm {
  Arm arm;
  /// One of each description. Axes may be a little elsewhere in one than in another: every one has to fit.
  std::vector<std::size_t> descriptions;

  void add(const std::vector<FleetCampaign>& campaigns, std::size_t place) {
    arm.campaigns.push_back(place);
    const bool known = std::any_of(descriptions.begin(), descriptions.end(), [&](std::size_t one) {
      return sameDescription(*campaigns[one].result, *campaigns[place].result);
    });
    if (!known) descriptions.push_back(place);
  }
};

/// Of the first description that a campaign cannot be beside, with its place; empty where it is of this arm.
std::pair<Remark, std::size_t> refusal(const std::vector<FleetCampaign>& campaigns, const GrowingArm& arm,
                                       std::size_t place) {
  for (const std::size_t one : arm.descriptions) {
    Remark difference = differenceOfArms(*campaigns[one].result, *campaigns[place].result);
    if (!difference.empty()) return {std::move(difference), one};
  }
  return {};
}

}  // namespace

std::vector<Arm> armsOf(const std::vector<FleetCampaign>& campaigns) {
  std::vector<GrowingArm> arms;
  std::size_t first = 0;  // of the arms under the name that the campaign has
  for (std::size_t i = 0; i < campaigns.size(); ++i) {
    if (!campaigns[i].result) continue;
    if (!arms.empty() && arms.back().arm.machine != campaigns[i].machine) first = arms.size();
    GrowingArm fresh;
    fresh.arm.machine = campaigns[i].machine;
    std::size_t found = first;
    for (; found < arms.size(); ++found) {
      auto [difference, other] = refusal(campaigns, arms[found], i);
      if (difference.empty()) break;
      if (found == first) fresh.arm.difference = std::move(difference), fresh.arm.differs_from = other;
    }
    if (found == arms.size()) arms.push_back(std::move(fresh));
    arms[found].add(campaigns, i);
  }
  std::vector<Arm> all;
  for (GrowingArm& one : arms) all.push_back(std::move(one.arm));
  return all;
}

std::vector<DaySeries> seriesOf(const std::vector<FleetCampaign>& campaigns) {
  std::map<std::tuple<std::string, DayKind, campaign::DoubleEncoder, std::size_t>, DaySeries> series;
  const std::vector<Arm> arms = armsOf(campaigns);
  for (std::size_t arm = 0; arm < arms.size(); ++arm) {
    for (const std::size_t i : arms[arm].campaigns) {
      const CampaignResult& result = *campaigns[i].result;
      if (result.kind == DayKind::sweeps) continue;
      DaySeries& own = series[{arms[arm].machine, result.kind, result.encoders, arm}];
      own.machine = arms[arm].machine, own.arm = arm, own.kind = result.kind, own.encoders = result.encoders;
      own.joints = result.joints();
      own.campaigns.push_back(i);
    }
  }
  std::vector<DaySeries> all;
  for (auto& [key, one] : series) all.push_back(std::move(one));
  return all;
}

std::vector<FleetPair> pairsOf(const std::vector<DaySeries>& series) {
  std::vector<FleetPair> pairs;
  for (const DaySeries& one : series) {
    for (std::size_t i = 1; i < one.campaigns.size(); ++i) {
      FleetPair pair;
      pair.before = one.campaigns[i - 1], pair.after = one.campaigns[i];
      pairs.push_back(pair);
    }
  }
  return pairs;
}

}  // namespace stiffscope::fleet
