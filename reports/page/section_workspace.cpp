#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "core/io/units.h"
#include "reports/csv/posture_tables.h"
#include "reports/page/html.h"
#include "reports/page/sections.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/rich_text.h"
#include "reports/words/workspace_words.h"

namespace stiffscope::page {

namespace {

/// "2.31 (2.20 to 2.44)".
std::string principalCell(const std::vector<workspace::DirectionalCompliance>& found, bool softest,
                          const reports::LinearStiffnessUnit& unit) {
  if (found.empty() || (!softest && found.size() < 2)) return "–";
  const workspace::DirectionalCompliance& one = softest ? found.front() : found.back();
  const identification::CoverageInterval interval = one.stiffnessInterval();
  const auto number = [&unit](double stiffness) { return reports::significant(stiffness / unit.size, 3); };
  return fmt::format("{} ({} to {})", number(one.stiffness()), number(interval.low),
                     std::isfinite(interval.high) ? number(interval.high) : "open");
}

std::string directionCell(const std::vector<workspace::DirectionalCompliance>& found) {
  if (found.empty()) return "–";
  const Eigen::Vector3d& d = found.front().direction;
  return fmt::format("{}, {}, {}", reports::fixed(d.x(), 2), reports::fixed(d.y(), 2), reports::fixed(d.z(), 2));
}

reports::Table placesTable(const workspace::WorkspaceStiffness& found, int joints) {
  const reports::LinearStiffnessUnit unit = reports::stiffnessUnit(found);
  reports::Table table{fmt::format("Stiffness at P_{{TCP}} in the postures, {} (95\u00a0% interval)", unit.name),
                       {"Posture", "Softest", "in direction (R_{0})", "Stiffest", "K_{x} alone, softest"},
                       {{}}};
  table.id = "posture-stiffness";
  constexpr bool kPostures = true, kSlice = true;
  table.data = reports::stiffnessPlaces(found, joints, kPostures, !kSlice);
  for (const workspace::PointStiffness& one : found.postures)
    table.groups.front().rows.push_back(
        {reports::asIs(one.pose), principalCell(one.of_model, true, unit), directionCell(one.of_model),
         principalCell(one.of_model, false, unit),
         one.of_springs.empty() ? "–" : reports::significant(one.of_springs.front().stiffness() / unit.size, 3)});
  return table;
}

/// Whether a posture has a stiffness; with too many joints unknown none has, and a table of them would be empty.
bool saysAnything(const workspace::WorkspaceStiffness& found) {
  return std::any_of(found.postures.begin(), found.postures.end(), [](const workspace::PointStiffness& one) {
    return !one.of_model.empty() || !one.of_springs.empty();
  });
}

/// A terminal's "-25.5 deg" as people write it.
std::string withDegrees(std::string words) {
  if (const std::size_t at = words.find(" deg"); at != std::string::npos) words.replace(at, 4, "°");
  if (const std::size_t at = words.find(" -"); at != std::string::npos) words.replace(at, 2, " −");
  return words;
}

}  // namespace

bool hasWorkspace(const reports::ReportCampaign& one) { return one.workspace != nullptr; }

void writeWorkspace(Html& html, const reports::ReportContent& content) {
  writeForEach(html, content, "workspace", "Stiffness over the workspace", hasWorkspace,
               [&](const reports::ReportCampaign& one) {
                 const workspace::WorkspaceStiffness& found = *one.workspace;
                 for (const std::string& note : reports::workspaceNotes(found))
                   html.paragraph(reports::withSubscripts(note));
                 const int joints = one.campaign.robot.joints();
                 const reports::Table places = placesTable(found, joints);
                 if (saysAnything(found))
                   writeTable(html, places);
                 else
                   html.keepTable(places.id, reports::csvTable(*places.data));
                 constexpr bool kPostures = true, kSlice = true;
                 html.keepTable("stiffness-slice",
                                reports::csvTable(reports::stiffnessPlaces(found, joints, !kPostures, kSlice)));
                 if (!reports::givesInSlice(found.slice)) {
                   html.paragraph(
                       "There is no picture of a slice of the workspace: no joint whose stiffness is known moves "
                       "P_{TCP} in its plane.");
                   return;
                 }
                 html.paragraph(fmt::format("By {}; the slice is in the {}.", reports::longName(found.method),
                                            reports::asIs(withDegrees(reports::sliceWords(found.slice)))),
                                "faint");
               });
}

}  // namespace stiffscope::page
