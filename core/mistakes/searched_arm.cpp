#include "core/mistakes/searched_arm.h"

#include <algorithm>

#include "core/identification/warnings.h"

namespace stiffscope::mistakes {

namespace {

bool holds(const Tables& tables, SourceTable table) {
  return std::find(tables.begin(), tables.end(), table) != tables.end();
}

Tables tablesOf(const ReadingsOfDay& day) {
  Tables tables;
  for (const SourceTable table : kSourceTables) {
    if (std::any_of(day.unloaded.begin(), day.unloaded.end(),
                    [&](const UnloadedReading& reading) { return reading.table == table; }))
      tables.push_back(table);
  }
  return tables;
}

/// All sets of tables, the whole first.
std::vector<Tables> setsOf(const Tables& tables) {
  std::vector<Tables> sets;
  for (unsigned set = (1U << tables.size()) - 1; set > 0; --set) {
    Tables some;
    for (std::size_t k = 0; k < tables.size(); ++k) {
      if ((set >> k & 1U) != 0) some.push_back(tables[k]);
    }
    sets.push_back(std::move(some));
  }
  return sets;
}

}  // namespace

SearchedArm::SearchedArm(const campaign::Campaign& campaign, const ReadingsOfDay& day, const SearchLimits& limits)
    : campaign(campaign), day(day), limits(limits), tables(tablesOf(day)), sets(setsOf(tables)) {
  found.fit = fitNominal(day);
}

bool SearchedArm::mends(double rms) const {
  return rms < kMends * found.fit.rms && rms < identification::kMissedGeometry;
}

ReadingsOfDay SearchedArm::with(const ReadingsOfDay& day, const ArmMistake& mistake, const Tables& in) {
  return takenBack(
      day, mistake, [&](const UnloadedReading& reading) { return holds(in, reading.table); },
      [&](int) { return holds(in, SourceTable::loading); });
}

Remark SearchedArm::whereOf(const ArmMistake& mistake, const Tables& in) const {
  if (mistake.robot_size != 1.0) return Remark(RemarkId::in_urdf);
  return Remark(RemarkId::in_columns, columnsOf(mistake, campaign.robot.joints()), filesOf(in, isOfAngles(mistake)));
}

std::vector<std::string> SearchedArm::filesOf(const Tables& in, bool of_angles) const {
  std::vector<std::string> files;
  for (const SourceTable table : in)
    files.push_back(of_angles ? fileOfAngles(campaign, table) : fileOfPoints(campaign, table));
  return files;
}

void SearchedArm::add(ArmCure cure, RemarkId shows, std::optional<double> before) {
  cure.suspected.before = before.value_or(found.fit.rms);
  cure.suspected.after = cure.rms;
  cure.suspected.shown = Remark(shows, cure.suspected.before, cure.suspected.after);
  cure.fit = fitNominal(cure.day);
  found.cures.push_back(std::move(cure));
}

bool isOfAngles(const ArmMistake& mistake) { return !mistake.points && mistake.targets.empty(); }

std::string columnsOf(const ArmMistake& mistake, int joints) {
  if (mistake.points) return "x_mm, y_mm, z_mm";
  return mistake.targets.empty() ? columnsOfAngles(joints) : "target";
}

std::string columnsOfAngles(int joints) { return "q1_deg to q" + std::to_string(joints) + "_deg"; }

}  // namespace stiffscope::mistakes
