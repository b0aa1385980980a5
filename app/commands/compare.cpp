#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "app/command_line.h"
#include "app/computations.h"
#include "app/figures/result_charts.h"
#include "app/model.h"
#include "app/options.h"
#include "app/output.h"
#include "app/prepared.h"
#include "core/campaign/state_points.h"
#include "core/comparison/compare.h"
#include "core/comparison/geometry_change.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/write_file.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/page/pages.h"
#include "reports/report_content.h"
#include "reports/stated_results.h"
#include "reports/text/text.h"
#include "reports/words/preparation_words.h"

namespace stiffscope::app {

namespace {

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
int compareUnloaded(const preparation::PreparedCampaign& before, const preparation::PreparedCampaign& after,
                    const Outlet& outlet) {
  const comparison::GeometryChange change = comparison::compareGeometry(before.campaign, after.campaign);
  outlet.deliver(
      [&] {
        reports::Json json = reports::geometryChangeJson(before.campaign, after.campaign, change);
        json["preparation"] = preparations(before, after);
        return json;
      },
      [&] {
        return reports::geometryChangeText(before.campaign, after.campaign, change) + preparationsText(before, after);
      });
  return change.reason.empty() ? kDone : kNotUsable;
}

/// Two result files. kNotUsable where the machines differ; then no page is written.
int compareResults(const std::string& before, const std::string& after, const std::string& html, const Outlet& outlet) {
  const reports::StatedComparison comparison =
      reports::compareStated(reports::readStatedCampaign(before), reports::readStatedCampaign(after));
  if (comparison.refused.empty() && !html.empty()) {
    io::requireNotRead(html);
    io::writeFileWhole(html, page::comparisonPage(comparison, statedCharts(comparison)));
  }
  outlet.deliver([&] { return reports::statedComparisonJson(comparison); },
                 [&] { return reports::statedComparisonText(comparison); });
  return comparison.refused.empty() ? kDone : kNotUsable;
}

}  // namespace

int compareTwo(const CompareRequest& request, const CampaignSource& source_before, const CampaignSource& source_after,
               const Outlet& outlet) {
  identification::IdentifyOptions options;
  options.step = loadStepNamed(request.step);
  options.finite_deflection = !request.neglect_kc;
  comparison::BootstrapOptions bootstrap;
  bootstrap.seed = request.seed;
  const auto opened_before = source_before.open(), opened_after = source_after.open();
  const preparation::PreparedCampaign &prepared_before = *opened_before, &prepared_after = *opened_after;
  const campaign::Campaign &before = prepared_before.campaign, &after = prepared_after.campaign;
  if (campaign::isUnloadedDay(before) && campaign::isUnloadedDay(after))
    return compareUnloaded(prepared_before, prepared_after, outlet);
  const Day first = dayOf(prepared_before, request.model, options);
  const Day second = dayOf(prepared_after, request.model, options);
  const comparison::Comparison comparison = comparison::compareCampaigns(
      before, first.springs(), after, second.springs(),
      reports::supportedModels(first.model ? &*first.model : nullptr, second.model ? &*second.model : nullptr),
      bootstrap);
  outlet.deliver(
      [&] {
        reports::Json json = reports::comparisonJson(before, after, comparison);
        json["preparation"] = preparations(prepared_before, prepared_after);
        return json;
      },
      [&] {
        return reports::comparisonText(before, after, comparison) + preparationsText(prepared_before, prepared_after);
      });
  return comparison.comparable ? kDone : kNotUsable;
}

void addCompare(CLI::App& app, Run& run) {
  struct CompareArguments {
    std::string before, after, json, html;
    bool raw = false;
    CompareRequest request;
  };
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command =
      app.add_subcommand("compare", "Two states of one machine: compliances, and deflection avoided; or two results");
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
      "docs/method.md has the formulas. Two result files instead of campaigns (results.json of report, or --json of\n"
      "audit, frames, identify, calibrate, diagnose; FILE.json#2 is the second campaign in one) are put side by side "
      "as\n"
      "they stand, matched by joint and posture, also as a page by --html: docs/results.md.");
  command
      ->add_option("BEFORE", arguments->before,
                   "campaign before, or with the double encoders inactive; or a results.json")
      ->required();
  command
      ->add_option("AFTER", arguments->after, "campaign after, or with the double encoders active; or a results.json")
      ->required();
  command->add_option("--step", arguments->request.step, "load step of both to identify from");
  command->add_flag("--neglect-kc", arguments->request.neglect_kc, "neglect K_c, as the paper does");
  addModelOptions(*command, arguments->request.model);
  addRawOption(*command, arguments->raw);
  command->add_option("--seed", arguments->request.seed, "of the bootstrap over postures")->capture_default_str();
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->add_option("--html", arguments->html, "of two result files: write the page of them to this file");
  command->callback([arguments, command, &run] {
    run = [arguments, command] {
      requireOwnFiles({{"--html", arguments->html}, {"--json", arguments->json}});
      const bool first = reports::namesResults(arguments->before), second = reports::namesResults(arguments->after);
      if (first && second) {
        // What results are of is decided: nothing is identified anew.
        for (const char* const option : {"--step", "--neglect-kc", "--with", "--springs-only", "--raw", "--seed"}) {
          if (command->count(option) == 0) continue;
          throw io::InputError({option}, "", "expected two campaigns; of result files nothing is identified anew");
        }
        return compareResults(arguments->before, arguments->after, arguments->html, commandLineOutlet(arguments->json));
      }
      if (first != second)
        throw io::InputError({first ? arguments->after : arguments->before}, "",
                             "expected a result file, as the other one is, or a campaign for both");
      if (!arguments->html.empty())
        throw io::InputError({"--html"}, arguments->html,
                             "expected two result files; `report` writes one of a campaign, results.json");
      return compareTwo(arguments->request, sourceOf(arguments->before, arguments->raw),
                        sourceOf(arguments->after, arguments->raw), commandLineOutlet(arguments->json));
    };
  });
}

}  // namespace stiffscope::app
