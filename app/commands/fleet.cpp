#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>

#include "app/command_line.h"
#include "app/figures/result_charts.h"
#include "app/fleet/fleet_work.h"
#include "app/fleet/processes.h"
#include "app/fleet/slurm.h"
#include "app/options.h"
#include "app/output.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/write_file.h"
#include "reports/csv/fleet_csv.h"
#include "reports/json/fleet_json.h"
#include "reports/page/pages.h"
#include "reports/words/fleet_words.h"
#include "reports/words/remark_words.h"
#include "reports/words/rich_text.h"

namespace stiffscope::app {

namespace {

struct FleetArguments {
  FleetRequest request;
  ShardChoice shard;
  std::string out, result;
};

/// What a report is known by, of all campaigns together.
std::string fleetId(const std::vector<FoundCampaign>& found) {
  std::string keys;
  for (const FoundCampaign& one : found) keys += one.key;
  return io::sha256Hex(keys).substr(0, 12);
}

/// What a fleet is written to, in this order; the page comes last.
struct FleetFile {
  const char* name;
  std::string (*bytes)(const fleet::Fleet& fleet);
};
constexpr std::array kTables{
    FleetFile{"fleet.csv", &reports::fleetCsv},           FleetFile{"fleet.jsonl", &reports::fleetJsonLines},
    FleetFile{"changes.csv", &reports::changesCsv},       FleetFile{"steps.csv", &reports::stepsCsv},
    FleetFile{"detectable.csv", &reports::detectableCsv}, FleetFile{"needs.csv", &reports::needsCsv}};
constexpr const char* kPage = "fleet.html";

/// How many reports that were asked for are not there, and why the first of them; empty where all are.
std::string missingReportsText(const fleet::Fleet& fleet) {
  const auto missing = [](const fleet::FleetCampaign& one) { return !one.report_failure.empty(); };
  const auto count = std::count_if(fleet.campaigns.begin(), fleet.campaigns.end(), missing);
  if (count == 0) return {};
  const auto first = std::find_if(fleet.campaigns.begin(), fleet.campaigns.end(), missing);
  return fmt::format("{} report{} not written (report_failure in fleet.csv): {}: {}\n", count, count == 1 ? "" : "s",
                     first->folder, first->report_failure);
}

/// The machines that need something, a line each.
std::string fleetText(const fleet::Fleet& fleet, const std::filesystem::path& out) {
  std::size_t failed = 0, well = 0;
  for (const fleet::FleetCampaign& one : fleet.campaigns) failed += one.result ? 0 : 1;
  std::string text = fmt::format("{} machines, {} campaigns, {} without a result\n", fleet.machines.size(),
                                 fleet.campaigns.size(), failed);
  constexpr std::size_t kMostLines = 40;
  std::size_t lines = 0;
  for (const fleet::Machine& machine : fleet.machines) {
    const fleet::Need& need = machine.needs.front();
    if (need.id == fleet::NeedId::nothing) ++well;
    if (need.id == fleet::NeedId::nothing || ++lines > kMostLines) continue;
    text += fmt::format("{:16} {:16} {}\n", machine.name, reports::needName(need.id),
                        reports::plain(reports::words(need.reason)));
  }
  if (lines > kMostLines) text += fmt::format("and {} more machines (needs.csv)\n", lines - kMostLines);
  text += fmt::format("{} machines need nothing\n", well) + missingReportsText(fleet);
  return text + (out / kPage).string() + '\n';
}

/// Before the work of a night, not after it.
void requireFilesCanBe(const std::filesystem::path& out) {
  const auto require = [&](const char* name) {
    if (std::filesystem::is_directory(out / name))
      throw io::InputError({(out / name).string()}, "", "expected the name of a file; this is a directory");
  };
  for (const FleetFile& table : kTables) require(table.name);
  require(kPage);
}

int writeFleet(const FleetRequest& request, const std::vector<FoundCampaign>& found) {
  const fleet::Fleet fleet = fleetFrom(request, found);
  for (const FleetFile& table : kTables) io::writeFileWhole(request.out / table.name, table.bytes(fleet));
  io::writeFileWhole(request.out / kPage, page::fleetPage(fleet, fleetCharts(fleet), fleetId(found)));
  printText(fleetText(fleet, request.out));
  const bool any = std::any_of(fleet.campaigns.begin(), fleet.campaigns.end(),
                               [](const fleet::FleetCampaign& one) { return one.result.has_value(); });
  return any ? kDone : kNotUsable;
}

std::vector<std::string> fleetWordsOf(const FleetRequest& request) {
  std::vector<std::string> words{"fleet"};
  for (const std::string& folder : request.folders) words.push_back(pathWord(folder));
  words.insert(words.end(), {"--out", pathWord(request.out)});
  if (request.reports) words.emplace_back("--reports");
  if (request.springs_only) words.emplace_back("--springs-only");
  return words;
}

int runFleet(FleetArguments& arguments) {
  FleetRequest& request = arguments.request;
  request.out = arguments.out;
  if (!arguments.result.empty()) {
    writeOneResult(request.folders, request.springs_only, arguments.result);
    return kDone;
  }
  requireNoCampaign(request.out, "expected a folder of the fleet's own");
  requireFilesCanBe(request.out);
  const numerics::Shard shard = arguments.shard.part();
  const std::vector<FoundCampaign> found = findCampaigns(request);
  if (arguments.shard.slurm > 0) {
    printText(submitToSlurm({"fleet", fleetWordsOf(request), "--jobs", request.out}, arguments.shard));
    return kDone;
  }
  for (const char* below : {"", "campaigns", "pairs"}) io::removeAbandonedParts(request.out / below);
  if (!arguments.shard.merge) doFleetWork(request, found, shard);
  return shard.of > 1 ? kDone : writeFleet(request, found);
}

}  // namespace

void addFleet(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<FleetArguments>();
  CLI::App* command = app.add_subcommand("fleet", "Many campaigns of many machines: what each needs, what has changed");
  command->footer(
      "Each campaign is audited, identified (without a load: calibrated) and diagnosed by a process of its own; one "
      "that\n"
      "fails costs its own row. What is done is kept in the folder and not done again. A campaign is of the machine "
      "that\n"
      "its robot_serial names, else its item, else the folder above it. Writes fleet.html, fleet.csv, fleet.jsonl,\n"
      "changes.csv, steps.csv, detectable.csv and needs.csv (docs/fleet.md).");
  command->add_option("DIR", arguments->request.folders, "folders with campaigns in or below them")->required();
  command->add_option("--out", arguments->out, "folder for the page, the tables, and what is done")->required();
  constexpr int kMostJobs = 1024;
  command->add_option("--jobs", arguments->request.jobs, "processes at a time; without it as many as there are cores")
      ->check(CLI::Range(1, kMostJobs));
  command->add_flag("--reports", arguments->request.reports, "write each campaign's own report, too, and link to it");
  command->add_flag("--springs-only", arguments->request.springs_only,
                    "stiffnesses by joint springs and nothing else, the model of the paper");
  addShardOptions(*command, arguments->shard);
  command->add_option("--result", arguments->result)->group("");  // of a process of the command's own
  command->callback([arguments, &run] { run = [arguments] { return runFleet(*arguments); }; });
}

}  // namespace stiffscope::app
