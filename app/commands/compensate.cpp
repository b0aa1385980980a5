#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/command.h"
#include "app/method_option.h"
#include "app/output.h"
#include "app/prepared.h"
#include "app/step_option.h"
#include "app/with_option.h"
#include "core/compensation/implausible_commands.h"
#include "core/compensation/postures_table.h"
#include "core/identification/best_method.h"
#include "core/improved/predicted_give.h"
#include "core/input/input_error.h"
#include "reports/json/compensation_json.h"
#include "reports/json/improved_json.h"
#include "reports/json/preparation_json.h"
#include "reports/method_names.h"
#include "reports/text/compensation_text.h"
#include "reports/text/improved_text.h"
#include "reports/text/preparation_text.h"

namespace stiffscope {

namespace {

struct Arguments {
  std::string campaign, postures, json, method, step;
  bool raw = false;
  std::vector<std::string> with;
};

int compensateCampaign(const Arguments& arguments) {
  std::vector<Method> methods;
  if (!arguments.method.empty()) methods = methodsNamed(arguments.method);
  if (methods.size() > 1) throw InputError({"--method"}, arguments.method, "expected one of cp, pp or dpp");
  IdentifyOptions options;
  options.step = loadStepNamed(arguments.step);
  const PreparedCampaign prepared = openPrepared(arguments.campaign, arguments.raw);
  std::optional<ImprovedModel> improved;
  if (!arguments.with.empty()) improved = improveModel(prepared.campaign, effectsAsked(prepared, arguments.with), options);
  const Campaign& campaign = improved ? improved->campaign : prepared.campaign;
  const Identification result = improved ? improved->with : identify(campaign, options);
  if (methods.empty()) methods = {bestMethod(result)};
  const MethodResult& method = result.of(methods.front());
  if (!method.available) {
    throw InputError({arguments.campaign}, "", std::string(namesOf(methods.front()).full) + " is unavailable here: " + method.reason);
  }
  std::vector<std::string> warnings;
  const std::vector<PostureToCompensate> asked = arguments.postures.empty()
                                                     ? campaignPostures(campaign, result.step)
                                                     : readPostures(arguments.postures, warnings);
  printWarnings(warnings);
  std::optional<FurtherGive> give;
  if (improved && givesFurther(improved->effects)) give = furtherGive(*improved, methods.front());
  const std::vector<CompensatedPosture> rows = compensate(campaign, method.geometry, method.estimate,
                                                          result.frames.tcp_in_flange, asked, {}, give ? &*give : nullptr);
  std::vector<std::string> cautions = result.cautions;
  for (std::string& sentence : implausibleCommands(rows)) cautions.push_back(std::move(sentence));
  deliver(
      [&] {
        Json json = compensationJson(campaign, methods.front(), rows);
        json["cautions"] = cautions;
        if (improved) json = withEffects(std::move(json), *improved, methods);
        return withPreparation(std::move(json), prepared.preparation);
      },
      [&] {
        return compensationText(campaign, methods.front(), rows, cautions) +
               (improved ? improvedText(*improved, methods) : "") + preparationText(prepared.preparation);
      },
      arguments.json);
  const bool any = std::any_of(rows.begin(), rows.end(), [](const CompensatedPosture& row) { return row.solved; });
  return any ? kDone : kNotUsable;
}

}  // namespace

void addCompensate(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("compensate", "Predicted deflection, and the joint commands that cancel it");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command->add_option("--postures", arguments->postures,
                      "CSV with pose, q1_deg..q6_deg and the load-cell reading fx_n..mz_nm expected there; without it the "
                      "campaign's own");
  command->add_option("--method", arguments->method, "cp, pp or dpp; without it the best that is available, dpp first");
  command->add_option("--step", arguments->step, "load step to identify from");
  addWithOption(*command, arguments->with);
  addRawOption(*command, arguments->raw);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] {
    run = [arguments] { return compensateCampaign(*arguments); };
  });
}

}  // namespace stiffscope
