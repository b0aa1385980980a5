#include "core/workspace/workspace_stiffness.h"
#include "reports/text/text.h"

#include <fmt/format.h>
#include <algorithm>

#include "core/io/units.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/workspace_words.h"

namespace stiffscope::reports {

namespace {

std::string stiffnessCell(const std::vector<workspace::DirectionalCompliance>& found, bool softest) {
  if (found.empty() || (!softest && found.size() < 2)) return "-";
  const workspace::DirectionalCompliance& one = softest ? found.front() : found.back();
  const identification::CoverageInterval interval = one.stiffnessInterval();
  return fmt::format("{:.3f} [{:.3f}, {}]", one.stiffness() * io::kMicrometre, interval.low * io::kMicrometre,
                     std::isfinite(interval.high) ? fmt::format("{:.3f}", interval.high * io::kMicrometre) : "open");
}

/// The place of the slice that is softest in its softest direction, and the one that is stiffest there.
void addSlice(const workspace::StiffnessSlice& slice, std::string& text) {
  text += "\n" + wrapped("Slice: " + sliceWords(slice) + ".", 2) + "\n";
  std::vector<const workspace::SlicePlace*> places;
  for (const workspace::SlicePlace& one : slice.places) {
    if (!one.at.of_model.empty()) places.push_back(&one);
  }
  if (places.empty()) return;
  const auto [least, most] = std::minmax_element(places.begin(), places.end(), [](const auto* a, const auto* b) {
    return a->at.of_model.front().stiffness() < b->at.of_model.front().stiffness();
  });
  for (const workspace::SlicePlace* one : {*least, *most}) {
    text += fmt::format("  {} at radius {:g} mm, height {:g} mm: {} N/µm in its softest direction\n",
                        one == *least ? "softest " : "stiffest", one->radius / io::kMillimetre,
                        unsignedZero(one->height / io::kMillimetre, 0), stiffnessCell(one->at.of_model, true));
  }
}

}  // namespace

std::string workspaceText(const campaign::Campaign& campaign, const workspace::WorkspaceStiffness& found) {
  std::string text =
      fmt::format("{}: stiffness at P_TCP by {}, N/µm [95 % interval]\n\n  {:<10}{:>26}{:>26}{:>24}\n", campaign.name,
                  namesOf(found.method).full, "pose", "softest", "stiffest", "K_x alone, softest");
  for (const workspace::PointStiffness& one : found.postures)
    text += fmt::format(
        "  {:<10}{:>26}{:>26}{:>24}\n", one.pose, stiffnessCell(one.of_model, true), stiffnessCell(one.of_model, false),
        one.of_springs.empty() ? "-" : fmt::format("{:.3f}", one.of_springs.front().stiffness() * io::kMicrometre));
  addSlice(found.slice, text);
  if (found.placement) {
    const Eigen::Vector3d& force = found.placement->force;
    text +=
        fmt::format("\n{}\n", wrapped(fmt::format("Placement under {:g}, {:g}, {:g} N (R0) on P_TCP: {}.", force.x(),
                                                  force.y(), force.z(), placementWords(*found.placement)),
                                      2));
  }
  text += "\n";
  for (const std::string& note : workspaceNotes(found)) text += wrapped("  " + note, 2) + "\n";
  return text;
}

}  // namespace stiffscope::reports
