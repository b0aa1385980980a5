#include "core/workspace/workspace_stiffness.h"

#include <utility>

#include "core/effects/all.h"
#include "core/numerics/parallel.h"

namespace stiffscope::workspace {

WorkspaceStiffness workspaceStiffness(const DeflectingArm& arm, const identification::Identification& result,
                                      const extended_model::ExtendedModel* model, identification::Method method,
                                      const WorkspaceOptions& options) {
  WorkspaceStiffness found;
  found.method = method;
  if (model != nullptr) {
    for (const extended_model::AddedEffect& one : model->effects.added) {
      if (effects::natureOf(one.effect) == effects::EffectNature::machine) found.held.push_back(one.effect);
    }
  }
  for (int joint = 0; joint < arm.geometry.arm.joints(); ++joint) {
    if (!hasUsableStiffness(arm.estimate, joint)) found.unknown.push_back(joint);
  }
  const std::vector<NamedPosture> postures = identifiedPostures(arm.campaign, result);
  std::vector<std::optional<PointStiffness>> at(postures.size());
  numerics::onAllCores(postures.size(), [&](std::size_t i) { at[i] = pointStiffness(arm, postures[i].q); });
  for (std::size_t i = 0; i < postures.size(); ++i) {
    if (!at[i]) continue;
    at[i]->pose = postures[i].pose;
    found.postures.push_back(std::move(*at[i]));
  }
  found.slice = stiffnessSlice(arm, postures, options.slice);
  if (options.force) {
    const std::vector<NamedPosture> workpiece =
        options.workpiece.empty() ? std::vector<NamedPosture>{{found.slice.pose, found.slice.q}} : options.workpiece;
    found.placement = studyPlacements(arm, *options.force, workpiece,
                                      options.offsets.empty() ? offsetGrid(found.slice.spacing) : options.offsets);
  }
  return found;
}

}  // namespace stiffscope::workspace
