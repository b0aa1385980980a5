#include "core/mistakes/find_mistakes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/mistakes/arm_search.h"
#include "core/mistakes/load_search.h"
#include "core/mistakes/remarks.h"

namespace stiffscope::mistakes {

namespace {

/// Of cures that mend the arm as well, those with which springs explain the loads; then the simplest.
void keepBest(const campaign::Campaign& campaign, std::vector<ArmCure>& cures) {
  if (cures.size() < 2 || cures.front().pose) return;
  std::vector<double> left(cures.size(), 1.0);
  double best = 1.0;
  for (std::size_t i = 0; campaign.load_cell && i < cures.size(); ++i) {
    const LoadsOfDay loads(cures[i].day, cures[i].fit);
    if (loads.enough()) left[i] = loads.fit(asDeclared(*campaign.load_cell)).left;
    best = std::min(best, left[i]);
  }
  std::vector<ArmCure> kept;
  for (std::size_t i = 0; i < cures.size(); ++i) {
    constexpr double kAsWell = 1.5;
    if (best > kContradicts || left[i] <= kAsWell * best) kept.push_back(std::move(cures[i]));
  }
  int least = kept.front().things;
  for (const ArmCure& cure : kept) least = std::min(least, cure.things);
  std::erase_if(kept, [&](const ArmCure& cure) { return cure.things > least; });
  cures = std::move(kept);
}

/// How near the reflectors are to one line: the least height of the triangle that has the largest.
std::optional<Suspected> onOneLine(const campaign::Campaign& campaign, const ReadingsOfDay& day,
                                   const NominalFit& fit) {
  // Those that were never read stand nowhere.
  std::vector<bool> placed(fit.reflectors_in_flange.size(), false);
  for (const UnloadedReading& reading : day.unloaded) placed[static_cast<std::size_t>(reading.target)] = true;
  std::vector<Eigen::Vector3d> at;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < placed.size(); ++k) {
    if (!placed[k]) continue;
    at.push_back(fit.reflectors_in_flange[k]);
    names.push_back(campaign.targets[static_cast<std::size_t>(day.campaign_target[k])].id);
  }
  if (at.size() < 3) return std::nullopt;
  double height = 0.0, longest = 0.0;
  for (std::size_t a = 0; a < at.size(); ++a) {
    for (std::size_t b = a + 1; b < at.size(); ++b) {
      longest = std::max(longest, (at[a] - at[b]).norm());
      for (std::size_t c = b + 1; c < at.size(); ++c) {
        const double base = std::max({(at[a] - at[b]).norm(), (at[b] - at[c]).norm(), (at[c] - at[a]).norm()});
        if (base > 0.0) height = std::max(height, (at[b] - at[a]).cross(at[c] - at[a]).norm() / base);
      }
    }
  }
  constexpr double kLine = 0.05;  // of the longest side: the turn about it is then twenty times as uncertain as others
  if (longest <= 0.0 || height > kLine * longest) return std::nullopt;
  return Suspected{"reflectors_on_line",
                   Remark(RemarkId::in_files, names),
                   Remark(RemarkId::reflectors_on_line, height, longest),
                   Remark(),
                   height,
                   longest};
}

/// Of a day of displacements in base_link, which have no points to fit the arm to: reflectors where they are declared.
std::optional<NominalFit> declaredArm(const campaign::Campaign& campaign, const ReadingsOfDay& day) {
  if (!campaign.displacements || campaign.displacements->frame != campaign::PointFrame::base_link) return std::nullopt;
  NominalFit fit;
  for (const int of_campaign : day.campaign_target) {
    const campaign::Target& target = campaign.targets[static_cast<std::size_t>(of_campaign)];
    if (!target.position_in_flange) return std::nullopt;
    fit.reflectors_in_flange.push_back(*target.position_in_flange);
  }
  fit.done = !fit.reflectors_in_flange.empty();
  return fit;
}

void addLoads(const campaign::Campaign& campaign, const ReadingsOfDay& day, const NominalFit& fit,
              ModelAgreement& agreement) {
  LoadSearch loads = searchLoads(campaign, day, fit);
  if (!loads.done) return;
  agreement.loads_left = loads.fit.left;
  agreement.loads = std::move(loads.cures);
  agreement.loads_contradicted = loads.contradicts || !agreement.loads.empty();
}

}  // namespace

ModelAgreement findMistakes(const campaign::Campaign& campaign) {
  ModelAgreement agreement;
  ReadingsOfDay day = readingsOf(campaign);
  ArmSearch arm = searchArm(campaign, day);
  if (!arm.fit.done) {
    if (const std::optional<NominalFit> declared = declaredArm(campaign, day))
      addLoads(campaign, day, *declared, agreement);
    return agreement;
  }
  agreement.arm_miss = arm.fit.typical;
  keepBest(campaign, arm.cures);
  for (const ArmCure& cure : arm.cures) agreement.arm.push_back(cure.suspected);
  agreement.arm_contradicted = arm.contradicts || !arm.cures.empty();
  if (arm.contradicts && arm.cures.empty()) return agreement;
  NominalFit fit = arm.fit;
  if (!arm.cures.empty() && !arm.cures.front().pose) {
    day = arm.cures.front().day;
    fit = arm.cures.front().fit;
  }
  // Loads at a posture whose angles or reflectors are wrong say nothing.
  for (const ArmCure& cure : arm.cures) {
    if (cure.pose) std::erase_if(day.loaded, [&](const LoadedReading& reading) { return reading.pose == *cure.pose; });
  }
  // Nor at one that fits nowhere: where rows are shifted, that at the end.
  constexpr double kNowhere = 10.0;
  for (const UnloadedReading& reading : day.unloaded) {
    if (fit.group_rms[static_cast<std::size_t>(reading.group)] > kNowhere * fit.typical)
      std::erase_if(day.loaded, [&](const LoadedReading& one) { return one.pose == reading.pose; });
  }
  if (std::optional<Suspected> line = onOneLine(campaign, day, fit)) {
    agreement.arm.push_back(*line);
    agreement.arm_contradicted = true;
  }
  addLoads(campaign, day, fit, agreement);
  return agreement;
}

}  // namespace stiffscope::mistakes
