#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/command.h"
#include "app/large_heap.h"
#include "app/method_option.h"
#include "app/output.h"
#include "app/prepared.h"
#include "app/step_option.h"
#include "app/with_option.h"
#include "core/identification/by_step.h"
#include "core/identification/cautions.h"
#include "core/input/input_error.h"
#include "reports/json/identification_json.h"
#include "reports/json/improved_json.h"
#include "reports/json/preparation_json.h"
#include "reports/json/uncertainty_json.h"
#include "reports/text/identification_text.h"
#include "reports/text/improved_text.h"
#include "reports/text/preparation_text.h"
#include "reports/text/uncertainty_text.h"

namespace stiffscope {

namespace {

struct Arguments {
  std::string campaign, json, method = "all", step;
  int subset_size = 0, bootstrap = 0;
  bool neglect_kc = false, raw = false, robust = false, postures = false;
  std::vector<std::string> with;
};

IdentifyOptions optionsOf(const Arguments& arguments, bool subset_given) {
  IdentifyOptions options;
  options.all_steps = arguments.step == "all";
  if (!options.all_steps) options.step = loadStepNamed(arguments.step, ", or all");
  options.finite_deflection = !arguments.neglect_kc;
  options.robust = arguments.robust;
  if (subset_given && arguments.subset_size < 1) {
    throw InputError({"--subset-size"}, std::to_string(arguments.subset_size), "expected 1 or more postures");
  }
  options.subsets.size = arguments.subset_size;
  constexpr int kMostDraws = 1'000'000;
  if (arguments.bootstrap < 0 || arguments.bootstrap > kMostDraws) {
    throw InputError({"--bootstrap"}, std::to_string(arguments.bootstrap), "expected 0 to 1000000 draws");
  }
  options.bootstrap.draws = arguments.bootstrap;
  return options;
}

/// The best method there is among those asked for, for what is shown of one method only.
std::optional<Method> bestOf(const Identification& result, const std::vector<Method>& methods) {
  for (const Method which : {Method::decoupled_partial_pose, Method::partial_pose, Method::complete_pose}) {
    if (result.of(which).available && std::find(methods.begin(), methods.end(), which) != methods.end()) return which;
  }
  return std::nullopt;
}

int identifyCampaign(const Arguments& arguments, bool subset_given) {
  useLargeHeapPages();
  const std::vector<Method> methods = methodsNamed(arguments.method);
  const IdentifyOptions options = optionsOf(arguments, subset_given);
  const PreparedCampaign prepared = openPrepared(arguments.campaign, arguments.raw, hashesFor(arguments.json));
  std::optional<ImprovedModel> improved;
  if (!arguments.with.empty()) improved = improveModel(prepared.campaign, effectsAsked(prepared, arguments.with), options);
  const Campaign& campaign = improved ? improved->campaign : prepared.campaign;
  const Identification result = improved ? improved->with : identify(campaign, options);
  if (options.subsets.size >= static_cast<int>(result.cases.size()) && !result.cases.empty()) {
    throw InputError({"--subset-size"}, std::to_string(options.subsets.size),
                     fmt::format("expected fewer than the {} postures that identify", result.cases.size()));
  }
  // With a dozen load steps several times the work of the rest, and only shown where asked for.
  const bool steps_shown = options.all_steps || !arguments.json.empty();
  const StepStudy steps = steps_shown ? studySteps(campaign, options, result) : StepStudy{};
  const auto text = [&] {
    std::string all = identificationText(campaign, result, methods);
    if (options.all_steps) all += stepsText(steps, result, methods);
    if (const auto best = bestOf(result, methods); best && arguments.postures) all += posturesText(campaign, result, *best);
    if (improved) all += improvedText(*improved, methods);
    return all + preparationText(prepared.preparation);
  };
  deliver([&] {
    JsonDocument document = identificationJson(campaign, result, methods);
    document.json = withSteps(std::move(document.json), steps, result, methods);
    if (improved) document.json = withEffects(std::move(document.json), *improved, methods);
    document.json = withPreparation(std::move(document.json), prepared.preparation);
    return document;
  }, text, arguments.json);
  return anyUsable(result, methods) ? kDone : kNotUsable;
}

}  // namespace

void addIdentify(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("identify", "Joint stiffness by Complete, Partial and Decoupled Partial Pose");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command->add_option("--method", arguments->method, "cp, pp, dpp or all")->capture_default_str();
  command->add_option("--step", arguments->step,
                      "load step to identify from, or all of them together; without it the one with the largest mean force");
  const CLI::Option* subset = command->add_option("--subset-size", arguments->subset_size,
                      "postures that identify in Table II's subsets; without it 10 of 19, in proportion");
  command->add_flag("--neglect-kc", arguments->neglect_kc,
                    "neglect K_c and take Jacobians at the unloaded arm, as the paper does");
  command->add_flag("--robust", arguments->robust,
                    "leave postures out that disagree with the rest; without it they are only named");
  command->add_option("--bootstrap", arguments->bootstrap,
                      "draws of the postures for percentile intervals beside the stated ones");
  command->add_flag("--postures", arguments->postures, "Cartesian stiffness and the share of K_c, posture by posture");
  addWithOption(*command, arguments->with);
  addRawOption(*command, arguments->raw);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, subset, &run] {
    run = [arguments, subset_given = subset->count() > 0] {
      return identifyCampaign(*arguments, subset_given);
    };
  });
}

}  // namespace stiffscope
