#include "app/view/open_material.h"

#include <algorithm>

#include "app/figures/deflection_scene.h"
#include "app/method_option.h"
#include "app/view/load_material.h"
#include "app/view/sweep_material.h"
#include "core/identification/load_step.h"
#include "core/input/input_error.h"
#include "core/input/nearest_name.h"
#include "reports/page/names.h"

namespace stiffscope {

namespace {

Identification identified(const Campaign& campaign, const ViewOptions& options) {
  IdentifyOptions how;
  how.step = options.step;
  how.subsets.most_all = 0;  // the viewer shows nothing of the subsets
  how.subsets.sample = 1;
  return identify(campaign, how);
}

/// The methods to show, the one to start with first.
std::vector<Method> methodsToShow(const Identification& result, const std::string& wanted) {
  std::vector<Method> methods;
  if (!wanted.empty()) {
    const std::vector<Method> named = methodsNamed(wanted);
    if (named.size() == 1 && !result.of(named.front()).available) {
      throw InputError({"--method"}, wanted, "not available here: " + result.of(named.front()).reason);
    }
    if (named.size() == 1) methods.push_back(named.front());
  }
  const auto shown = page::shownMethod(result);
  if (shown && methods.empty()) methods.push_back(*shown);
  for (const Method method : {Method::decoupled_partial_pose, Method::partial_pose, Method::complete_pose}) {
    if (result.of(method).available && std::find(methods.begin(), methods.end(), method) == methods.end()) {
      methods.push_back(method);
    }
  }
  return methods;
}

int postureNamed(const Campaign& campaign, const std::string& id) {
  const auto found = std::find(campaign.pose_ids.begin(), campaign.pose_ids.end(), id);
  if (found == campaign.pose_ids.end()) {
    throw InputError({"--pose"}, id,
                     "not a posture of this campaign" + nearestNameHint(id, campaign.pose_ids));
  }
  return static_cast<int>(found - campaign.pose_ids.begin());
}

/// Of the frames of `step`, or of any where that has none, the one with this posture.
std::size_t frameToStart(const ViewMaterial& material, int step, int posture) {
  const auto at = [&](const auto& fits) {
    return static_cast<std::size_t>(std::find_if(material.frames.begin(), material.frames.end(), fits) -
                                    material.frames.begin());
  };
  std::size_t found = at([&](const ViewFrame& one) { return one.step == step && one.posture == posture; });
  if (found == material.frames.size())
    found = at([&](const ViewFrame& one) { return one.posture == posture; });
  return found;
}

OpenedMaterial openLoads(const Campaign& campaign, const Identification& result, const ViewOptions& options) {
  OpenedMaterial opened;
  for (const Method method : methodsToShow(result, options.method)) {
    opened.by_method.push_back(loadMaterial(campaign, result, method));
  }
  if (opened.by_method.empty()) opened.by_method.push_back(loadMaterial(campaign, result, std::nullopt));
  const ViewMaterial& material = opened.by_method.front();
  if (material.frames.empty()) return {};
  if (!options.pose.empty()) {
    opened.first = frameToStart(material, result.step, postureNamed(campaign, options.pose));
    if (opened.first == material.frames.size()) {
      throw InputError({"--pose"}, options.pose, "this posture has no readings under load");
    }
  } else if (!result.cases.empty()) {
    opened.first = frameToStart(material, result.step, result.cases[medianCase({campaign, result})].pose);
  }
  return opened;
}

OpenedMaterial openSweeps(const Campaign& campaign, const ViewOptions& options, const std::string& why) {
  if (!options.method.empty() || options.step || !options.pose.empty()) {
    throw InputError({campaign.folder / "campaign.xml"}, "",
                     "no loads to show, so no method, step or posture: " + why);
  }
  ViewMaterial sweeps = sweepMaterial(campaign, measureFrames(campaign));
  if (sweeps.frames.empty()) {
    throw InputError({campaign.folder / "campaign.xml"}, "",
                     "nothing to show: " + why + "; " + sweeps.lacking);
  }
  return {{std::move(sweeps)}, 0};
}

}  // namespace

OpenedMaterial openMaterial(const Campaign& campaign, const ViewOptions& options) {
  const std::string lacking = whatLoadsLack(campaign);
  if (!lacking.empty()) return openSweeps(campaign, options, lacking);
  if (!heaviestStep(campaign)) return openSweeps(campaign, options, "no load step has a force");
  const Identification result = identified(campaign, options);
  OpenedMaterial opened = openLoads(campaign, result, options);
  if (!opened.by_method.empty()) return opened;
  return openSweeps(campaign, options, result.of(Method::partial_pose).reason);
}

}  // namespace stiffscope
