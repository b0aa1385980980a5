#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <utility>

#include "app/command_line.h"
#include "app/computations.h"
#include "app/model.h"
#include "app/output.h"
#include "app/prepared.h"
#include "core/campaign/campaign.h"
#include "core/frames/frames.h"
#include "core/identification/identify.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/text/text.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

int framesOf(const CampaignSource& source, const ModelChoice& choice, const Outlet& outlet) {
  const auto opened = source.open();
  const preparation::PreparedCampaign& prepared = *opened;
  std::optional<extended_model::ExtendedModel> model;
  // Nothing of how good the stiffnesses are is shown.
  if (identification::whatLoadsLack(prepared.campaign).empty())
    model = modelOf(prepared, choice, identification::estimatesOnly({}));
  const campaign::Campaign& campaign = prepared.campaign;
  const frames::Frames frames = model ? model->with.frames : identification::solvedFrames(campaign);
  const auto json = [&] {
    reports::Json result = reports::framesJson(campaign, frames);
    if (model) result = reports::withEffects(std::move(result), *model, {});
    return reports::withPreparation(std::move(result), prepared.preparation);
  };
  const auto text = [&] {
    std::string all = reports::framesText(campaign, frames);
    if (model) all += reports::addedEffectsText(model->effects);
    return all + reports::preparationText(prepared.preparation);
  };
  outlet.deliver(json, text);
  if (frames.arm.points_placed) return kDone;
  const frames::MeasuredAxis& missing = frames.axes[0].measured ? frames.axes[1] : frames.axes[0];
  outlet.explain(source.name + ": no frame is measured: R0 needs sweeps of axes 1 and 2 (`circle_sweeps`): " +
                 reports::words(missing.reason));
  return kNotUsable;
}

void addFrames(CLI::App& app, Run& run) {
  struct FramesArguments {
    std::string campaign, json;
    bool raw = false;
    ModelChoice model;
  };
  const auto arguments = std::make_shared<FramesArguments>();
  CLI::App* command =
      app.add_subcommand("frames", "Axes, R0, link lengths, P_TCP and the wrist centre from the sweeps");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  addModelOptions(*command, arguments->model);
  addRawOption(*command, arguments->raw);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] {
    run = [arguments] {
      return framesOf(sourceOf(arguments->campaign, arguments->raw), arguments->model,
                      commandLineOutlet(arguments->json));
    };
  });
}

}  // namespace stiffscope::app
