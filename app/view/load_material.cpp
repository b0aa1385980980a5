#include "app/view/load_material.h"

#include <fmt/format.h>

#include "app/figures/deflection_scene.h"
#include "app/view/under_load_step.h"
#include "core/identification/load_step.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

ViewFrame frameOf(const ReportCampaign& one, std::size_t index, std::optional<Method> method) {
  const LoadCase& load_case = one.identification.cases[index];
  const std::string& posture = one.campaign.pose_ids[static_cast<std::size_t>(load_case.pose)];
  ViewFrame frame;
  frame.scene = postureScene(one, index, method);
  frame.name = fmt::format("posture-{}-step-{}", posture, load_case.step);
  frame.where = fmt::format("posture {}", posture);
  frame.load = fmt::format("load step {}, {}\u00a0kN", load_case.step,
                           page::fixed(1e-3 * load_case.wrench.force.norm(), 2));
  frame.posture = load_case.pose;
  frame.step = load_case.step;
  frame.force = load_case.wrench.force;
  return frame;
}

}  // namespace

ViewMaterial loadMaterial(const Campaign& campaign, const Identification& identified,
                          std::optional<Method> method) {
  ViewMaterial material;
  material.campaign = campaign.name;
  if (method) {
    material.method = page::shortName(*method);
  } else {
    material.lacking = "nothing is predicted: " + identified.of(Method::partial_pose).reason;
  }
  for (const int step : loadSteps(campaign)) {
    const Identification other =
        step == identified.step ? Identification{} : underLoadStep(campaign, identified, step);
    const ReportCampaign one{campaign, step == identified.step ? identified : other};
    for (std::size_t i = 0; i < one.identification.cases.size(); ++i) {
      material.frames.push_back(frameOf(one, i, method));
    }
  }
  return material;
}

}  // namespace stiffscope
