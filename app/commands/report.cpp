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
#include "core/input/write_folder.h"
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

std::vector<NamedText> settingsOf(const IdentifyOptions& options) {
  return {{"load step", options.step ? std::to_string(*options.step) : "the one with the largest mean force"},
          {"geometric stiffness K_{c}", options.finite_deflection ? "included" : "neglected"},
          {"subsets", "10 of 19 postures, in proportion; all up to 250 000, else a sample with seed 1"}};
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
  content.settings = settingsOf(options);
  content.title = "Joint stiffness";
  content.verdict = verdictOf(content.campaigns, content.avoided);
  content.figures = makeFigures(content.campaigns, {arguments.paper});

  // Everything is made before the first file is written, and appears at once.
  const std::string page = reportPage(content);
  const std::string results = resultsJson(content).dump(1) + '\n';
  const std::filesystem::path folder = arguments.out;
  std::vector<FileToWrite> files;
  for (const Figure& figure : content.figures) {
    files.push_back({figure.id + ".png", {figure.png.begin(), figure.png.end()}});
  }
  files.push_back({"results.json", results});
  files.push_back({"report.html", page});
  writeFolderWhole(folder, files);
  printText((folder / "report.html").string() + '\n');
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
  command->add_option("--out", arguments->out, "folder for report.html, results.json and the pictures")->required();
  const CLI::Option* step = command->add_option("--step", arguments->step, "load step to identify from");
  command->add_flag("--neglect-kc", arguments->neglect_kc, "neglect K_c, as the paper does");
  command->add_flag("--paper", arguments->paper, "put the figures of Ambiehl et al. (IROS 2017) beside these");
  command->callback([arguments, step, &run] {
    run = [arguments, step_given = step->count() > 0] { return writeReport(*arguments, step_given); };
  });
}

}  // namespace stiffscope
