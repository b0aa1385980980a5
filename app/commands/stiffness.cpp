#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "app/command_line.h"
#include "app/figures/figures.h"
#include "app/identified.h"
#include "app/model.h"
#include "app/output.h"
#include "app/prepared.h"
#include "core/io/input_error.h"
#include "core/io/units.h"
#include "core/io/write_file.h"
#include "core/workspace/workspace_stiffness.h"
#include "reports/csv/csv_table.h"
#include "reports/csv/posture_tables.h"
#include "reports/json/campaign_json.h"
#include "reports/json/identification_json.h"
#include "reports/json/json.h"
#include "reports/text/text.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/preparation_words.h"

namespace stiffscope::app {

namespace {

struct StiffnessArguments {
  std::string campaign, slice, offsets, workpiece, picture, csv, placements, json, method, step;
  std::vector<double> force;
  double spacing_mm = 0.0;
  bool raw = false;
  ModelChoice model;
};

workspace::WorkspaceOptions optionsOf(const StiffnessArguments& arguments) {
  workspace::WorkspaceOptions options;
  options.slice.pose = arguments.slice;
  options.slice.spacing = arguments.spacing_mm * io::kMillimetre;
  if (!arguments.force.empty()) {
    options.force = Eigen::Vector3d(arguments.force[0], arguments.force[1], arguments.force[2]);
    if (options.force->isZero(0.0)) throw io::InputError({"--force"}, "0,0,0", "expected a force that is not zero");
  }
  std::vector<std::string> warnings;
  if (!arguments.offsets.empty()) options.offsets = workspace::readOffsets(arguments.offsets, warnings);
  printWarnings(warnings);
  return options;
}

/// The postures of the workpiece, of the campaign's machine.
std::vector<workspace::NamedPosture> workpieceIn(const std::string& file, const campaign::Campaign& campaign) {
  std::vector<std::string> warnings;
  std::vector<workspace::NamedPosture> postures;
  for (const compensation::PostureToCompensate& one : compensation::readPostures(file, campaign, warnings))
    postures.push_back({one.id, one.q});
  if (postures.empty()) throw io::InputError({file}, "", "expected at least one posture of the workpiece");
  printWarnings(warnings);
  return postures;
}

void drawSlice(const std::string& file, const campaign::Campaign& campaign, const frames::Frames& frames,
               const workspace::WorkspaceStiffness& found) {
  const std::vector<std::uint8_t> png =
      render::encodePng(render::render(stiffnessSliceChart(campaign, frames, found), {1200, 900}));
  io::writeFileWhole(file, std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
}

int stiffnessOf(const StiffnessArguments& arguments) {
  const MethodAndStep choice = methodAndStep(arguments.method, arguments.step);
  workspace::WorkspaceOptions options = optionsOf(arguments);
  requireOwnFiles({{"--csv", arguments.csv},
                   {"--placements", arguments.placements},
                   {"--picture", arguments.picture},
                   {"--json", arguments.json}});
  const preparation::PreparedCampaign prepared =
      openPrepared(arguments.campaign, arguments.raw, hashesFor(arguments.json));
  if (!arguments.workpiece.empty()) options.workpiece = workpieceIn(arguments.workpiece, prepared.campaign);
  Identified found = identifiedBy(prepared, arguments.campaign, arguments.model, choice);
  const campaign::Campaign& campaign = found.campaign(prepared);
  workspace::WorkspaceStiffness stiffness;
  {
    const PredictedArm predicted(campaign, found.improved, found.result(), found.method);
    stiffness = workspace::workspaceStiffness(predicted.arm(), found.result(),
                                              found.improved ? &*found.improved : nullptr, found.method, options);
  }
  if (!arguments.csv.empty()) {
    io::requireNotRead(arguments.csv);
    io::writeFileWhole(arguments.csv,
                       reports::csvTable(reports::stiffnessPlaces(stiffness, campaign.robot.joints(), true, true)));
  }
  if (!arguments.placements.empty()) {
    io::requireNotRead(arguments.placements);
    io::writeFileWhole(arguments.placements, reports::csvTable(reports::placementTable(*stiffness.placement)));
  }
  if (!arguments.picture.empty()) {
    io::requireNotRead(arguments.picture);
    drawSlice(arguments.picture, campaign, found.result().frames, stiffness);
  }
  deliver(
      [&] {
        reports::Json json{{"campaign", reports::campaignJson(campaign)}};
        json.update(reports::workspaceJson(stiffness));
        json["shown_first"] = reports::shownFirstJson(found.shown_first);
        if (found.improved) json = reports::withEffects(std::move(json), *found.improved, {found.method});
        return reports::withPreparation(std::move(json), prepared.preparation);
      },
      [&] {
        return reports::workspaceText(campaign, stiffness) +
               (found.shown_first
                    ? reports::wrapped(reports::shownFirstWords(found.result(), *found.shown_first), 2) + "\n"
                    : "") +
               reports::preparationText(prepared.preparation);
      },
      arguments.json);
  return stiffness.placement && !stiffness.placement->best ? kNotUsable : kDone;
}

}  // namespace

void addStiffness(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<StiffnessArguments>();
  CLI::App* command =
      app.add_subcommand("stiffness", "Stiffness at the tool over the workspace, and where a workpiece stands best");
  command->footer("Status 1 where a force was given and no place could be judged.");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command->add_option("--slice", arguments->slice,
                      "posture whose tool orientation is held in the vertical plane through axis 1 and its P_TCP; "
                      "without it the one nearest to the middle of all");
  command->add_option("--spacing", arguments->spacing_mm, "distance of the slice's places and of the offsets, mm")
      ->check(CLI::PositiveNumber);
  CLI::Option* force =
      command
          ->add_option("--force", arguments->force,
                       "force on P_TCP in R0, N, with commas: which place of the workpiece deflects least under it?")
          ->type_name("FX,FY,FZ")
          ->delimiter(',')
          ->expected(3);
  command
      ->add_option(
          "--workpiece", arguments->workpiece,
          "CSV with pose, q1_deg..qN_deg (and fx_n..mz_nm, not used): postures in which the force acts; without "
          "it the slice's")
      ->needs(force);
  command
      ->add_option(
          "--offsets", arguments->offsets,
          "CSV with offset, dx_mm, dy_mm, dz_mm in R0: where the workpiece could be moved; without it two steps "
          "either way along each axis")
      ->needs(force);
  command->add_option("--method", arguments->method, "cp, pp or dpp; without it the one that identify shows first");
  command->add_option("--step", arguments->step, "load step to identify from");
  addModelOptions(*command, arguments->model);
  addRawOption(*command, arguments->raw);
  command->add_option("--picture", arguments->picture, "draw the slice into this PNG file");
  command->add_option("--csv", arguments->csv, "write postures and slice to this CSV file");
  command->add_option("--placements", arguments->placements, "write the places of the workpiece to this CSV file")
      ->needs(force);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] { run = [arguments] { return stiffnessOf(*arguments); }; });
}

}  // namespace stiffscope::app
