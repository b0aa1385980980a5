#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "app/command_line.h"
#include "app/computations.h"
#include "app/model.h"
#include "app/options.h"
#include "app/output.h"
#include "core/extended_model/effect_offsets.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/units.h"
#include "core/io/write_file.h"
#include "core/planning/plan.h"
#include "core/planning/unloaded_plan.h"
#include "core/preparation/prepare.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/text/text.h"

namespace stiffscope::app {

namespace {

std::optional<Eigen::Vector3d> millimetres(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return Eigen::Vector3d(values[0], values[1], values[2]) * io::kMillimetre;
}

planning::PlanOptions optionsOf(const PlanRequest& arguments) {
  planning::PlanOptions options;
  options.inputs.repeats = arguments.repeats;
  options.seed = arguments.seed;
  if (arguments.postures) options.postures = *arguments.postures;
  if (arguments.candidates) options.candidates = *arguments.candidates;
  if (arguments.pull || arguments.load) {
    options.inputs.load = arguments.pull ? *arguments.pull : *arguments.load;
    options.inputs.pull = arguments.pull.has_value();
  }
  options.inputs.hook_in_flange = millimetres(arguments.hook_mm);
  options.inputs.tracker_in_base = millimetres(arguments.tracker_mm);
  if (!arguments.min_deg.empty()) {
    const JointVector least = anglesGiven("--min-deg", arguments.min_deg);
    options.rules.low.head(least.size()) = least * io::kDegree;
  }
  if (!arguments.max_deg.empty()) {
    const JointVector most = anglesGiven("--max-deg", arguments.max_deg);
    options.rules.high.head(most.size()) = most * io::kDegree;
  }
  if (arguments.criterion == "determinant") {
    options.criterion = planning::PlanCriterion::determinant;
  } else if (arguments.criterion != "balanced") {
    throw io::InputError(
        {"--criterion"}, arguments.criterion,
        "expected balanced or determinant" + io::nearestNameHint(arguments.criterion, {"balanced", "determinant"}));
  }
  options.augment = arguments.add.has_value();
  if (options.augment) options.postures = *arguments.add;
  return options;
}

/// The day, whose machine has as many joints as the request's angles.
std::shared_ptr<const preparation::PreparedCampaign> openedFor(const PlanRequest& arguments,
                                                               const CampaignSource& source) {
  auto opened = source.open();
  requireJointCount("--min-deg", arguments.min_deg, opened->campaign.robot.joints());
  requireJointCount("--max-deg", arguments.max_deg, opened->campaign.robot.joints());
  return opened;
}

/// What a measured campaign says: its identification, by the model asked for, and what would tell apart effects that
/// it cannot.
struct Measured {
  std::optional<extended_model::ExtendedModel> model;
  std::optional<identification::Identification> springs;
  std::vector<diagnosis::NextMeasurement> next;

  const identification::Identification* identification() const {
    return model ? &model->with : (springs ? &*springs : nullptr);
  }
  const campaign::Campaign& campaign(const campaign::Campaign& as_read) const {
    return model ? model->campaign : as_read;
  }
};

Measured measuredBy(const preparation::PreparedCampaign& prepared, const ModelChoice& choice) {
  const campaign::Campaign& campaign = prepared.campaign;
  Measured measured;
  const bool loaded = campaign.states && campaign.load_cell && (campaign.loading || campaign.displacements);
  if (!loaded || !identification::heaviestStep(campaign)) return measured;
  measured.model = modelOf(prepared, choice, {}, extended_model::Followed::by_diagnosis);
  if (!measured.model) measured.springs = identification::identify(campaign);
  if (measured.model) measured.next = diagnosisOf(prepared, measured.model).next;
  return measured;
}

/// What is not known of the effects in the model; empty where there are none.
planning::EffectDoubt doubtOf(const std::optional<extended_model::ExtendedModel>& model) {
  planning::EffectDoubt doubt;
  if (!model || model->effects.free.empty()) return doubt;
  doubt.moves = [&model = *model](const JointVector& q, const Eigen::Vector3d& force,
                                  const Eigen::Vector3d& point_in_flange, const std::vector<Eigen::Vector3d>& targets) {
    return extended_model::displacementBySteps(model.effects, model.spread.parameters, q,
                                               {point_in_flange, force, Eigen::Vector3d::Zero()}, targets);
  };
  for (std::size_t m = 0; m < doubt.covariance.size(); ++m)
    doubt.covariance[m] = model->spread.compliance[m] * model->spread.compliance[m].transpose();
  return doubt;
}

/// Writes what `--out` asks for.
void writeOut(const PlanRequest& arguments, const std::function<std::string(bool xml)>& content) {
  if (arguments.out.empty()) return;
  io::requireNotRead(arguments.out);
  io::writeFileWhole(arguments.out, content(std::filesystem::path(arguments.out).extension() == ".xml"));
}

/// A day without a load: postures that calibrate, in an order that tells effects apart.
int planUnloadedDay(const PlanRequest& arguments, const CampaignSource& source, const planning::PlanOptions& loaded,
                    const Outlet& outlet) {
  planning::UnloadedPlanOptions options;
  if (arguments.postures) options.postures = loaded.postures;
  if (arguments.candidates) options.candidates = loaded.candidates;
  options.seed = loaded.seed;
  options.inputs = loaded.inputs;
  options.rules = loaded.rules;
  const auto opened = openedFor(arguments, source);
  const campaign::Campaign& campaign = opened->campaign;
  const planning::UnloadedPlan plan = planning::planUnloaded(campaign, options);
  writeOut(arguments,
           [&](bool xml) { return xml ? reports::unloadedPlanXml(plan) : reports::unloadedPlanCsv(campaign, plan); });
  outlet.deliver([&] { return reports::unloadedPlanJson(campaign, plan); },
                 [&] { return reports::unloadedPlanText(campaign, plan); });
  return plan.postures.empty() ? kNotUsable : kDone;
}

}  // namespace

int planDay(const PlanRequest& arguments, const CampaignSource& source, const Outlet& outlet) {
  planning::PlanOptions options = optionsOf(arguments);
  if (arguments.unloaded) return planUnloadedDay(arguments, source, options, outlet);
  const auto opened = openedFor(arguments, source);
  const preparation::PreparedCampaign& prepared = *opened;
  const Measured measured = measuredBy(prepared, arguments.model);
  const campaign::Campaign& campaign = measured.campaign(prepared.campaign);
  options.inputs.effects = doubtOf(measured.model);
  const planning::Plan plan = planning::planCampaign(campaign, measured.identification(), options);
  writeOut(arguments, [&](bool xml) { return xml ? reports::planXml(plan) : reports::planCsv(campaign, plan); });
  const auto json = [&] {
    reports::Json result = reports::planJson(campaign, plan);
    return measured.model
               ? reports::withNext(reports::withEffects(std::move(result), *measured.model, {}), measured.next)
               : result;
  };
  const auto text = [&] {
    std::string all = reports::planText(campaign, plan);
    if (measured.model) all += reports::addedEffectsText(measured.model->effects) + reports::nextText(measured.next);
    return all;
  };
  outlet.deliver(json, text);
  return plan.usable && !plan.postures.empty() ? kDone : kNotUsable;
}

void addPlan(CLI::App& app, Run& run) {
  struct PlanArguments {
    std::string campaign, json;
    int postures = planning::PlanOptions().postures, candidates = planning::PlanOptions().candidates, add = 0;
    double load = 0.0, pull = 0.0;
    PlanRequest request;
  };
  const auto arguments = std::make_shared<PlanArguments>();
  PlanRequest& request = arguments->request;
  CLI::App* command = app.add_subcommand("plan", "Postures and loads to measure, before the day or after it");
  command
      ->add_option("CAMPAIGN", arguments->campaign,
                   "campaign folder or its campaign.xml; before the day it needs no tables")
      ->required();
  addModelOptions(*command, request.model);
  CLI::Option* postures = command->add_option("--postures", arguments->postures, "how many")->capture_default_str();
  const CLI::Option* add =
      command->add_option("--add", arguments->add, "how many to add to those that the campaign has measured")
          ->excludes(postures);
  CLI::Option* load =
      command->add_option("--load", arguments->load, "newtons that hang; without it, and without --pull, as measured");
  const CLI::Option* pull =
      command->add_option("--pull", arguments->pull, "newtons of a cable, pulling in any of nine directions")
          ->excludes(load);
  command->add_option("--hook", request.hook_mm, "x,y,z (mm) on the flange where the load acts")
      ->delimiter(',')
      ->expected(3);
  command->add_option("--tracker", request.tracker_mm, "x,y,z (mm) of the tracker in base_link")
      ->delimiter(',')
      ->expected(3);
  command
      ->add_option("--min-deg", request.min_deg,
                   "least joint angles, one a joint, as the controller states them (joint_reading)")
      ->delimiter(',');
  command->add_option("--max-deg", request.max_deg, "largest joint angles, likewise")->delimiter(',');
  command->add_option("--repeats", request.repeats, "readings of each reflector in a state")->capture_default_str();
  const auto unloaded =
      command->add_flag("--unloaded", request.unloaded,
                        "a day without a load: postures that calibrate the geometry, in an order that tells effects of "
                        "the order apart; 40 of 400 unless said otherwise");
  command
      ->add_option("--criterion", request.criterion, "balanced (no joint pays for another) or determinant (D-optimal)")
      ->capture_default_str();
  const CLI::Option* candidates =
      command->add_option("--candidates", arguments->candidates, "random postures to choose from")
          ->capture_default_str();
  command->add_option("--seed", request.seed, "of the random postures")->capture_default_str();
  command->add_option(
      "--out", request.out,
      "write the postures to this file: CSV, or where its name ends in .xml the <postures> of a simulation");
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  // What only a load has is refused, not ignored.
  for (const char* loaded : {"--add", "--load", "--pull", "--hook", "--criterion", "--with", "--springs-only"})
    unloaded->excludes(command->get_option(loaded));
  command->callback([=, &run] {
    PlanRequest& asked = arguments->request;
    if (postures->count() > 0) asked.postures = arguments->postures;
    if (candidates->count() > 0) asked.candidates = arguments->candidates;
    if (add->count() > 0) asked.add = arguments->add;
    if (load->count() > 0) asked.load = arguments->load;
    if (pull->count() > 0) asked.pull = arguments->pull;
    run = [arguments] {
      requireOwnFiles({{"--out", arguments->request.out}, {"--json", arguments->json}});
      return planDay(arguments->request, sourceOf(arguments->campaign, false), commandLineOutlet(arguments->json));
    };
  });
}

}  // namespace stiffscope::app
