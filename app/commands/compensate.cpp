#include <CLI/CLI.hpp>
#include <memory>

#include "app/command_line.h"
#include "app/identified.h"
#include "app/model.h"
#include "app/output.h"
#include "app/prepared.h"
#include "core/compensation/compensate.h"
#include "core/extended_model/extended_model.h"
#include "core/identification/identification.h"
#include "reports/json/campaign_json.h"
#include "reports/json/identification_json.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/text/text.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
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
  const MethodAndStep choice = methodAndStep(arguments.method, arguments.step);
  const preparation::PreparedCampaign prepared = openPrepared(arguments.campaign, arguments.raw);
  Identified found = identifiedBy(prepared, arguments.campaign, arguments.model, choice);
  const std::optional<extended_model::ExtendedModel>& improved = found.improved;
  const campaign::Campaign& campaign = found.campaign(prepared);
  const identification::Identification& result = found.result();
  const std::vector<identification::Method> methods{found.method};
  const std::optional<identification::ShownFirst>& first = found.shown_first;
  std::vector<std::string> warnings;
  const std::vector<compensation::PostureToCompensate> asked =
      arguments.postures.empty() ? compensation::campaignPostures(campaign, result.step)
                                 : compensation::readPostures(arguments.postures, warnings);
  printWarnings(warnings);
  std::vector<compensation::CompensatedPosture> rows;
  std::vector<campaign::KnownStiffness> known;
  {
    const PredictedArm predicted(campaign, found.improved, found.result(), found.method);
    const workspace::DeflectingArm& arm = predicted.arm();
    rows = compensation::compensate(campaign, arm.geometry, arm.estimate, arm.tcp_in_flange, asked, {}, arm.with,
                                    &arm.certainty);
    known = predicted.known();
  }
  const compensation::CompensationSummary summary = compensation::summaryOf(rows);
  std::vector<std::string> cautions = reports::words(result.cautions);
  for (const Remark& caution : compensation::implausibleCommands(rows)) cautions.push_back(reports::words(caution));
  deliver(
      [&] {
        reports::Json json = reports::compensationJson(campaign, methods.front(), rows, known);
        json["shown_first"] = reports::shownFirstJson(first);
        json["cautions"] = cautions;
        if (improved) json = reports::withEffects(std::move(json), *improved, methods);
        return reports::withPreparation(std::move(json), prepared.preparation);
      },
      [&] {
        return reports::compensationText(campaign, methods.front(), rows, known, cautions) +
               (first ? reports::wrapped(reports::shownFirstWords(result, *first), 2) + "\n" : "") +
               (improved ? reports::extendedModelText(*improved, methods) : "") +
               reports::preparationText(prepared.preparation);
      },
      arguments.json);
  return summary.mostRefused() ? kNotUsable : kDone;
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
  command->add_option("--method", arguments->method, "cp, pp or dpp; without it the one that identify shows first");
  command->add_option("--step", arguments->step, "load step to identify from");
  addModelOptions(*command, arguments->model);
  addRawOption(*command, arguments->raw);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] { run = [arguments] { return compensateCampaign(*arguments); }; });
}

}  // namespace stiffscope::app
