#include <fmt/format.h>

#include "reports/json/export_json.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

std::vector<std::string> exportComments(const campaign::Campaign& campaign, const ExportedModel& exported) {
  std::vector<std::string> comments{
      fmt::format("{}: elastic model by {}{}, written by stiffscope", campaign.name, namesOf(exported.method).full,
                  exported.springs_only ? ", joint springs alone" : ""),
      fmt::format(
          "m, kg, s, rad. All bodies stand parallel to {} with all joints at zero. Drives have the joints' names "
          "and angles; springs rest at 0. What stands in for numbers that nobody measured, without effect on "
          "what stands still: {:g} kg and {:g} kg m^2 for bodies between springs, damping of {:g} s times "
          "stiffness.",
          exported.model.chain.base, elastic_model::kStandInMass, elastic_model::kStandInInertia,
          elastic_model::kDampingTime)};
  for (const Remark& remark : exported.model.remarks) comments.push_back(words(remark));
  return comments;
}

std::string exportText(const campaign::Campaign& campaign, const ExportedModel& exported) {
  using enum elastic_model::ChainJoint::Kind;
  std::string text = fmt::format("{}: elastic model by {}\n\n", campaign.name, longName(exported.method));
  text += fmt::format("  {:<32}{:>14}\n", "spring", "stiffness");
  for (const elastic_model::ChainBody& body : exported.model.chain.bodies) {
    for (const elastic_model::ChainJoint& joint : body.joints) {
      if (joint.kind == drive) continue;
      text += fmt::format("  {:<32}{:>14.4g} {}\n", joint.name, joint.stiffness,
                          joint.kind == turn_spring ? "Nm/rad" : "N/m");
    }
  }
  for (const Remark& remark : exported.model.remarks) text += wrapped(capitalised(words(remark)) + '.', 2) + '\n';
  return text + fmt::format("{}: written ({})\n", exported.file, exported.format);
}

std::string urdfExportText(const campaign::Campaign& campaign, const std::string& file, bool by_postures) {
  return fmt::format("{}: calibrated URDF, axes and flange where the {} have them\n{}: written (urdf)\n", campaign.name,
                     by_postures ? "unloaded postures" : "sweeps", file);
}

}  // namespace stiffscope::reports
