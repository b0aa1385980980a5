#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "app/command_line.h"
#include "app/model.h"
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

struct PlanArguments {
  std::string campaign, json, out, criterion = "balanced";
  double load = 0.0, pull = 0.0;
  int add = 0;
  bool unloaded = false;
  ModelChoice model;
  std::vector<double> hook_mm, tracker_mm, min_deg, max_deg;
  planning::PlanOptions options;
};

/// Which options were given.
struct Given {
  const CLI::Option *load, *pull, *add, *postures, *candidates;
};

std::optional<Eigen::Vector3d> millimetres(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return Eigen::Vector3d(values[0], values[1], values[2]) * io::kMillimetre;
}

planning::PlanOptions optionsOf(const PlanArguments& arguments, const Given& given) {
  planning::PlanOptions options = arguments.options;
  const bool pull = given.pull->count() > 0;
  if (pull || given.load->count() > 0) {
    options.inputs.load = pull ? arguments.pull : arguments.load;
    options.inputs.pull = pull;
  }
  options.inputs.hook_in_flange = millimetres(arguments.hook_mm);
  options.inputs.tracker_in_base = millimetres(arguments.tracker_mm);
  for (std::size_t j = 0; j < arguments.min_deg.size(); ++j) {
    options.rules.low[static_cast<Eigen::Index>(j)] = arguments.min_deg[j] * io::kDegree;
  }
  for (std::size_t j = 0; j < arguments.max_deg.size(); ++j) {
    options.rules.high[static_cast<Eigen::Index>(j)] = arguments.max_deg[j] * io::kDegree;
  }
  if (arguments.criterion == "determinant") {
    options.criterion = planning::PlanCriterion::determinant;
  } else if (arguments.criterion != "balanced") {
    throw io::InputError(
        {"--criterion"}, arguments.criterion,
        "expected balanced or determinant" + io::nearestNameHint(arguments.criterion, {"balanced", "determinant"}));
  }
  options.augment = given.add->count() > 0;
  if (options.augment) options.postures = arguments.add;
  return options;
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
  measured.model = modelOf(prepared, choice, {});
  if (!measured.model) measured.springs = identification::identify(campaign);
  if (measured.model) measured.next = diagnosisOf(prepared, measured.model).next;
  return measured;
}

/// What is not known of the effects in the model; empty where there are none.
planning::EffectDoubt doubtOf(const std::optional<extended_model::ExtendedModel>& model) {
  planning::EffectDoubt doubt;
  if (!model || model->effects.free.empty()) return doubt;
  doubt.moves = [&model = *model](const Vector6d& q, const Eigen::Vector3d& force,
                                  const Eigen::Vector3d& point_in_flange, const std::vector<Eigen::Vector3d>& targets) {
    return extended_model::displacementBySteps(model.effects, model.spread.parameters, q,
                                               {point_in_flange, force, Eigen::Vector3d::Zero()}, targets);
  };
  for (std::size_t m = 0; m < doubt.covariance.size(); ++m)
    doubt.covariance[m] = model->spread.compliance[m] * model->spread.compliance[m].transpose();
  return doubt;
}

/// Writes what `--out` asks for.
void writeOut(const PlanArguments& arguments, const std::function<std::string(bool xml)>& content) {
  if (arguments.out.empty()) return;
  io::requireNotRead(arguments.out);
  io::writeFileWhole(arguments.out, content(std::filesystem::path(arguments.out).extension() == ".xml"));
}

/// A day without a load: postures that calibrate, in an order that tells effects apart.
int planUnloadedDay(const PlanArguments& arguments, const Given& given, const planning::PlanOptions& loaded) {
  planning::UnloadedPlanOptions options;
  if (given.postures->count() > 0) options.postures = loaded.postures;
  if (given.candidates->count() > 0) options.candidates = loaded.candidates;
  options.seed = loaded.seed;
  options.inputs = loaded.inputs;
  options.rules = loaded.rules;
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(openCampaign(arguments.campaign));
  const campaign::Campaign& campaign = prepared.campaign;
  const planning::UnloadedPlan plan = planning::planUnloaded(campaign, options);
  writeOut(arguments, [&](bool xml) { return xml ? reports::unloadedPlanXml(plan) : reports::unloadedPlanCsv(plan); });
  deliver([&] { return reports::unloadedPlanJson(campaign, plan); },
          [&] { return reports::unloadedPlanText(campaign, plan); }, arguments.json);
  return plan.postures.empty() ? kNotUsable : kDone;
}

int planDay(const PlanArguments& arguments, const Given& given) {
  requireOwnFiles({{"--out", arguments.out}, {"--json", arguments.json}});
  planning::PlanOptions options = optionsOf(arguments, given);
  if (arguments.unloaded) return planUnloadedDay(arguments, given, options);
  const preparation::PreparedCampaign prepared = preparation::prepareCampaign(openCampaign(arguments.campaign));
  const Measured measured = measuredBy(prepared, arguments.model);
  const campaign::Campaign& campaign = measured.campaign(prepared.campaign);
  options.inputs.effects = doubtOf(measured.model);
  const planning::Plan plan = planning::planCampaign(campaign, measured.identification(), options);
  writeOut(arguments, [&](bool xml) { return xml ? reports::planXml(plan) : reports::planCsv(plan); });
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
  deliver(json, text, arguments.json);
  return plan.usable && !plan.postures.empty() ? kDone : kNotUsable;
}

}  // namespace

void addPlan(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<PlanArguments>();
  planning::PlanOptions& options = arguments->options;
  CLI::App* command = app.add_subcommand("plan", "Postures and loads to measure, before the day or after it");
  command
      ->add_option("CAMPAIGN", arguments->campaign,
                   "campaign folder or its campaign.xml; before the day it needs no tables")
      ->required();
  addModelOptions(*command, arguments->model);
  Given given{};
  given.postures = command->add_option("--postures", options.postures, "how many")->capture_default_str();
  given.add = command->add_option("--add", arguments->add, "how many to add to those that the campaign has measured")
                  ->excludes(const_cast<CLI::Option*>(given.postures));
  given.load =
      command->add_option("--load", arguments->load, "newtons that hang; without it, and without --pull, as measured");
  given.pull = command->add_option("--pull", arguments->pull, "newtons of a cable, pulling in any of nine directions")
                   ->excludes(const_cast<CLI::Option*>(given.load));
  command->add_option("--hook", arguments->hook_mm, "x,y,z (mm) on the flange where the load acts")
      ->delimiter(',')
      ->expected(3);
  command->add_option("--tracker", arguments->tracker_mm, "x,y,z (mm) of the tracker in base_link")
      ->delimiter(',')
      ->expected(3);
  command->add_option("--min-deg", arguments->min_deg, "least joint angles, six")->delimiter(',')->expected(6);
  command->add_option("--max-deg", arguments->max_deg, "largest joint angles, six")->delimiter(',')->expected(6);
  command->add_option("--repeats", options.inputs.repeats, "readings of each reflector in a state")
      ->capture_default_str();
  const auto unloaded =
      command->add_flag("--unloaded", arguments->unloaded,
                        "a day without a load: postures that calibrate the geometry, in an order that tells effects of "
                        "the order apart; 40 of 400 unless said otherwise");
  command
      ->add_option("--criterion", arguments->criterion,
                   "balanced (no joint pays for another) or determinant (D-optimal)")
      ->capture_default_str();
  given.candidates =
      command->add_option("--candidates", options.candidates, "random postures to choose from")->capture_default_str();
  command->add_option("--seed", options.seed, "of the random postures")->capture_default_str();
  command->add_option(
      "--out", arguments->out,
      "write the postures to this file: CSV, or where its name ends in .xml the <postures> of a simulation");
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  // What only a load has is refused, not ignored.
  for (const char* loaded : {"--add", "--load", "--pull", "--hook", "--criterion", "--with", "--springs-only"})
    unloaded->excludes(command->get_option(loaded));
  command->callback([arguments, given, &run] { run = [arguments, given] { return planDay(*arguments, given); }; });
}

}  // namespace stiffscope::app
