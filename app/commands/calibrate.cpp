#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <memory>

#include "app/command_line.h"
#include "app/computations.h"
#include "app/options.h"
#include "app/output.h"
#include "app/prepared.h"
#include "app/urdf.h"
#include "core/calibration/calibrate.h"
#include "core/campaign/campaign.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/write_file.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/text/text.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

namespace {

void checkFolds(const calibration::CalibrationOptions& options) {
  constexpr int kMostFolds = 100, kMostSize = 1'000'000;
  if (options.folds < 2 || options.folds > kMostFolds)
    throw io::InputError({"--folds"}, std::to_string(options.folds), "expected 2 to 100");
  if (options.fold_size < 1 || options.fold_size > kMostSize)
    throw io::InputError({"--fold-size"}, std::to_string(options.fold_size), "expected 1 to 1000000 postures");
}

/// A part that is the whole day leaves nothing to hold out.
void requireTwoFolds(const calibration::CalibrationOptions& options, std::size_t postures) {
  if (static_cast<std::size_t>(options.fold_size) < postures || postures < 2) return;
  throw io::InputError({"--fold-size"}, std::to_string(options.fold_size),
                       fmt::format("expected fewer than the day's {} postures, so that some are held out", postures));
}

}  // namespace

int calibrateCampaign(CalibrateRequest request, const CampaignSource& source, const Outlet& outlet) {
  checkFolds(request.options);
  request.options.angles = jointAnglesNamed(request.angles);
  const auto opened = source.open();
  const preparation::PreparedCampaign& prepared = *opened;
  const campaign::Campaign& campaign = prepared.campaign;
  requireCommanded(campaign, request.options.angles);
  // Before all is computed and printed.
  for (const std::string& file : {request.csv, request.urdf}) {
    if (!file.empty()) io::requireNotRead(file);
  }
  requireTwoFolds(request.options, campaign.pose_ids.size());
  const calibration::Calibration calibration = calibration::calibrate(prepared, request.options);
  const bool done = calibration.reason.empty();
  outlet.deliver(
      [&] {
        return reports::withPreparation(reports::calibrationJson(campaign, calibration, request.options),
                                        prepared.preparation);
      },
      [&] {
        return reports::calibrationText(campaign, calibration, request.options) +
               reports::preparationText(prepared.preparation);
      });
  if (!done) {
    outlet.explain(source.name + ": not calibrated: " + reports::words(calibration.reason));
    return kNotUsable;
  }
  if (!request.csv.empty()) io::writeFileWhole(request.csv, reports::calibrationCsv(calibration));
  if (!request.urdf.empty())
    writeCalibratedUrdf(campaign, calibration.geometry().fit.arm(campaign.robot), request.urdf);
  return kDone;
}

void addCalibrate(CLI::App& app, Run& run) {
  struct CalibrateArguments {
    std::string campaign, json;
    bool raw = false;
    CalibrateRequest request;
  };
  const auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command =
      app.add_subcommand("calibrate", "Geometry, own weight and effects from unloaded postures, held out");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command
      ->add_option("--folds", arguments->request.options.folds, "parts of the postures, each predicted by the others")
      ->capture_default_str();
  command->add_option("--fold-size", arguments->request.options.fold_size, "postures in a row that stay in one part")
      ->capture_default_str();
  command->add_option("--angles", arguments->request.angles, "reported or commanded joint angles")
      ->capture_default_str();
  command->add_option("--urdf", arguments->request.urdf, "write the URDF with calibrated origins to this file");
  command->add_option("--csv", arguments->request.csv,
                      "write axes and Denavit and Hartenberg's parameters to this file");
  addRawOption(*command, arguments->raw);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] {
    run = [arguments] {
      requireOwnFiles(
          {{"--csv", arguments->request.csv}, {"--urdf", arguments->request.urdf}, {"--json", arguments->json}});
      return calibrateCampaign(arguments->request,
                               sourceOf(arguments->campaign, arguments->raw, hashesFor(arguments->json)),
                               commandLineOutlet(arguments->json));
    };
  });
}

}  // namespace stiffscope::app
