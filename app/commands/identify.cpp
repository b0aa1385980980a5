#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <memory>

#include "app/command_line.h"
#include "app/computations.h"
#include "app/model.h"
#include "app/options.h"
#include "app/output.h"
#include "app/prepared.h"
#include "core/campaign/state_points.h"
#include "core/extended_model/extended_model.h"
#include "core/identification/geometric_stiffness_cost.h"
#include "core/identification/held_out_loads.h"
#include "core/identification/identify.h"
#include "core/identification/load_case.h"
#include "core/identification/load_dependence.h"
#include "core/identification/posture_stiffness.h"
#include "core/identification/remarks.h"
#include "core/identification/warnings.h"
#include "core/io/input_error.h"
#include "core/mistakes/find_mistakes.h"
#include "core/numerics/parallel.h"
#include "reports/json/campaign_json.h"
#include "reports/json/identification_json.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/text/text.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

namespace {

identification::IdentifyOptions optionsOf(const IdentifyRequest& request) {
  identification::IdentifyOptions options;
  options.all_steps = request.step == "all";
  if (!options.all_steps) options.step = loadStepNamed(request.step, ", or all");
  options.finite_deflection = !request.neglect_kc;
  options.robust = request.robust;
  if (request.subset_size && *request.subset_size < 1) {
    throw io::InputError({"--subset-size"}, std::to_string(*request.subset_size), "expected 1 or more postures");
  }
  options.subsets.size = request.subset_size.value_or(0);
  constexpr int kMostDraws = 1'000'000;
  if (request.bootstrap < 0 || request.bootstrap > kMostDraws) {
    throw io::InputError({"--bootstrap"}, std::to_string(request.bootstrap), "expected 0 to 1000000 draws");
  }
  options.bootstrap.draws = request.bootstrap;
  return options;
}

/// A day without readings of reflectors, whose second encoders tell of the gears all the same.
bool encodersAlone(const campaign::Campaign& campaign) {
  return identification::whatLoadsLack(campaign).is(identification::RemarkId::no_readings_under_load) &&
         identification::hasSecondEncoders(campaign);
}

int identifyEncodersAlone(const preparation::PreparedCampaign& prepared, const Outlet& outlet) {
  const identification::Identification result = identification::framesAlone(prepared.campaign);
  const auto text = [&] {
    return prepared.campaign.name + reports::transmissionText(result, {}) +
           reports::preparationText(prepared.preparation);
  };
  outlet.deliver(
      [&] {
        reports::JsonDocument document = reports::identificationJson(prepared.campaign, result, {});
        document.json = reports::withPreparation(std::move(document.json), prepared.preparation);
        return document;
      },
      text);
  return result.transmission->measured() ? kDone : kNotUsable;
}

/// A day that has nothing to identify from: what is missing; in JSON method by method and joint by joint.
int identifyNothing(const preparation::PreparedCampaign& prepared, const std::vector<identification::Method>& methods,
                    const std::string& name, const Outlet& outlet) {
  const campaign::Campaign& campaign = prepared.campaign;
  const std::string lacking = reports::words(identification::whatLoadsLack(campaign));
  outlet.deliver(
      [&] {
        const identification::Identification result = identification::framesAlone(campaign);
        reports::JsonDocument document = reports::identificationJson(campaign, result, methods);
        document.json = reports::withPreparation(std::move(document.json), prepared.preparation);
        return document;
      },
      [&] { return campaign.name + ": no joint stiffness: " + lacking + "\n"; });
  outlet.explain(name + ": " + lacking +
                 (campaign::isUnloadedDay(campaign) ? "; `stiffscope calibrate` fits unloaded postures" : ""));
  return kNotUsable;
}

}  // namespace

int identifyCampaign(const IdentifyRequest& request, const CampaignSource& source, bool steps_shown,
                     const Outlet& outlet) {
  const std::vector<identification::Method> methods = methodsNamed(request.method);
  const identification::IdentifyOptions options = optionsOf(request);
  const auto opened = source.open();
  const preparation::PreparedCampaign& prepared = *opened;
  if (encodersAlone(prepared.campaign)) return identifyEncodersAlone(prepared, outlet);
  if (!identification::whatLoadsLack(prepared.campaign).empty())
    return identifyNothing(prepared, methods, source.name, outlet);
  mistakes::ModelAgreement agreement;
  std::optional<extended_model::ExtendedModel> improved;
  identification::Identification springs;
  numerics::onAllCores(2, [&](std::size_t part) {
    if (part == 1) return void(agreement = mistakes::findMistakes(prepared.campaign));
    improved = modelOf(prepared, request.model, options);
    if (!improved) springs = identification::identify(prepared.campaign, options);
  });
  const campaign::Campaign& campaign = improved ? improved->campaign : prepared.campaign;
  const identification::Identification& result = improved ? improved->with : springs;
  if (options.subsets.size >= static_cast<int>(result.cases.size()) && !result.cases.empty()) {
    throw io::InputError({"--subset-size"}, std::to_string(options.subsets.size),
                         fmt::format("expected fewer than the {} postures that identify", result.cases.size()));
  }
  // With a dozen load steps several times the work of the rest.
  steps_shown = steps_shown || options.all_steps;
  const identification::StepStudy steps =
      steps_shown ? identification::studySteps(campaign, options, result) : identification::StepStudy{};
  constexpr std::size_t kQuick = 1000;  // load states that are predicted without being asked for
  const bool few = prepared.campaign.pose_ids.size() * identification::loadedSteps(campaign).size() <= kQuick;
  const identification::HeldOutLoads loads =
      steps_shown || few ? identification::heldOutLoads(campaign, prepared.campaign, options, result)
                         : identification::HeldOutLoads{};
  const auto text = [&] {
    std::string all = reports::identificationText(campaign, result, methods);
    all += reports::heldOutLoadsText(loads, result, methods, improved && !improved->effects.added.empty());
    if (options.all_steps) all += reports::stepsText(steps, result, methods);
    if (const auto best = identification::bestMethodOf(result, methods); best && request.postures)
      all += reports::posturesText(campaign, result, *best);
    if (improved) all += reports::extendedModelText(*improved, methods);
    return all + reports::agreementText(agreement) + reports::preparationText(prepared.preparation);
  };
  outlet.deliver(
      [&] {
        reports::JsonDocument document = reports::identificationJson(campaign, result, methods);
        document.json = reports::withSteps(std::move(document.json), steps, result, methods);
        document.json = reports::withHeldOutLoads(std::move(document.json), loads, methods);
        if (improved) {
          document.json = reports::withEffects(std::move(document.json), *improved, methods);
          document.json = reports::withSupport(std::move(document.json), *improved, methods);
        }
        document.json = reports::withAgreement(std::move(document.json), agreement);
        document.json = reports::withPreparation(std::move(document.json), prepared.preparation);
        return document;
      },
      text);
  return identification::anyUsable(result, methods) && !agreement.contradicted() ? kDone : kNotUsable;
}

void addIdentify(CLI::App& app, Run& run) {
  struct IdentifyArguments {
    std::string campaign, json;
    bool raw = false;
    int subset_size = 0;
    IdentifyRequest request;
  };
  const auto arguments = std::make_shared<IdentifyArguments>();
  CLI::App* command = app.add_subcommand("identify", "Joint stiffness by Complete, Partial and Decoupled Partial Pose");
  command->footer(
      "Status 1 where no method gives a positive stiffness, as of a day without a load, or where the day contradicts "
      "the\n"
      "model so far that no number serves: what would mend it is named, as audit has it.");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command->add_option("--method", arguments->request.method, "cp, pp, dpp or all")->capture_default_str();
  command->add_option(
      "--step", arguments->request.step,
      "load step to identify from, or all of them together; without it the one with the largest mean force");
  const CLI::Option* subset =
      command->add_option("--subset-size", arguments->subset_size,
                          "postures that identify in Table II's subsets; without it 10 of 19, in proportion");
  command->add_flag("--neglect-kc", arguments->request.neglect_kc,
                    "neglect K_c and take Jacobians at the unloaded arm, as the paper does");
  command->add_flag("--robust", arguments->request.robust,
                    "leave postures out that disagree with the rest; without it they are only named");
  command->add_option("--bootstrap", arguments->request.bootstrap,
                      "draws of the postures for percentile intervals beside the stated ones");
  command->add_flag("--postures", arguments->request.postures,
                    "Cartesian stiffness and the share of K_c, posture by posture");
  addModelOptions(*command, arguments->request.model);
  addRawOption(*command, arguments->raw);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, subset, &run] {
    if (subset->count() > 0) arguments->request.subset_size = arguments->subset_size;
    run = [arguments] {
      return identifyCampaign(arguments->request,
                              sourceOf(arguments->campaign, arguments->raw, hashesFor(arguments->json)),
                              !arguments->json.empty(), commandLineOutlet(arguments->json));
    };
  });
}

}  // namespace stiffscope::app
