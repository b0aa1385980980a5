#include <CLI/CLI.hpp>
#include <memory>

#include "app/command_line.h"
#include "app/computations.h"
#include "app/identified.h"
#include "app/model.h"
#include "app/output.h"
#include "app/prepared.h"
#include "core/compensation/compensate.h"
#include "core/extended_model/effect_deflection.h"
#include "core/extended_model/extended_model.h"
#include "core/identification/identification.h"
#include "core/identification/known_stiffness.h"
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

std::vector<compensation::PostureToCompensate> posturesOf(const CompensateRequest& request,
                                                          const campaign::Campaign& campaign, int step,
                                                          const Outlet& outlet) {
  if (request.postures) return *request.postures;
  if (request.postures_file.empty()) return compensation::campaignPostures(campaign, step);
  std::vector<std::string> warnings;
  const auto read = compensation::readPostures(request.postures_file, warnings);
  for (const std::string& warning : warnings) outlet.warn(warning);
  return read;
}

}  // namespace

int compensateCampaign(const CompensateRequest& request, const CampaignSource& source, const Outlet& outlet) {
  const MethodAndStep choice = methodAndStep(request.method, request.step);
  const auto opened = source.open();
  const preparation::PreparedCampaign& prepared = *opened;
  Identified found = identifiedBy(prepared, source.name, request.model, choice);
  const std::optional<extended_model::ExtendedModel>& improved = found.improved;
  const campaign::Campaign& campaign = found.campaign(prepared);
  const identification::Identification& result = found.result();
  identification::MethodResult& method = found.of_method();
  const std::vector<identification::Method> methods{found.method};
  const std::optional<identification::ShownFirst>& first = found.shown_first;
  const std::vector<compensation::PostureToCompensate> asked = posturesOf(request, campaign, result.step, outlet);
  // Every model that a prediction may come from takes what is known of joints that the day cannot see.
  std::vector<identification::StiffnessEstimate*> estimates{&method.estimate};
  if (found.improved)
    estimates.push_back(&found.improved->without.methods[static_cast<std::size_t>(methods.front())].estimate);
  std::vector<identification::StiffnessEstimate> of_the_day;
  std::vector<campaign::KnownStiffness> known;
  for (identification::StiffnessEstimate* estimate : estimates) {
    of_the_day.push_back(*estimate);
    known = identification::completeByKnown(campaign.known_stiffness, *estimate);
  }
  const double load_sd = campaign.load_cell->gain_sigma;
  const compensation::Certainty certainty = improved ? compensation::certaintyOf(*improved, methods.front(), load_sd)
                                                     : compensation::certaintyOf(result, methods.front(), load_sd);
  std::optional<effects::EffectDeflection> give;
  if (improved && extended_model::deflectsByEffects(improved->effects))
    give = extended_model::effectDeflection(*improved, methods.front());
  const std::vector<compensation::CompensatedPosture> rows =
      compensation::compensate(campaign, method.geometry, method.estimate, result.frames.tcp_in_flange, asked, {},
                               give ? &*give : nullptr, &certainty);
  const compensation::CompensationSummary summary = compensation::summaryOf(rows);
  // Tables of stiffnesses are of the day.
  for (std::size_t i = 0; i < estimates.size(); ++i) *estimates[i] = of_the_day[i];
  std::vector<std::string> cautions = reports::words(result.cautions);
  for (const Remark& caution : compensation::implausibleCommands(rows)) cautions.push_back(reports::words(caution));
  outlet.deliver(
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
      });
  return summary.mostRefused() ? kNotUsable : kDone;
}

void addCompensate(CLI::App& app, Run& run) {
  struct CompensateArguments {
    std::string campaign, json;
    bool raw = false;
    CompensateRequest request;
  };
  const auto arguments = std::make_shared<CompensateArguments>();
  CLI::App* command = app.add_subcommand("compensate", "Predicted deflection, and the joint commands that cancel it");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command->add_option(
      "--postures", arguments->request.postures_file,
      "CSV with pose, q1_deg..q6_deg and the load-cell reading fx_n..mz_nm expected there; without it the "
      "campaign's own");
  command->add_option("--method", arguments->request.method,
                      "cp, pp or dpp; without it the one that identify shows first");
  command->add_option("--step", arguments->request.step, "load step to identify from");
  addModelOptions(*command, arguments->request.model);
  addRawOption(*command, arguments->raw);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] {
    run = [arguments] {
      return compensateCampaign(arguments->request, sourceOf(arguments->campaign, arguments->raw),
                                commandLineOutlet(arguments->json));
    };
  });
}

}  // namespace stiffscope::app
