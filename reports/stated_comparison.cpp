#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>

#include "core/comparison/matched_postures.h"
#include "core/io/units.h"
#include "reports/stated_results.h"

namespace stiffscope::reports {

namespace {

/// Why the two are not of one machine; empty where nothing says so.
std::string differenceOfStatedMachines(const StatedCampaign& before, const StatedCampaign& after) {
  if (before.robot != after.robot)
    return fmt::format("the machines differ: {} before, {} after", before.robot, after.robot);
  if (!before.serial.empty() && !after.serial.empty() && before.serial != after.serial)
    return fmt::format("the machines differ: serial number {} before, {} after", before.serial, after.serial);
  for (std::size_t m = 0; m < before.compliances.size(); ++m) {
    const std::size_t joints = before.compliances[m].size(), joints_after = after.compliances[m].size();
    if (joints > 0 && joints_after > 0 && joints != joints_after)
      return fmt::format("the machines differ: {} joints before, {} after", joints, joints_after);
  }
  if (before.links.empty() || after.links.empty()) return {};
  if (before.links.size() != after.links.size())
    return fmt::format("the machines differ: {} joints before, {} after", before.links.size() + 1,
                       after.links.size() + 1);
  for (std::size_t i = 0; i < before.links.size(); ++i) {
    const StatedLink &a = before.links[i], &b = after.links[i];
    if (std::abs(a.nominal_mm - b.nominal_mm) * io::kMillimetre > comparison::kSamePlace)
      return fmt::format("the machines differ: axes {} and {} are nominally {:.1f} mm apart before, {:.1f} mm after",
                         a.axis, a.axis + 1, a.nominal_mm, b.nominal_mm);
    if (std::abs(a.nominal_deg - b.nominal_deg) * io::kDegree > comparison::kSameDirection)
      return fmt::format("the machines differ: axes {} and {} are nominally at {:.2f}° before, at {:.2f}° after",
                         a.axis, a.axis + 1, a.nominal_deg, b.nominal_deg);
  }
  return {};
}

bool sameAngles(const StatedPosture& a, const StatedPosture& b) {
  for (std::size_t j = 0; j < std::min(a.q_deg.size(), b.q_deg.size()); ++j) {
    if (std::abs(a.q_deg[j] - b.q_deg[j]) * io::kDegree > comparison::MatchLimits().angle) return false;
  }
  return true;
}

void matchStated(StatedComparison& result) {
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < result.after.postures.size(); ++i) places.emplace(result.after.postures[i].pose, i);
  for (std::size_t i = 0; i < result.before.postures.size(); ++i) {
    const StatedPosture& posture = result.before.postures[i];
    const auto place = places.find(posture.pose);
    if (place == places.end()) {
      result.unmatched.push_back(posture.pose + ": before alone");
      continue;
    }
    if (sameAngles(posture, result.after.postures[place->second]))
      result.postures.push_back({i, place->second});
    else
      result.unmatched.push_back(posture.pose + ": at other joint angles");
    places.erase(place);
  }
  for (const StatedPosture& posture : result.after.postures) {
    if (places.contains(posture.pose)) result.unmatched.push_back(posture.pose + ": after alone");
  }
  const auto at_wrist = [](const std::vector<StatedPosture>& postures) {
    return std::any_of(postures.begin(), postures.end(),
                       [](const StatedPosture& one) { return std::isfinite(one.wrist.deflection_mm); });
  };
  result.at_wrist = at_wrist(result.before.postures) && at_wrist(result.after.postures);
}

void compareStiffnesses(StatedComparison& result) {
  std::vector<identification::Method> both;
  for (const identification::Method method : identification::kMethods) {
    const std::size_t m = static_cast<std::size_t>(method);
    if (result.before.compliances[m].empty() || result.after.compliances[m].empty()) continue;
    result.changes[m] = comparison::statedChanges(result.before.compliances[m], result.after.compliances[m]);
    both.push_back(method);
  }
  for (const auto& shown : {result.before.shown_first, result.after.shown_first}) {
    if (shown && std::find(both.begin(), both.end(), *shown) != both.end()) result.shown_first = shown;
    if (result.shown_first) return;
  }
  if (!both.empty()) result.shown_first = both.front();
}

void compareLinks(StatedComparison& result) {
  std::vector<std::optional<comparison::Uncertain>> lengths[2], angles[2];
  for (std::size_t side = 0; side < 2; ++side) {
    for (const StatedLink& link : (side == 0 ? result.before : result.after).links) {
      lengths[side].push_back(link.length_mm);
      angles[side].push_back(link.angle_deg);
    }
  }
  result.lengths = comparison::statedChanges(lengths[0], lengths[1]);
  result.angles = comparison::statedChanges(angles[0], angles[1]);
}

std::string dayKindOf(const StatedCampaign& one) {
  if (one.states_stiffness && std::any_of(one.postures.begin(), one.postures.end(), [](const StatedPosture& posture) {
        return std::isfinite(posture.targets.deflection_mm) || std::isfinite(posture.wrist.deflection_mm);
      }))
    return "a loaded day";
  if (one.diagnosis && !one.diagnosis->unloaded) return "a loaded day";
  if (!one.accuracy.empty() || (one.diagnosis && one.diagnosis->unloaded)) return "a day without a load";
  return {};
}

std::vector<std::string> cautionsOf(const StatedComparison& result) {
  std::vector<std::string> cautions;
  const StatedCampaign &before = result.before, &after = result.after;
  const std::string kind_before = dayKindOf(before), kind_after = dayKindOf(after);
  if (!kind_before.empty() && !kind_after.empty() && kind_before != kind_after)
    cautions.push_back(fmt::format(
        "before is {}, after is {}: stiffnesses, deflections and residuals are of different kinds and are not compared",
        kind_before, kind_after));
  else if (before.states_stiffness != after.states_stiffness)
    cautions.push_back(fmt::format("{} states no stiffnesses: they are not compared",
                                   before.states_stiffness ? after.file : before.file));
  if (before.serial.empty() != after.serial.empty())
    cautions.push_back(
        "one of the two states no serial number: that they are one machine rests on its name and lengths");
  if (before.links.empty() || after.links.empty())
    cautions.push_back("not both state the lengths between axes: that they are one machine rests on its name");
  if (!before.urdf_sha256.empty() && !after.urdf_sha256.empty() && before.urdf_sha256 != after.urdf_sha256)
    cautions.push_back("the robot descriptions (URDF) are not the same file");
  if (result.comparesStiffness())
    cautions.push_back(
        "differences take both results as independent; `compare` of the two campaigns uses their readings, in which "
        "what "
        "both miss on the same postures cancels, and is sharper");
  return cautions;
}

}  // namespace

StatedComparison compareStated(StatedCampaign before, StatedCampaign after) {
  StatedComparison result;
  result.before = std::move(before), result.after = std::move(after);
  result.refused = differenceOfStatedMachines(result.before, result.after);
  if (!result.refused.empty()) return result;
  matchStated(result);
  if (dayKindOf(result.before) == dayKindOf(result.after)) compareStiffnesses(result);
  compareLinks(result);
  result.cautions = cautionsOf(result);
  return result;
}

}  // namespace stiffscope::reports
