#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <list>
#include <memory>

#include "app/command.h"
#include "app/figures/make_figures.h"
#include "app/output.h"
#include "app/versions.h"
#include "core/identification/cautions.h"
#include "core/input/write_file.h"
#include "reports/json/results_json.h"
#include "reports/page/report_page.h"
#include "reports/page/verdict.h"

namespace stiffscope {

namespace {

struct Arguments {
  std::vector<std::string> campaigns;
  std::string out;
  int step = 0;
  bool neglect_kc = false, paper = false;
};

/// "10 of 19, 12 of 24": of each campaign that has subsets.
std::string subsetSizes(const std::list<Identification>& identifications) {
  std::string sizes;
  for (const Identification& one : identifications) {
    for (const MethodResult& method : one.methods) {
      if (method.subsets.compliances.empty()) continue;
      sizes += fmt::format("{}{} of {}", sizes.empty() ? "" : ", ", method.subsets.size, method.subsets.of);
      break;
    }
  }
  return sizes.empty() ? "too few" : sizes;
}

std::vector<NamedText> settingsOf(const IdentifyOptions& options,
                                  const std::list<Identification>& identifications) {
  return {{"load step", options.step ? std::to_string(*options.step) : "the one with the largest mean force"},
          {"geometric stiffness K_{c}", options.finite_deflection ? "included" : "neglected"},
          {"postures in a subset", subsetSizes(identifications)},
          {"subsets", "all up to 250 000, else a sample with seed 1"}};
}

int writeReport(const Arguments& arguments, bool step_given) {
  IdentifyOptions options;
  if (step_given) options.step = arguments.step;
  options.finite_deflection = !arguments.neglect_kc;
  std::list<Campaign> campaigns;  // lists: the content refers to their elements
  std::list<Identification> identifications;
  ReportContent content;
  for (const std::string& folder : arguments.campaigns) {
    campaigns.push_back(openCampaign(folder));
    identifications.push_back(identify(campaigns.back(), options));
    content.campaigns.push_back({campaigns.back(), identifications.back()});
  }
  content.avoided = avoidedShare(content.campaigns);
  content.compare_with_paper = arguments.paper;
  content.versions = versions();
  content.settings = settingsOf(options, identifications);
  content.title = "Joint stiffness";
  content.verdict = verdictOf(content.campaigns, content.avoided);
  content.figures = makeFigures(content.campaigns, {arguments.paper});

  // Everything is made before the first file is written; the page comes last.
  const ReportPage page = makeReportPage(content);
  const std::string results = resultsJson(content).dump(1) + '\n';
  const std::filesystem::path folder = arguments.out;
  makeFolder(folder);
  for (const Figure& figure : content.figures) {
    writeFileWhole(folder / (figure.id + ".png"),
                   {reinterpret_cast<const char*>(figure.png.data()), figure.png.size()});
  }
  writeFileWhole(folder / "results.json", results);
  makeFolder(folder / "tables");
  for (const TableFile& table : page.tables) writeFileWhole(folder / "tables" / (table.name + ".csv"), table.csv);
  writeFileWhole(folder / "report.html", page.html);
  std::printf("%s\n", (folder / "report.html").c_str());
  const bool usable = std::any_of(identifications.begin(), identifications.end(), [](const Identification& one) {
    return anyUsable(one, {kMethods.begin(), kMethods.end()});
  });
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
  const CLI::Option* step = command->add_option("--step", arguments->step, "load step to identify from");
  command->add_flag("--neglect-kc", arguments->neglect_kc, "neglect K_c, as the paper does");
  command->add_flag("--paper", arguments->paper, "put the figures of Ambiehl et al. (IROS 2017) beside these");
  command->callback([arguments, step, &run] {
    run = [arguments, step_given = step->count() > 0] { return writeReport(*arguments, step_given); };
  });
}

}  // namespace stiffscope
