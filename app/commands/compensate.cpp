#include <CLI/CLI.hpp>
#include <memory>

#include "app/command_line.h"
#include "app/computations.h"
#include "app/model.h"
#include "app/output.h"
#include "app/prediction.h"
#include "app/prepared.h"
#include "core/compensation/compensate.h"
#include "core/io/read_file.h"
#include "core/io/write_file.h"
#include "reports/csv/motion_csv.h"
#include "reports/json/json.h"
#include "reports/text/text.h"

namespace stiffscope::app {

namespace {

std::vector<compensation::PostureToCompensate> posturesOf(const CompensateRequest& request,
                                                          const campaign::Campaign& campaign, int step,
                                                          const Outlet& outlet) {
  if (request.postures) return compensation::withAnglesOfFigures(*request.postures, campaign);
  if (request.postures_file.empty()) return compensation::campaignPostures(campaign, step);
  std::vector<std::string> warnings;
  const auto read = compensation::readPostures(request.postures_file, campaign, warnings);
  for (const std::string& warning : warnings) outlet.warn(warning);
  return read;
}

}  // namespace

int compensateCampaign(const CompensateRequest& request, const CampaignSource& source, const Outlet& outlet) {
  Prediction prediction(source, request.prediction);
  const std::vector<compensation::CompensatedPosture> rows =
      prediction.compensate(posturesOf(request, prediction.campaign(), prediction.step(), outlet));
  if (!request.out.empty()) {
    io::requireNotRead(request.out);
    io::writeFileWhole(request.out, reports::commandsCsv(prediction.campaign(), rows));
  }
  return prediction.deliver(
      rows,
      [&](const auto&) {
        return reports::compensationJson(prediction.campaign(), prediction.method(), rows, prediction.known());
      },
      [&](const auto& cautions) {
        return reports::compensationText(prediction.campaign(), prediction.method(), rows, prediction.known(), cautions,
                                         prediction.weighsWhatHides());
      },
      outlet);
}

namespace {

struct CompensateArguments {
  std::string campaign, json;
  bool raw = false;
  CompensateRequest postures;
  MotionRequest motion;
};

int compensateAsAsked(CompensateArguments& arguments) {
  requireOwnFiles(
      {{"--out", arguments.motion.out}, {"--picture", arguments.motion.picture}, {"--json", arguments.json}});
  const CampaignSource source = sourceOf(arguments.campaign, arguments.raw);
  const Outlet outlet = commandLineOutlet(arguments.json);
  if (!arguments.motion.program.empty()) return compensateProgram(arguments.motion, source, outlet);
  if (!arguments.motion.path.empty()) return compensatePath(arguments.motion, source, outlet);
  arguments.postures.out = arguments.motion.out;
  arguments.postures.prediction = arguments.motion.prediction;
  return compensateCampaign(arguments.postures, source, outlet);
}

CLI::Option* addSix(CLI::App& command, const char* name, std::vector<double>& values, const char* what) {
  return command.add_option(name, values, what)->delimiter(',')->expected(6);
}

}  // namespace

void addCompensate(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<CompensateArguments>();
  CLI::App* command = app.add_subcommand("compensate", "Predicted deflection, and the joint commands that cancel it");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  CLI::Option* postures = command->add_option(
      "--postures", arguments->postures.postures_file,
      "CSV with pose, q1_deg..qN_deg and the load-cell reading fx_n..mz_nm expected there; without it the "
      "campaign's own");
  CLI::Option* program =
      command
          ->add_option("--program", arguments->motion.program,
                       "a robot's program (.ls, .src, .dat, .mod): its joint targets are replaced, all else stays")
          ->excludes(postures);
  CLI::Option* path =
      command
          ->add_option(
              "--path", arguments->motion.path,
              "CSV with pose, x_mm y_mm z_mm of the tool's tip, and i j k (axis, tip to spindle) or qw qx qy qz, "
              "perhaps fx_n..mz_nm on the tool and load_share, in the workpiece's frame")
          ->excludes(postures)
          ->excludes(program);
  command->add_option("--out", arguments->motion.out,
                      "write the commands to this file: CSV, or with --program the program");
  CLI::Option* wrench = addSix(*command, "--wrench", arguments->motion.wrench,
                               "fx,fy,fz (N), mx,my,mz (Nm) on the tool at every target or pose");
  CLI::Option* wrenches = command
                              ->add_option("--wrenches", arguments->motion.wrenches,
                                           "CSV with pose (the target's name in the program) and fx_n..mz_nm")
                              ->needs(program)
                              ->excludes(wrench);
  CLI::Option* axes = command->add_option(
      "--wrench-axes", arguments->motion.wrench_axes,
      "of wrenches: with --program cell (as the load cell reads them; default) or base_link (at the tool's tip); with "
      "--path workpiece (default), tool, feed (along, left, up the tool) or base_link");
  CLI::Option* cutting =
      command
          ->add_option("--cutting", arguments->motion.cutting,
                       "the load by milling: feed_mm (a revolution), depth_mm, width_mm, diameter_mm, "
                       "specific_force_n_mm2, perhaps radial_ratio, axial_ratio, up or down")
          ->type_name("NAME=VALUE,...")
          ->delimiter(',')
          ->needs(path)
          ->excludes(wrench);
  CLI::Option* tool =
      addSix(*command, "--tool", arguments->motion.tool,
             "x,y,z (mm), roll,pitch,yaw (deg) of the tool's tip in the flange; its z leads out of the tool");
  addSix(*command, "--workpiece", arguments->motion.workpiece,
         "x,y,z (mm), roll,pitch,yaw (deg) of the workpiece's frame in base_link; without it base_link")
      ->needs(path);
  command
      ->add_flag("--turn-free", arguments->motion.turn_free,
                 "the tool may turn about its axis although the path has quaternions")
      ->needs(path);
  command
      ->add_option("--start", arguments->motion.start,
                   "joint angles (deg), as the controller states them, near the first pose: the branch to stay on")
      ->delimiter(',')
      ->needs(path);
  command
      ->add_option("--load-sd-percent", arguments->motion.prediction.load_sd_percent,
                   "standard uncertainty of the loads' size; without it that of the load cell's scale")
      ->check(CLI::Range(0.0, 100.0));
  command->add_option("--picture", arguments->motion.picture, "draw the path and its deviations into this PNG file")
      ->needs(path);
  command->add_option("--method", arguments->motion.prediction.method,
                      "cp, pp or dpp; without it the one that identify shows first");
  command->add_option("--step", arguments->motion.prediction.step, "load step to identify from");
  addModelOptions(*command, arguments->motion.prediction.model);
  addRawOption(*command, arguments->raw);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  // What postures have by themselves is refused beside them, not ignored.
  command->callback([=, &run] {
    const bool own_load = program->count() == 0 && path->count() == 0;
    for (const CLI::Option* option : {wrench, wrenches, axes, cutting, tool}) {
      if (own_load && option->count() > 0) throw CLI::ValidationError(option->get_name(), "needs --program or --path");
    }
    run = [arguments] { return compensateAsAsked(*arguments); };
  });
}

}  // namespace stiffscope::app
