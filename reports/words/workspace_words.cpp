#include "reports/words/workspace_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

#include "core/io/units.h"
#include "reports/words/effect_words.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

std::string millimetres(const Eigen::Vector3d& vector) {
  return fmt::format("{:g}, {:g}, {:g} mm", vector.x() / io::kMillimetre, vector.y() / io::kMillimetre,
                     vector.z() / io::kMillimetre);
}

std::string deflectionWords(const workspace::Placement& placement) {
  return fmt::format("{:.3f} mm (U {:.3f} mm)", placement.deflection() / io::kMillimetre,
                     placement.prediction.tcp.expanded / io::kMillimetre);
}

}  // namespace

LinearStiffnessUnit stiffnessUnit(const workspace::WorkspaceStiffness& found) {
  constexpr double kSoft = 0.1e6;  // N/m
  for (const workspace::PointStiffness& one : found.postures) {
    if (!one.of_model.empty() && one.of_model.front().stiffness() < kSoft) return {1e3, "N/mm"};
  }
  return {};
}

bool givesInSlice(const workspace::StiffnessSlice& slice) {
  return std::any_of(slice.places.begin(), slice.places.end(), [&](const workspace::SlicePlace& one) {
    const Eigen::Matrix3d& model = one.at.model;
    return slice.outward.dot(model * slice.outward) > 0.0 || model(2, 2) > 0.0;
  });
}

std::vector<std::string> workspaceNotes(const workspace::WorkspaceStiffness& found) {
  std::vector<std::string> notes;
  notes.emplace_back(
      "Stiffness: what a force at P_TCP meets along itself while the flange is free to turn. K_x holds the springs of "
      "the joints alone.");
  if (found.held.empty()) {
    notes.emplace_back(
        "The model has nothing but joint springs, so what else gives (bearings across their axes, links, base) is in "
        "no number here, and intervals hold it only as far as those of the stiffnesses do.");
  } else {
    notes.push_back(
        fmt::format("The whole model holds, besides the springs of the joints, what the day shows of {}. K_x is "
                    "without that, and too stiff where it gives.",
                    effectNames(found.held, ", ")));
  }
  if (!found.unknown.empty()) {
    std::vector<std::string> names;
    for (const int joint : found.unknown) names.push_back(fmt::format("k{}", joint + 1));
    notes.push_back(
        fmt::format("{} {} not known: stiffnesses are those of the directions in which {} not give, so a posture has "
                    "fewer than three, and nothing is said of the others.",
                    fmt::join(names, ", "), names.size() == 1 ? "is" : "are",
                    names.size() == 1 ? "that joint does" : "those joints do"));
  }
  return notes;
}

std::string sliceWords(const workspace::StiffnessSlice& slice) {
  return fmt::format(
      "vertical plane through axis 1, turned about it by {:.1f} deg from x0, the tool turned as in posture {}; {} "
      "places, {:g} mm apart",
      unsignedZero(slice.azimuth / io::kDegree, 1), slice.pose, slice.places.size(), slice.spacing / io::kMillimetre);
}

std::string notJudgedWords(const workspace::Placement& placement, std::size_t postures) {
  if (placement.reached < postures)
    return fmt::format("{} of {} postures out of reach", postures - placement.reached, postures);
  return placement.judged() ? std::string() : words(placement.reason);
}

std::string placementWords(const workspace::PlacementStudy& study) {
  std::size_t judged = 0;
  for (const workspace::Placement& one : study.placements) judged += one.judged();
  if (!study.best) {
    std::string first;
    for (const workspace::Placement& one : study.placements) {
      if (first.empty()) first = notJudgedWords(one, study.postures.size());
    }
    return fmt::format("None of {} places could be judged: {}", study.placements.size(), first);
  }
  const workspace::Placement& best = study.placements[*study.best];
  std::string text = fmt::format("Of {} places {} could be judged. The workpiece moved by {} deflects least: {}",
                                 study.placements.size(), judged, millimetres(best.offset.by), deflectionWords(best));
  if (study.now && *study.now != *study.best && study.placements[*study.now].judged())
    text += fmt::format("; where it stands now: {}", deflectionWords(study.placements[*study.now]));
  return text;
}

}  // namespace stiffscope::reports
