#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <list>
#include <memory>
#include <optional>
#include <utility>

#include "app/command.h"
#include "app/figures/make_figures.h"
#include "app/no_campaign_there.h"
#include "app/output.h"
#include "app/prepared.h"
#include "app/report_files.h"
#include "app/returned_memory.h"
#include "app/step_option.h"
#include "app/versions.h"
#include "app/with_option.h"
#include "core/audit/audit.h"
#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/separable_effects.h"
#include "core/identification/cautions.h"
#include "core/identification/load_step.h"
#include "reports/improved_words.h"
#include "reports/page/html.h"
#include "reports/page/report_page.h"
#include "reports/page/verdict.h"

namespace stiffscope {

namespace {

struct Arguments {
  std::vector<std::string> campaigns;
  std::string out, step;
  bool neglect_kc = false, paper = false, raw = false;
  std::vector<std::string> with;
};

/// Takes away the rows that are load cases by now: neither page nor picture shows them, and they are most of a long day.
void withoutLoadReadings(Campaign& campaign) {
  const auto let_go = [](auto& table) {
    if (table) table->rows = decltype(table->rows)();
  };
  let_go(campaign.loading);
  let_go(campaign.states);
  let_go(campaign.displacements);
}

/// What is used of one campaign and what comes of it. A campaign without loads gives its frames.
struct Result {
  PreparedCampaign prepared;
  AuditReport audited;
  std::optional<Diagnosis> diagnosis;
  std::optional<ImprovedModel> improved;  ///< effects were asked for
  Identification own;                     ///< without any
  bool loaded = false;

  const Campaign& campaign() const { return improved ? improved->campaign : prepared.campaign; }
  const Identification& identification() const { return improved ? improved->with : own; }

  Result(const std::string& folder, const Arguments& arguments, const IdentifyOptions& options) {
    Campaign read = openCampaign(folder);
    const bool loads = whatLoadsLack(read).empty();
    Campaign used = loads ? read : std::move(read);  // sweeps alone may be a million readings: once is enough
    prepared = arguments.raw ? leaveRaw(std::move(used)) : prepareCampaign(std::move(used));
    loaded = whatLoadsLack(prepared.campaign).empty();
    // First of all: of a long day it lets most of what was read go.
    if (loaded) diagnosis = diagnose(std::move(read));
    read = Campaign();
    returnFreeMemory();
    if (loaded && !arguments.with.empty()) {
      improved = improveModel(prepared.campaign, effectsAsked(prepared, arguments.with), options);
    } else {
      own = loaded ? identify(prepared.campaign, options) : framesAlone(prepared.campaign);
    }
    returnFreeMemory();
    audited = arguments.raw ? audit(prepared.campaign) : audit(prepared);
    if (diagnosis) addSeparableEffects(*diagnosis, audited);
    withoutLoadReadings(prepared.campaign);
    if (improved) withoutLoadReadings(improved->campaign);
  }

  /// Of loads, stiffnesses are the purpose; of a day of sweeps alone, the frames.
  bool usable() const {
    return loaded ? anyUsable(identification(), {kMethods.begin(), kMethods.end()})
                  : identification().frames.arm.points_placed;
  }
};

/// "10 of 19, 12 of 24": of each campaign that has subsets.
std::string subsetSizes(const std::list<Result>& results) {
  std::string sizes;
  for (const Result& one : results) {
    for (const MethodResult& method : one.identification().methods) {
      if (method.subsets.compliances.empty()) continue;
      sizes += fmt::format("{}{} of {}", sizes.empty() ? "" : ", ", method.subsets.size, method.subsets.of);
      break;
    }
  }
  return sizes.empty() ? "too few" : sizes;
}

std::vector<NamedText> settingsOf(const IdentifyOptions& options, const std::list<Result>& results) {
  return {{"load step", options.step ? std::to_string(*options.step) : "the one with the largest mean force"},
          {"geometric stiffness K_{c}", options.finite_deflection ? "included" : "neglected"},
          {"postures in a subset", subsetSizes(results)},
          {"subsets", "all up to 250 000, else a sample with seed 1"}};
}

/// What the page says first of the effects in the model, campaign by campaign.
void addImproved(const std::vector<std::string>& words, const std::list<Result>& results, ReportContent& content) {
  if (words.empty()) return;
  content.settings.push_back({"effects in the model", page::asIs(fmt::format("{}", fmt::join(words, ", ")))});
  content.settings.push_back({"subsets with effects", "all up to 1000, else a sample with seed 1"});
  for (const Result& one : results) {
    if (one.improved) content.verdict += " " + page::asIs(gainWords(*one.improved));
  }
}

int writeReport(const Arguments& arguments) {
  requireNoCampaign(arguments.out, "expected a folder of the report's own");
  returnLargeBlocks();
  IdentifyOptions options;
  options.step = loadStepNamed(arguments.step);
  options.finite_deflection = !arguments.neglect_kc;
  std::list<Result> results;  // a list: the content refers to its elements
  ReportContent content;
  for (const std::string& folder : arguments.campaigns) {
    const Result& one = results.emplace_back(folder, arguments, options);
    content.campaigns.push_back(
        {one.campaign(), one.identification(), &one.audited, &one.prepared.preparation, &one.prepared.station,
         one.diagnosis ? &*one.diagnosis : nullptr, one.improved ? &*one.improved : nullptr});
  }
  content.avoided = avoidedByEncoders(content.campaigns);
  content.compare_with_paper = arguments.paper;
  content.versions = versions();
  content.settings = settingsOf(options, results);
  content.title = "Joint stiffness";
  content.verdict = verdictOf(content.campaigns, content.avoided);
  addImproved(arguments.with, results, content);
  returnFreeMemory();  // drawing brings libraries of a hundred megabytes
  content.figures = makeFigures(content.campaigns, {arguments.paper});

  // Everything is made before the first file is written, and appears at once.
  const ReportPage page = makeReportPage(content);
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

}  // namespace stiffscope
