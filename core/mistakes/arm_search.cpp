#include "core/mistakes/arm_search.h"

#include "core/identification/warnings.h"
#include "core/mistakes/searched_arm.h"
#include "core/numerics/resampling.h"

namespace stiffscope::mistakes {

namespace {

/// Most of what one table has is far from the arm, whatever the others are.
bool aTableIsFarOff(const SearchedArm& arm) {
  constexpr double kFar = 5.0 * identification::kMissedGeometry;
  for (const SourceTable table : arm.tables) {
    std::vector<double> groups;
    int last = -1;
    for (const UnloadedReading& reading : arm.day.unloaded) {
      if (reading.table != table || reading.group == last) continue;
      last = reading.group;
      groups.push_back(arm.found.fit.group_rms[static_cast<std::size_t>(last)]);
    }
    if (numerics::upperMedian(groups) > kFar) return true;
  }
  return false;
}

std::vector<std::string> namesOf(const campaign::Campaign& campaign) {
  std::vector<std::string> names;
  for (const campaign::Target& target : campaign.targets) names.push_back(target.id);
  return names;
}

}  // namespace

ArmSearch searchArm(const campaign::Campaign& campaign, const ReadingsOfDay& day, const SearchLimits& limits) {
  SearchedArm arm(campaign, day, limits);
  ArmSearch& found = arm.found;
  if (!found.fit.done) return std::move(found);
  found.contradicts = found.fit.typical > identification::kMissedGeometry || aTableIsFarOff(arm);
  const bool labelled = searchLabels(arm);
  if (found.fit.rms > limits.suspicious) {
    arm.mistakes = armMistakes(day, namesOf(campaign));
    searchReadTwice(arm);
    if (labelled && found.cures.empty()) searchExchangedSweeps(arm);
    if (found.cures.empty()) searchRenumbered(arm);
    if (found.cures.empty()) searchTables(arm);
    if (found.cures.empty()) searchGroups(arm);
    if (found.cures.empty()) searchZeros(arm);
    if (found.cures.empty()) searchOrigins(arm);
    if (found.cures.empty()) searchTableScales(arm);
    if (found.cures.empty()) searchStations(arm);
    if (found.cures.empty()) searchPairs(arm);
  }
  if (found.cures.empty()) searchScale(arm);
  if (found.cures.empty()) searchMasses(arm);
  if (found.cures.empty()) searchBase(arm);
  return std::move(found);
}

}  // namespace stiffscope::mistakes
