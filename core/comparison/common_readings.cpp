#include "core/comparison/common_readings.h"

#include <string>
#include <unordered_map>

#include "core/comparison/matched_postures.h"

namespace stiffscope::comparison {

namespace {

std::vector<std::size_t> firstReadings(const calibration::UnloadedDay& day) {
  std::vector<std::size_t> first;
  std::size_t at = 0;
  for (const calibration::Posture& posture : day.postures) {
    first.push_back(at);
    at += posture.readings.size();
  }
  return first;
}

}  // namespace

CommonReadings commonReadings(const calibration::UnloadedDay& before, const calibration::UnloadedDay& after) {
  CommonReadings common;
  std::unordered_map<std::string, std::size_t> postures, targets;
  for (std::size_t i = 0; i < after.postures.size(); ++i)
    postures[after.pose_ids[static_cast<std::size_t>(after.postures[i].pose)]] = i;
  for (std::size_t t = 0; t < after.targets.size(); ++t) targets[after.targets[t]] = t;
  for (std::size_t t = 0; t < before.targets.size(); ++t) {
    const auto other = targets.find(before.targets[t]);
    if (other == targets.end()) continue;
    common.targets[0].push_back(static_cast<int>(t));
    common.targets[1].push_back(static_cast<int>(other->second));
  }
  const auto sameReflector = [&](int own, int other) {
    return before.targets[static_cast<std::size_t>(own)] == after.targets[static_cast<std::size_t>(other)];
  };
  const std::vector<std::size_t> first_before = firstReadings(before), first_after = firstReadings(after);
  for (std::size_t i = 0; i < before.postures.size(); ++i) {
    const calibration::Posture& own = before.postures[i];
    const auto found = postures.find(before.pose_ids[static_cast<std::size_t>(own.pose)]);
    if (found == postures.end()) continue;
    const calibration::Posture& other = after.postures[found->second];
    if ((own.q - other.q).cwiseAbs().maxCoeff() > MatchLimits().angle) continue;
    ++common.postures;
    for (std::size_t r = 0; r < own.readings.size(); ++r) {
      for (std::size_t s = 0; s < other.readings.size(); ++s) {
        if (sameReflector(own.readings[r].target, other.readings[s].target))
          common.readings.push_back({{i, first_before[i] + r}, {found->second, first_after[found->second] + s}});
      }
    }
  }
  return common;
}

}  // namespace stiffscope::comparison
