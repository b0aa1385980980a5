#include "core/identification/avoided.h"

#include <unordered_map>

#include "core/input/units.h"

namespace stiffscope {

namespace {

bool sameState(const LoadCase& a, const LoadCase& b) {
  constexpr double kSameAngle = 0.01 * kDegree;
  constexpr double kSameForce = 0.02;
  return (a.q - b.q).cwiseAbs().maxCoeff() < kSameAngle &&
         (a.wrench.force - b.wrench.force).norm() < kSameForce * a.wrench.force.norm();
}

}  // namespace

AvoidedDeflection avoidedDeflection(const Campaign& before_campaign, const Identification& before,
                                    const Campaign& after_campaign, const Identification& after) {
  AvoidedDeflection result;
  result.at_wrist = !before.wrist_displacement.empty() && !after.wrist_displacement.empty();
  const auto& before_values = result.at_wrist ? before.wrist_displacement : before.target_displacement;
  const auto& after_values = result.at_wrist ? after.wrist_displacement : after.target_displacement;
  std::unordered_map<std::string, std::size_t> place;
  for (std::size_t i = 0; i < after.cases.size(); ++i) {
    place[after_campaign.pose_ids[static_cast<std::size_t>(after.cases[i].pose)]] = i;
  }
  double before_sum = 0.0, after_sum = 0.0;
  for (std::size_t i = 0; i < before.cases.size(); ++i) {
    const std::string& pose = before_campaign.pose_ids[static_cast<std::size_t>(before.cases[i].pose)];
    const auto same = place.find(pose);
    if (same == place.end() || !sameState(before.cases[i], after.cases[same->second])) continue;
    result.postures.push_back({pose, before_values[i], after_values[same->second]});
    before_sum += result.postures.back().before;
    after_sum += result.postures.back().after;
  }
  if (result.postures.empty()) {
    result.reason = "the two campaigns have no posture in common with the same joint angles and load";
    return result;
  }
  result.share = 1.0 - after_sum / before_sum;
  result.available = true;
  return result;
}

}  // namespace stiffscope
