#include <CLI/CLI.hpp>
#include <memory>

#include "app/command.h"
#include "app/method_option.h"
#include "app/output.h"
#include "app/prepared.h"
#include "core/identification/cautions.h"
#include "core/input/input_error.h"
#include "reports/json/identification_json.h"
#include "reports/json/preparation_json.h"
#include "reports/text/identification_text.h"
#include "reports/text/preparation_text.h"

namespace stiffscope {

namespace {

struct Arguments {
  std::string campaign, json, method = "all";
  int step = 0, subset_size = 0;
  bool neglect_kc = false, raw = false;
};

int identifyCampaign(const Arguments& arguments, bool step_given, bool subset_given) {
  const std::vector<Method> methods = methodsNamed(arguments.method);
  const PreparedCampaign prepared = openPrepared(arguments.campaign, arguments.raw);
  const Campaign& campaign = prepared.campaign;
  IdentifyOptions options;
  if (step_given) options.step = arguments.step;
  options.finite_deflection = !arguments.neglect_kc;
  if (subset_given && arguments.subset_size < 1) {
    throw InputError({"--subset-size"}, std::to_string(arguments.subset_size), "expected 1 or more postures");
  }
  options.subsets.size = arguments.subset_size;
  const Identification result = identify(campaign, options);
  deliver([&] { return withPreparation(identificationJson(campaign, result, methods), prepared.preparation); },
          [&] { return identificationText(campaign, result, methods) + preparationText(prepared.preparation); },
          arguments.json);
  return anyUsable(result, methods) ? kDone : kNotUsable;
}

}  // namespace

void addIdentify(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("identify", "Joint stiffness by Complete, Partial and Decoupled Partial Pose");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command->add_option("--method", arguments->method, "cp, pp, dpp or all")->capture_default_str();
  const CLI::Option* step = command->add_option(
      "--step", arguments->step, "load step to identify from; without it the one with the largest mean force");
  const CLI::Option* subset = command->add_option("--subset-size", arguments->subset_size,
                      "postures that identify in Table II's subsets; without it 10 of 19, in proportion");
  command->add_flag("--neglect-kc", arguments->neglect_kc,
                    "neglect K_c and take Jacobians at the unloaded arm, as the paper does");
  addRawOption(*command, arguments->raw);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, step, subset, &run] {
    run = [arguments, step_given = step->count() > 0, subset_given = subset->count() > 0] {
      return identifyCampaign(*arguments, step_given, subset_given);
    };
  });
}

}  // namespace stiffscope
