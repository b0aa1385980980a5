#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include <cstdio>
#include <stdexcept>

#include "app/command_line.h"
#include "app/options.h"
#include "app/output.h"
#include "core/campaign/write_campaign.h"
#include "core/interchange/day_template.h"
#include "core/interchange/import_day.h"
#include "core/interchange/point_file.h"
#include "core/io/read_file.h"
#include "core/io/write_folder.h"
#include "core/robot/read_urdf.h"
#include "reports/json/interchange_json.h"

namespace stiffscope::app {

namespace {

struct PointsArguments {
  std::vector<std::string> files;
  std::string format, encoding, json;
  interchange::FileOptions options;
};

int importPoints(const PointsArguments& arguments) {
  interchange::FileOptions options = arguments.options;
  if (!arguments.format.empty()) options.format = interchange::pointFormatNamed(arguments.format, "--format");
  if (!arguments.encoding.empty()) options.encoding = interchange::encodingNamed(arguments.encoding, "--encoding");
  std::vector<reports::NamedPoints> files;
  for (const std::string& file : arguments.files) {
    files.push_back({file, interchange::readPointFile(file, options)});
    printWarnings(files.back().points.warnings);
  }
  deliverPieces([&] { return reports::pointsJson(files); },
                [&](const io::ByteSink& sink) { reports::pointsText(files, sink); }, arguments.json);
  return kDone;
}

void addPoints(CLI::App& import, Run& run) {
  const auto arguments = std::make_shared<PointsArguments>();
  interchange::FileOptions& options = arguments->options;
  CLI::App* command = import.add_subcommand("points", "What a tracker's software wrote, read and printed");
  command->add_option("FILE", arguments->files, "exports of points")->required();
  command->add_option("--format", arguments->format,
                      "sa, leica, openindy, xyz or columns; without it what the file shows");
  command->add_option("--encoding", arguments->encoding,
                      "utf-8, utf-16le, utf-16be, cp1252 or cp932; without it what the file shows");
  command->add_option("--columns", options.columns, "of format columns: names from left to right, - for one not read");
  command->add_option("--separator", options.separator, "of format columns: a character, tab or blank");
  command->add_flag("--decimal-comma", options.decimal_comma, "numbers have a decimal comma");
  command->add_option("--skip", options.skip, "lines before the first row");
  command->add_option("--target", options.target, "the name of all points: one file a reflector");
  command->add_option("--unit", options.unit, "mm, m or in, where the file states none (without it mm)");
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] { run = [arguments] { return importPoints(*arguments); }; });
}

struct DayArguments {
  std::string day, out, json;
  bool replace = false;
};

int importCampaign(const DayArguments& arguments) {
  const std::string expectation = arguments.replace ? "" : kOrReplace;
  if (!arguments.replace) requireNoCampaign(arguments.out, expectation);
  const interchange::ImportedDay day = interchange::importDay(arguments.day);
  std::error_code none;
  printWarnings(day.warnings);
  // What was measured is never written over, wherever DAY.xml stands.
  for (const auto& file : std::filesystem::directory_iterator(arguments.out, none)) io::requireNotRead(file.path());
  // Before the folder is written, which would then stand in the way of the next run.
  if (!arguments.json.empty() && !isStandardOutput(arguments.json)) io::requireNotRead(arguments.json);
  const io::ByteSource origins = [&day](const io::ByteSink& sink) { writeJson(reports::importJson(day), sink); };
  campaign::writeCampaign(day.campaign, day.urdf, arguments.out, {{"import.json", origins}},
                          campaign::WrittenDigits::as_read, expectation);
  deliver([&] { return reports::importJson(day); },
          [&] { return reports::importText(day) + arguments.out + ": campaign written, with import.json\n"; },
          arguments.json);
  return kDone;
}

void addCampaign(CLI::App& import, Run& run) {
  const auto arguments = std::make_shared<DayArguments>();
  CLI::App* command = import.add_subcommand("campaign", "Tracker's and robot's files, joined into a campaign folder");
  command->add_option("DAY", arguments->day, "description of the day's files (XML; docs/import.md)")->required();
  command->add_option("--out", arguments->out, "campaign folder to write, with import.json: where each row came from")
      ->required();
  command->add_flag("--replace", arguments->replace, "write over a campaign that is there");
  command->add_option("--json", arguments->json, "write import.json to this file, too, - for standard output");
  command->callback([arguments, &run] { run = [arguments] { return importCampaign(*arguments); }; });
}

/// New files in a folder, which is made where absent; the first is to be filled in.
int writeNew(const std::filesystem::path& folder, const std::vector<io::FileToWrite>& files) {
  for (const io::FileToWrite& file : files) {
    std::error_code error;
    if (std::filesystem::exists(folder / file.name, error))
      throw std::runtime_error((folder / file.name).string() + ": not written: it is there already");
  }
  io::writeFolderWhole(folder, files);
  printText((folder / files.front().name).string() + ": written, to be filled in\n");
  return kDone;
}

struct TemplateArguments {
  std::string maker, folder;
};

void addTemplate(CLI::App& import, Run& run) {
  const auto arguments = std::make_shared<TemplateArguments>();
  CLI::App* command = import.add_subcommand("template", "A commented DAY.xml for a maker's controller");
  command->add_option("--maker", arguments->maker, "fanuc, kuka, abb or ur")->required();
  command->add_option("DIR", arguments->folder, "folder to write DAY.xml into")->required();
  command->callback([arguments, &run] {
    run = [arguments] {
      const interchange::Maker maker = interchange::makerNamed(arguments->maker, "--maker");
      return writeNew(arguments->folder, {{"DAY.xml", interchange::dayTemplate(maker)}});
    };
  });
}

}  // namespace

void addInit(CLI::App& app, Run& run) {
  struct InitArguments {
    std::string urdf, base = "base_link", flange = "tool0", folder;
  };
  const auto arguments = std::make_shared<InitArguments>();
  CLI::App* command =
      app.add_subcommand("init", "A campaign folder to fill in: a commented campaign.xml beside a URDF");
  command->add_option("URDF", arguments->urdf, "nominal machine")->required();
  command->add_option("--out", arguments->folder, "folder to write")->required();
  command->add_option("--base-link", arguments->base, "first link of the chain")->capture_default_str();
  command->add_option("--flange-link", arguments->flange, "last link of the chain")->capture_default_str();
  command->callback([arguments, &run] {
    run = [arguments] {
      // A chain that no command could read is said now.
      robot::readUrdf(arguments->urdf, arguments->base, arguments->flange);
      std::vector<io::FileToWrite> files{
          {"campaign.xml", interchange::campaignTemplate(arguments->base, arguments->flange)}};
      // A URDF that is there under its name stays.
      std::error_code none;
      const std::filesystem::path copy = std::filesystem::path(arguments->folder) / "robot.urdf";
      if (!std::filesystem::equivalent(arguments->urdf, copy, none))
        files.emplace_back("robot.urdf", io::readTextFile(arguments->urdf, io::kLargestXml));
      return writeNew(arguments->folder, files);
    };
  });
}

void addImport(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("import", "A day as tracker and robot wrote it: their files as a campaign");
  command->require_subcommand(1);
  addPoints(*command, run);
  addCampaign(*command, run);
  addTemplate(*command, run);
}

}  // namespace stiffscope::app
