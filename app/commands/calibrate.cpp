#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/command_line.h"
#include "app/options.h"
#include "app/output.h"
#include "app/prepared.h"
#include "app/urdf.h"
#include "core/calibration/calibrate.h"
#include "core/campaign/campaign.h"
#include "core/io/input_error.h"
#include "core/io/write_file.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/text/text.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

namespace {

struct CalibrateArguments {
  std::string campaign, json, urdf, csv, angles = "reported";
  calibration::CalibrationOptions options;
  bool raw = false;
};

void checkFolds(const calibration::CalibrationOptions& options) {
  constexpr int kMostFolds = 100, kMostSize = 1'000'000;
  if (options.folds < 2 || options.folds > kMostFolds)
    throw io::InputError({"--folds"}, std::to_string(options.folds), "expected 2 to 100");
  if (options.fold_size < 1 || options.fold_size > kMostSize)
    throw io::InputError({"--fold-size"}, std::to_string(options.fold_size), "expected 1 to 1000000 postures");
}

int calibrateCampaign(CalibrateArguments& arguments) {
  checkFolds(arguments.options);
  requireOwnFiles({{"--csv", arguments.csv}, {"--urdf", arguments.urdf}, {"--json", arguments.json}});
  arguments.options.angles = jointAnglesNamed(arguments.angles);
  const preparation::PreparedCampaign prepared =
      openPrepared(arguments.campaign, arguments.raw, hashesFor(arguments.json));
  const campaign::Campaign& campaign = prepared.campaign;
  requireCommanded(campaign, arguments.options.angles);
  const calibration::Calibration calibration = calibration::calibrate(campaign, arguments.options);
  const bool done = calibration.reason.empty();
  deliver(
      [&] {
        return reports::withPreparation(reports::calibrationJson(campaign, calibration, arguments.options),
                                        prepared.preparation);
      },
      [&] {
        return reports::calibrationText(campaign, calibration, arguments.options) +
               reports::preparationText(prepared.preparation);
      },
      arguments.json);
  if (!done) {
    std::fprintf(stderr, "stiffscope: %s: not calibrated: %s\n", arguments.campaign.c_str(),
                 reports::words(calibration.reason).c_str());
    return kNotUsable;
  }
  if (!arguments.csv.empty()) {
    io::requireNotRead(arguments.csv);
    io::writeFileWhole(arguments.csv, reports::calibrationCsv(calibration));
  }
  if (!arguments.urdf.empty())
    writeCalibratedUrdf(campaign, calibration.geometry().fit.arm(campaign.robot), arguments.urdf);
  return kDone;
}

}  // namespace

void addCalibrate(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command =
      app.add_subcommand("calibrate", "Geometry, own weight and effects from unloaded postures, held out");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command->add_option("--folds", arguments->options.folds, "parts of the postures, each predicted by the others")
      ->capture_default_str();
  command->add_option("--fold-size", arguments->options.fold_size, "postures in a row that stay in one part")
      ->capture_default_str();
  command->add_option("--angles", arguments->angles, "reported or commanded joint angles")->capture_default_str();
  command->add_option("--urdf", arguments->urdf, "write the URDF with calibrated origins to this file");
  command->add_option("--csv", arguments->csv, "write axes and Denavit and Hartenberg's parameters to this file");
  addRawOption(*command, arguments->raw);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] { run = [arguments] { return calibrateCampaign(*arguments); }; });
}

}  // namespace stiffscope::app
