#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "app/command_line.h"
#include "app/model.h"
#include "app/options.h"
#include "app/output.h"
#include "app/prepared.h"
#include "core/campaign/state_points.h"
#include "core/comparison/compare.h"
#include "core/comparison/geometry_change.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/report_content.h"
#include "reports/text/text.h"
#include "reports/words/preparation_words.h"

namespace stiffscope::app {

namespace {

struct CompareArguments {
  std::string before, after, json, step;
  bool neglect_kc = false, raw = false;
  ModelChoice model;
  comparison::BootstrapOptions bootstrap;
};

/// One state: by joint springs alone, and by the model asked for.
struct Day {
  std::optional<extended_model::ExtendedModel> model;
  std::optional<identification::Identification> own;  ///< where no model was asked for

  const identification::Identification& springs() const { return model ? model->without : *own; }
};

Day dayOf(const preparation::PreparedCampaign& prepared, const ModelChoice& choice,
          const identification::IdentifyOptions& options) {
  Day day;
  day.model = modelOf(prepared, choice, options);
  if (!day.model) day.own = identification::identify(prepared.campaign, options);
  return day;
}

/// What was done to the readings of both.
reports::Json preparations(const preparation::PreparedCampaign& before, const preparation::PreparedCampaign& after) {
  return {reports::preparationJson(before.preparation), reports::preparationJson(after.preparation)};
}

std::string preparationsText(const preparation::PreparedCampaign& before, const preparation::PreparedCampaign& after) {
  std::string text;
  for (const preparation::PreparedCampaign* one : {&before, &after})
    text += one->campaign.name + ". " + reports::preparationText(one->preparation);
  return text;
}

/// Two days without a load: what moved in the arm itself.
int compareUnloaded(const CompareArguments& arguments, const preparation::PreparedCampaign& before,
                    const preparation::PreparedCampaign& after) {
  const comparison::GeometryChange change = comparison::compareGeometry(before.campaign, after.campaign);
  deliver(
      [&] {
        reports::Json json = reports::geometryChangeJson(before.campaign, after.campaign, change);
        json["preparation"] = preparations(before, after);
        return json;
      },
      [&] {
        return reports::geometryChangeText(before.campaign, after.campaign, change) + preparationsText(before, after);
      },
      arguments.json);
  return change.reason.empty() ? kDone : kNotUsable;
}

int compareTwo(const CompareArguments& arguments) {
  identification::IdentifyOptions options;
  options.step = loadStepNamed(arguments.step);
  options.finite_deflection = !arguments.neglect_kc;
  const preparation::PreparedCampaign prepared_before = openPrepared(arguments.before, arguments.raw);
  const preparation::PreparedCampaign prepared_after = openPrepared(arguments.after, arguments.raw);
  const campaign::Campaign &before = prepared_before.campaign, &after = prepared_after.campaign;
  if (campaign::isUnloadedDay(before) && campaign::isUnloadedDay(after))
    return compareUnloaded(arguments, prepared_before, prepared_after);
  const Day first = dayOf(prepared_before, arguments.model, options);
  const Day second = dayOf(prepared_after, arguments.model, options);
  const comparison::Comparison comparison = comparison::compareCampaigns(
      before, first.springs(), after, second.springs(),
      reports::supportedModels(first.model ? &*first.model : nullptr, second.model ? &*second.model : nullptr),
      arguments.bootstrap);
  deliver(
      [&] {
        reports::Json json = reports::comparisonJson(before, after, comparison);
        json["preparation"] = preparations(prepared_before, prepared_after);
        return json;
      },
      [&] {
        return reports::comparisonText(before, after, comparison) + preparationsText(prepared_before, prepared_after);
      },
      arguments.json);
  return comparison.comparable ? kDone : kNotUsable;
}

}  // namespace

void addCompare(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand("compare", "Two states of one machine: compliances, and deflection avoided");
  command->footer(
      "States the difference of compliances first, with U (95 %): where both campaigns measured the same postures, "
      "what\n"
      "the model misses cancels in it. Then the ratio of stiffnesses (in brackets where it keeps the bias of both), "
      "the\n"
      "p-value of each joint and the same corrected for the joints tested (Holm), what is taken away of each "
      "compliance\n"
      "and what that avoids of the deflection at the reflectors. Stiffnesses before and after are those of identify;\n"
      "where no postures correspond, the differences too. Two days without a load: what moved in the arm's geometry\n"
      "(joint zeros, lengths, angles of axes), how significant it is, and which single cause explains it.\n"
      "docs/method.md has the formulas.");
  command->add_option("BEFORE", arguments->before, "campaign before, or with the double encoders inactive")->required();
  command->add_option("AFTER", arguments->after, "campaign after, or with the double encoders active")->required();
  command->add_option("--step", arguments->step, "load step of both to identify from");
  command->add_flag("--neglect-kc", arguments->neglect_kc, "neglect K_c, as the paper does");
  addModelOptions(*command, arguments->model);
  addRawOption(*command, arguments->raw);
  command->add_option("--seed", arguments->bootstrap.seed, "of the bootstrap over postures")->capture_default_str();
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] { run = [arguments] { return compareTwo(*arguments); }; });
}

}  // namespace stiffscope::app
