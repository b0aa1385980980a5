#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/command_line.h"
#include "app/model.h"
#include "app/options.h"
#include "app/output.h"
#include "app/prepared.h"
#include "core/compensation/compensate.h"
#include "core/extended_model/effect_deflection.h"
#include "core/extended_model/extended_model.h"
#include "core/identification/identification.h"
#include "core/identification/identify.h"
#include "core/io/input_error.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/text/text.h"
#include "reports/words/names.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

namespace {

struct CompensateArguments {
  std::string campaign, postures, json, method, step;
  bool raw = false;
  ModelChoice model;
};

int compensateCampaign(const CompensateArguments& arguments) {
  std::vector<identification::Method> methods;
  if (!arguments.method.empty()) methods = methodsNamed(arguments.method);
  if (methods.size() > 1) throw io::InputError({"--method"}, arguments.method, "expected one of cp, pp or dpp");
  identification::IdentifyOptions options;
  options.step = loadStepNamed(arguments.step);
  const preparation::PreparedCampaign prepared = openPrepared(arguments.campaign, arguments.raw);
  requireLoad(prepared.campaign);
  const std::optional<extended_model::ExtendedModel> improved = modelOf(prepared, arguments.model, options);
  const campaign::Campaign& campaign = improved ? improved->campaign : prepared.campaign;
  const identification::Identification result = improved ? improved->with : identification::identify(campaign, options);
  if (methods.empty()) methods = {identification::bestMethod(result)};
  const identification::MethodResult& method = result.of(methods.front());
  if (!method.available) {
    throw io::InputError(
        {arguments.campaign}, "",
        std::string(reports::namesOf(methods.front()).full) + " is unavailable here: " + reports::words(method.reason));
  }
  std::vector<std::string> warnings;
  const std::vector<compensation::PostureToCompensate> asked =
      arguments.postures.empty() ? compensation::campaignPostures(campaign, result.step)
                                 : compensation::readPostures(arguments.postures, warnings);
  printWarnings(warnings);
  std::optional<effects::EffectDeflection> give;
  if (improved && extended_model::deflectsByEffects(improved->effects))
    give = extended_model::effectDeflection(*improved, methods.front());
  const std::vector<compensation::CompensatedPosture> rows = compensation::compensate(
      campaign, method.geometry, method.estimate, result.frames.tcp_in_flange, asked, {}, give ? &*give : nullptr);
  std::vector<std::string> cautions = reports::words(result.cautions);
  for (const Remark& caution : compensation::implausibleCommands(rows)) cautions.push_back(reports::words(caution));
  deliver(
      [&] {
        reports::Json json = reports::compensationJson(campaign, methods.front(), rows);
        json["cautions"] = cautions;
        if (improved) json = reports::withEffects(std::move(json), *improved, methods);
        return reports::withPreparation(std::move(json), prepared.preparation);
      },
      [&] {
        return reports::compensationText(campaign, methods.front(), rows, cautions) +
               (improved ? reports::extendedModelText(*improved, methods) : "") +
               reports::preparationText(prepared.preparation);
      },
      arguments.json);
  const bool any =
      std::any_of(rows.begin(), rows.end(), [](const compensation::CompensatedPosture& row) { return row.solved; });
  return any ? kDone : kNotUsable;
}

}  // namespace

void addCompensate(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<CompensateArguments>();
  CLI::App* command = app.add_subcommand("compensate", "Predicted deflection, and the joint commands that cancel it");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command->add_option(
      "--postures", arguments->postures,
      "CSV with pose, q1_deg..q6_deg and the load-cell reading fx_n..mz_nm expected there; without it the "
      "campaign's own");
  command->add_option("--method", arguments->method, "cp, pp or dpp; without it the best that is available, dpp first");
  command->add_option("--step", arguments->step, "load step to identify from");
  addModelOptions(*command, arguments->model);
  addRawOption(*command, arguments->raw);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] { run = [arguments] { return compensateCampaign(*arguments); }; });
}

}  // namespace stiffscope::app
