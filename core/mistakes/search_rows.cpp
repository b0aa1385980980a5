#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/campaign/row_names.h"
#include "core/io/units.h"
#include "core/mistakes/searched_arm.h"
#include "core/mistakes/spring_fit.h"

namespace stiffscope::mistakes {

namespace {

/// Whether the loads ask for the wrenches to follow the angles: then it is the readings that were exchanged.
bool wrenchesFollow(const SearchedArm& arm, const ReadingsOfDay& day, int a, int b) {
  if (!arm.campaign.load_cell) return false;
  const CellReading cell = asDeclared(*arm.campaign.load_cell);
  const LoadsOfDay loads(day, arm.found.fit);
  if (!loads.enough()) return false;
  const SpringFit stay = loads.fit(cell), follow = loads.fitExchanged(cell, a, b);
  double stays = 0.0, follows = 0.0;
  for (std::size_t k = 0; k < loads.poses().size(); ++k) {
    if (loads.poses()[k] != a && loads.poses()[k] != b) continue;
    stays += stay.pose_left[k];
    follows += follow.pose_left[k];
  }
  return follows < stays;
}

}  // namespace

bool searchExchangedAngles(SearchedArm& arm, const std::vector<int>& apart) {
  for (std::size_t a = 0; a < apart.size(); ++a) {
    for (std::size_t b = a + 1; b < apart.size(); ++b) {
      const UnloadedReading first = firstOf(arm.day, apart[a]), second = firstOf(arm.day, apart[b]);
      if (first.pose < 0 || second.pose < 0) continue;
      ReadingsOfDay day = arm.day;
      for (UnloadedReading& reading : day.unloaded) {
        if (reading.pose == first.pose) reading.q = second.q;
        if (reading.pose == second.pose) reading.q = first.q;
      }
      for (LoadedReading& reading : day.loaded) {
        if (reading.pose == first.pose)
          reading.q = second.q;
        else if (reading.pose == second.pose)
          reading.q = first.q;
      }
      const double before = missOfGroup(arm.found.fit, arm.day, apart[a]);
      const double after =
          std::max(missOfGroup(arm.found.fit, day, apart[a]), missOfGroup(arm.found.fit, day, apart[b]));
      if (!mendsGroup(arm, after, before)) continue;
      const bool readings = wrenchesFollow(arm, day, first.pose, second.pose);
      ArmCure cure;
      cure.suspected = {
          "row_order",
          readings ? whereOfGroup(arm.campaign, first, "pose", false)
                   : whereOfGroup(arm.campaign, first, columnsOfAngles(arm.day.robot.joints()), true),
          Remark(readings ? RemarkId::readings_exchanged : RemarkId::angles_exchanged,
                 campaign::poseName(arm.campaign, first.pose), campaign::poseName(arm.campaign, second.pose)),
          {}};
      cure.rms = after;
      cure.pose = first.pose;
      cure.day = std::move(day);
      arm.add(std::move(cure), RemarkId::group_misses_arm, before);
      return true;
    }
  }
  return false;
}

/// From some posture on each has the angles of its neighbour, and but for the last of them its own mend.
bool searchLostRow(SearchedArm& arm) {
  struct OfPosture {
    int pose = 0;
    double own = 0.0, before = 0.0, after = 0.0;
  };
  std::vector<OfPosture> postures;
  for (int g = 0; g < arm.day.groups; ++g) {
    const UnloadedReading& first = firstOf(arm.day, g);
    if (first.pose < 0) continue;
    ReadingsOfDay shifted = arm.day;
    const auto with = [&](const JointVector UnloadedReading::*row) {
      for (std::size_t i = 0; i < shifted.unloaded.size(); ++i) shifted.unloaded[i].q = arm.day.unloaded[i].*row;
      return missOfGroup(arm.found.fit, shifted, g);
    };
    postures.push_back(
        {first.pose, with(&UnloadedReading::q), with(&UnloadedReading::q_before), with(&UnloadedReading::q_after)});
  }
  std::sort(postures.begin(), postures.end(), [](const OfPosture& a, const OfPosture& b) { return a.pose < b.pose; });
  constexpr double kFits = 5e-3;  // m
  constexpr std::size_t kFew = 3;
  for (const bool next : {true, false}) {
    // Those at the end whose own angles do not fit and whose neighbour's do; a row that is there twice fits once more.
    std::size_t from = postures.size();
    const auto withNeighbours = [&](const OfPosture& one) { return next ? one.before : one.after; };
    const auto shifted = [&](const OfPosture& one) { return one.own > kFits && withNeighbours(one) < kFits; };
    const auto atEnd = [&](std::size_t i) { return i + 1 == postures.size(); };  // it has no neighbour
    while (from > 0 && (shifted(postures[from - 1]) || atEnd(from - 1))) --from;
    if (next && from > 0 && postures[from - 1].own > kFits) --from;  // whose own row is the one that is lost
    if (postures.size() - from < kFew + 1 || from < kFew) continue;
    const auto fitting = [&](std::size_t i) { return postures[i].own < kFits; };
    std::size_t well = 0;
    for (std::size_t i = 0; i < from; ++i) well += fitting(i) ? 1 : 0;
    if (2 * well < from) continue;
    const std::string first = campaign::poseName(arm.campaign, postures[from].pose),
                      last = campaign::poseName(arm.campaign, postures.back().pose);
    ArmCure cure;
    cure.suspected = {"row_order",
                      Remark(RemarkId::at_poses_in, first, last, columnsOfAngles(arm.day.robot.joints()),
                             fileOfAngles(arm.campaign, SourceTable::loading)),
                      Remark(RemarkId::rows_lost, first, next),
                      {}};
    cure.day = arm.day;
    // The posture whose own row is lost, or was pushed off the end, has angles in no row: without it.
    double before = 0.0, after = 0.0, count = 0.0;
    std::set<int> of_neighbour, of_none;
    for (std::size_t i = from; i < postures.size(); ++i) {
      if (withNeighbours(postures[i]) >= kFits) {
        of_none.insert(postures[i].pose);
        continue;
      }
      of_neighbour.insert(postures[i].pose);
      before += std::pow(postures[i].own, 2);
      after += std::pow(withNeighbours(postures[i]), 2);
      count += 1.0;
    }
    std::erase_if(cure.day.unloaded, [&](const UnloadedReading& one) { return of_none.contains(one.pose); });
    std::erase_if(cure.day.loaded, [&](const LoadedReading& one) { return of_none.contains(one.pose); });
    std::map<int, JointVector> q;
    for (UnloadedReading& reading : cure.day.unloaded) {
      if (!of_neighbour.contains(reading.pose)) continue;
      reading.q = next ? reading.q_before : reading.q_after;
      q[reading.pose] = reading.q;
    }
    for (LoadedReading& reading : cure.day.loaded) {
      if (q.contains(reading.pose)) reading.q = q.at(reading.pose);
    }
    cure.rms = std::sqrt(after / count);
    arm.add(std::move(cure), RemarkId::group_misses_arm, std::sqrt(before / count));
    return true;
  }
  return false;
}

/// A posture with the very angles of another and readings elsewhere: a log that was not updated.
bool searchRepeatedAngles(SearchedArm& arm, int group) {
  const UnloadedReading& first = firstOf(arm.day, group);
  if (first.pose < 0) return false;
  constexpr double kSame = 1e-3 * io::kDegree;
  for (int g = 0; g < arm.day.groups; ++g) {
    const UnloadedReading& other = firstOf(arm.day, g);
    if (g == group || other.pose < 0 || (other.q - first.q).cwiseAbs().maxCoeff() > kSame) continue;
    ArmCure cure;
    cure.suspected = {"row_order",
                      whereOfGroup(arm.campaign, first, columnsOfAngles(arm.day.robot.joints()), true),
                      Remark(RemarkId::angles_repeated, campaign::poseName(arm.campaign, first.pose),
                             campaign::poseName(arm.campaign, other.pose)),
                      {}};
    cure.rms = missOfGroup(arm.found.fit, arm.day, g);
    cure.pose = first.pose;
    cure.day = arm.day;
    arm.add(std::move(cure), RemarkId::group_misses_arm, missOfGroup(arm.found.fit, arm.day, group));
    return true;
  }
  return false;
}

}  // namespace stiffscope::mistakes
