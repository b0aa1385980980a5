#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/campaign/row_names.h"
#include "core/identification/warnings.h"
#include "core/mistakes/searched_arm.h"

namespace stiffscope::mistakes {

namespace {

std::vector<int> groupsApart(const SearchedArm& arm) {
  constexpr double kApart = 6.0, kLeast = 10e-3, kFew = 1.0 / 3.0;  // times the median; m; of the groups
  std::vector<int> apart;
  const double limit = std::max(kLeast, kApart * arm.found.fit.typical);
  for (int g = 0; g < arm.day.groups; ++g) {
    if (arm.found.fit.group_rms[static_cast<std::size_t>(g)] > limit) apart.push_back(g);
  }
  if (static_cast<double>(apart.size()) > kFew * arm.day.groups) apart.clear();
  return apart;
}

double missOfGroup(const NominalFit& fit, const ReadingsOfDay& day, int group) {
  double squares = 0.0, count = 0.0;
  for (const UnloadedReading& reading : day.unloaded) {
    if (reading.group != group) continue;
    squares += std::pow(fit.missOf(day, reading), 2);
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

const UnloadedReading& firstOf(const ReadingsOfDay& day, int group) {
  return *std::find_if(day.unloaded.begin(), day.unloaded.end(),
                       [&](const UnloadedReading& reading) { return reading.group == group; });
}

bool mendsGroup(const SearchedArm& arm, double after, double before) {
  constexpr double kAsOthers = 3.0, kLeast = 3e-3;  // m
  return after < kMends * before && after < std::max(kLeast, kAsOthers * arm.found.fit.typical);
}

Remark whereOfGroup(const campaign::Campaign& campaign, const UnloadedReading& first, const char* columns,
                    bool of_angles) {
  const std::string file = of_angles ? fileOfAngles(campaign, first.table) : fileOfPoints(campaign, first.table);
  if (first.pose >= 0) {
    std::size_t line = first.line;
    if (of_angles) {
      for (const campaign::State& row : campaign.states->rows) {
        if (row.pose == first.pose && row.step == 0) line = row.line;
      }
    }
    return Remark(RemarkId::at_pose_in, campaign::poseName(campaign, first.pose), std::string(columns),
                  campaign::rowName(file, line));
  }
  return Remark(RemarkId::at_sweep_of, first.axis + 1, std::string(columns), campaign::rowName(file, first.line));
}

ReadingsOfDay backwards(ReadingsOfDay day, int group) {
  std::map<int, std::vector<UnloadedReading*>> by_target;
  for (UnloadedReading& reading : day.unloaded) {
    if (reading.group == group) by_target[reading.target].push_back(&reading);
  }
  for (auto& [target, rows] : by_target) {
    for (std::size_t i = 0; i < rows.size() / 2; ++i) std::swap(rows[i]->q, rows[rows.size() - 1 - i]->q);
  }
  return day;
}

void searchGroup(SearchedArm& arm, int group) {
  const UnloadedReading& first = firstOf(arm.day, group);
  const double before = missOfGroup(arm.found.fit, arm.day, group);
  const auto here = [group](const UnloadedReading& reading) { return reading.group == group; };
  const auto loads = [&](int pose) { return pose == first.pose; };
  std::vector<ArmCure> cures;
  const auto tryOne = [&](const ReadingsOfDay& day, Suspected suspected, int things) {
    const double after = missOfGroup(arm.found.fit, day, group);
    if (!mendsGroup(arm, after, before)) return;
    ArmCure cure;
    cure.suspected = std::move(suspected);
    cure.things = things;
    cure.rms = after;
    cure.pose = first.pose;
    cure.day = day;
    cures.push_back(std::move(cure));
  };
  for (const ArmMistake& mistake : arm.mistakes) {
    if (!mistake.of_one_group) continue;
    tryOne(takenBack(arm.day, mistake, here, loads),
           {mistake.id,
            whereOfGroup(arm.campaign, first, columnsOf(mistake), isOfAngles(mistake)),
            mistake.remedy(false),
            {}},
           mistake.things);
  }
  if (first.axis >= 0)
    tryOne(backwards(arm.day, group),
           {"row_order",
            whereOfGroup(arm.campaign, first, "q1_deg to q6_deg", true),
            Remark(RemarkId::angles_backwards, first.axis + 1),
            {}},
           1);
  if (cures.empty()) return;
  std::stable_sort(cures.begin(), cures.end(), [](const ArmCure& a, const ArmCure& b) { return a.rms < b.rms; });
  const double best = cures.front().rms;
  std::erase_if(cures, [&](const ArmCure& cure) { return cure.rms > kArmAsWell * best; });
  std::stable_sort(cures.begin(), cures.end(), [](const ArmCure& a, const ArmCure& b) { return a.things < b.things; });
  std::erase_if(cures, [&](const ArmCure& cure) { return cure.things > cures.front().things; });
  for (ArmCure& cure : cures) arm.add(std::move(cure), RemarkId::group_misses_arm, before);
}

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
      ArmCure cure;
      cure.suspected = {"row_order",
                        whereOfGroup(arm.campaign, first, "q1_deg to q6_deg", true),
                        Remark(RemarkId::angles_exchanged, campaign::poseName(arm.campaign, first.pose),
                               campaign::poseName(arm.campaign, second.pose)),
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

}  // namespace

void searchGroups(SearchedArm& arm) {
  const std::vector<int> apart = groupsApart(arm);
  if (apart.empty()) return;
  if (searchExchangedAngles(arm, apart)) return;
  for (const int group : apart) searchGroup(arm, group);
}

void searchExchangedSweeps(SearchedArm& arm) {
  for (int a = 0; a < 6; ++a) {
    for (int b = a + 1; b < 6; ++b) {
      ReadingsOfDay day = arm.day;
      std::map<int, std::array<std::vector<UnloadedReading*>, 2>> by_target;
      for (UnloadedReading& reading : day.unloaded) {
        if (reading.axis == a) by_target[reading.target][0].push_back(&reading);
        if (reading.axis == b) by_target[reading.target][1].push_back(&reading);
      }
      bool same = !by_target.empty();
      for (auto& [target, rows] : by_target) {
        same &= rows[0].size() == rows[1].size();
        for (std::size_t i = 0; same && i < rows[0].size(); ++i) std::swap(rows[0][i]->point, rows[1][i]->point);
      }
      if (!same) continue;
      const double rms = fitNominal(day).rms;
      if (!arm.mends(rms)) continue;
      ArmCure cure;
      cure.suspected = {"sweeps_exchanged",
                        Remark(RemarkId::in_columns, std::string("x_mm, y_mm, z_mm"),
                               std::vector<std::string>{arm.campaign.circle_sweeps->file}),
                        Remark(RemarkId::sweeps_exchanged, a + 1, b + 1),
                        {}};
      cure.rms = rms;
      cure.day = std::move(day);
      arm.add(std::move(cure));
      return;
    }
  }
}

bool searchLabels(SearchedArm& arm) {
  if (!arm.campaign.circle_sweeps) return true;
  std::array<Vector6d, 6> least, most;
  std::array<bool, 6> swept{};
  for (std::size_t k = 0; k < 6; ++k) least[k].setConstant(INFINITY), most[k].setConstant(-INFINITY);
  std::array<std::size_t, 6> lines{};
  for (const campaign::CircleReading& row : arm.campaign.circle_sweeps->rows) {
    const auto axis = static_cast<std::size_t>(row.axis);
    if (!swept[axis]) lines[axis] = row.line;
    least[axis] = least[axis].cwiseMin(row.q);
    most[axis] = most[axis].cwiseMax(row.q);
    swept[axis] = true;
  }
  std::vector<int> labels;
  std::size_t line = 0;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    if (!swept[axis]) continue;
    Eigen::Index turns = 0;
    const Vector6d range = most[axis] - least[axis];
    const double largest = range.maxCoeff(&turns);
    // A joint that is told with its neighbour turns as far as that.
    constexpr double kStill = 0.1;
    if (range[static_cast<Eigen::Index>(axis)] > kStill * largest) continue;
    if (labels.empty()) line = lines[axis];
    labels.push_back(static_cast<int>(axis) + 1);
    labels.push_back(static_cast<int>(turns) + 1);
  }
  if (labels.empty()) return true;
  // More than half of them is an order of joints, not one of labels.
  constexpr std::size_t kMost = 3;
  if (labels.size() / 2 > kMost || arm.found.fit.rms > identification::kMissedGeometry) return false;
  ArmCure cure;
  cure.suspected = {"sweeps_exchanged",
                    Remark(RemarkId::in_columns, std::string("axis"),
                           std::vector<std::string>{campaign::rowName(arm.campaign.circle_sweeps->file, line)}),
                    Remark(RemarkId::labels_exchanged, labels),
                    {}};
  cure.rms = arm.found.fit.rms;
  cure.day = arm.day;
  arm.add(std::move(cure));
  return false;
}

}  // namespace stiffscope::mistakes
