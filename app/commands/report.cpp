#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <list>
#include <memory>
#include <optional>
#include <utility>

#include "app/command_line.h"
#include "app/figures/make_figures.h"
#include "app/options.h"
#include "app/output.h"
#include "app/prepared.h"
#include "app/report_files.h"
#include "app/versions.h"
#include "core/audit/audit.h"
#include "core/audit/check_design.h"
#include "core/diagnosis/diagnose.h"
#include "core/identification/load_case.h"
#include "core/identification/warnings.h"
#include "reports/page/html.h"
#include "reports/page/report_page.h"
#include "reports/words/extended_model_words.h"
#include "reports/words/verdict.h"

namespace stiffscope::app {

namespace {

struct Arguments {
  std::vector<std::string> campaigns;
  std::string out, step;
  bool neglect_kc = false, paper = false, raw = false;
  std::vector<std::string> with;
};

/// Takes away the rows that are load cases by now: neither page nor picture shows them, and they are most of a long day.
void withoutLoadReadings(campaign::Campaign& campaign) {
  const auto let_go = [](auto& table) {
    if (table) table->rows = decltype(table->rows)();
  };
  let_go(campaign.loading);
  let_go(campaign.states);
  let_go(campaign.displacements);
}

/// What is used of one campaign and what comes of it. A campaign without loads gives its frames.
struct Result {
  preparation::PreparedCampaign prepared;
  audit::AuditReport audited;
  std::optional<diagnosis::Diagnosis> diagnosis;
  std::optional<extended_model::ImprovedModel> improved;  ///< effects were asked for
  identification::Identification own;                     ///< without any
  bool loaded = false;

  const campaign::Campaign& campaign() const { return improved ? improved->campaign : prepared.campaign; }
  const identification::Identification& identification() const { return improved ? improved->with : own; }

  Result(const std::string& folder, const Arguments& arguments, const identification::IdentifyOptions& options) {
    campaign::Campaign read = openCampaign(folder);
    const bool loads = identification::whatLoadsLack(read).empty();
    campaign::Campaign used = loads ? read : std::move(read);  // sweeps alone may be a million readings: once is enough
    prepared = arguments.raw ? preparation::leaveRaw(std::move(used)) : preparation::prepareCampaign(std::move(used));
    loaded = identification::whatLoadsLack(prepared.campaign).empty();
    // First of all: of a long day it lets most of what was read go.
    if (loaded) diagnosis = diagnosis::diagnose(std::move(read));
    read = campaign::Campaign();
    if (loaded && !arguments.with.empty()) {
      improved = extended_model::improveModel(prepared.campaign, effectsAsked(prepared, arguments.with), options);
    } else {
      own = loaded ? identification::identify(prepared.campaign, options) : identification::framesAlone(prepared.campaign);
    }
    audited = arguments.raw ? audit::audit(prepared.campaign) : audit::audit(prepared);
    if (diagnosis) audit::addSeparableEffects(*diagnosis, audited);
    withoutLoadReadings(prepared.campaign);
    if (improved) withoutLoadReadings(improved->campaign);
  }

  /// Of loads, stiffnesses are the purpose; of a day of sweeps alone, the frames.
  bool usable() const {
    return loaded ? identification::anyUsable(identification(), {identification::kMethods.begin(), identification::kMethods.end()})
                  : identification().frames.arm.points_placed;
  }
};

/// "10 of 19, 12 of 24": of each campaign that has subsets.
std::string subsetSizes(const std::list<Result>& results) {
  std::string sizes;
  for (const Result& one : results) {
    for (const identification::MethodResult& method : one.identification().methods) {
      if (method.subsets.compliances.empty()) continue;
      sizes += fmt::format("{}{} of {}", sizes.empty() ? "" : ", ", method.subsets.size, method.subsets.of);
      break;
    }
  }
  return sizes.empty() ? "too few" : sizes;
}

std::vector<reports::NamedText> settingsOf(const identification::IdentifyOptions& options, const std::list<Result>& results) {
  return {{"load step", options.step ? std::to_string(*options.step) : "the one with the largest mean force"},
          {"geometric stiffness K_{c}", options.finite_deflection ? "included" : "neglected"},
          {"postures in a subset", subsetSizes(results)},
          {"subsets", "all up to 250 000, else a sample with seed 1"}};
}

/// What the page says first of the effects in the model, campaign by campaign.
void addImproved(const std::vector<std::string>& words, const std::list<Result>& results, reports::ReportContent& content) {
  if (words.empty()) return;
  content.settings.push_back({"effects in the model", reports::asIs(fmt::format("{}", fmt::join(words, ", ")))});
  content.settings.push_back({"subsets with effects", "all up to 1000, else a sample with seed 1"});
  for (const Result& one : results) {
    if (one.improved) content.verdict += " " + reports::asIs(reports::gainWords(*one.improved));
  }
}

int writeReport(const Arguments& arguments) {
  requireNoCampaign(arguments.out, "expected a folder of the report's own");
  identification::IdentifyOptions options;
  options.step = loadStepNamed(arguments.step);
  options.finite_deflection = !arguments.neglect_kc;
  std::list<Result> results;  // a list: the content refers to its elements
  reports::ReportContent content;
  for (const std::string& folder : arguments.campaigns) {
    const Result& one = results.emplace_back(folder, arguments, options);
    content.campaigns.push_back(
        {one.campaign(), one.identification(), &one.audited, &one.prepared.preparation, &one.prepared.station,
         one.diagnosis ? &*one.diagnosis : nullptr, one.improved ? &*one.improved : nullptr});
  }
  content.avoided = reports::avoidedByEncoders(content.campaigns);
  content.compare_with_paper = arguments.paper;
  content.versions = versions();
  content.settings = settingsOf(options, results);
  content.title = "Joint stiffness";
  content.verdict = reports::verdictOf(content.campaigns, content.avoided);
  addImproved(arguments.with, results, content);
  content.figures = makeFigures(content.campaigns, {arguments.paper});

  // Everything is made before the first file is written, and appears at once.
  const page::ReportPage page = page::makeReportPage(content);
  writeReportFiles(arguments.out, content, page);
  printText((std::filesystem::path(arguments.out) / "report.html").string() + '\n');
  const bool usable =
      std::any_of(results.begin(), results.end(), [](const Result& one) { return one.usable(); });
  return usable ? kDone : kNotUsable;
}

}  // namespace

void addReport(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("report", "Everything as one page with its pictures");
  command->add_option("CAMPAIGN", arguments->campaigns, "campaign folders; two of one machine are compared")
      ->required()
      ->expected(1, 8);
  command->add_option("--out", arguments->out, "folder for report.html, results.json, the pictures and the tables as CSV")->required();
  command->add_option("--step", arguments->step, "load step to identify from");
  command->add_flag("--neglect-kc", arguments->neglect_kc, "neglect K_c, as the paper does");
  addWithOption(*command, arguments->with);
  addRawOption(*command, arguments->raw);
  command->add_flag("--paper", arguments->paper, "put the figures of Ambiehl et al. (IROS 2017) beside these");
  command->callback([arguments, &run] {
    run = [arguments] { return writeReport(*arguments); };
  });
}

}  // namespace stiffscope::app
