#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/command_line.h"
#include "app/identified.h"
#include "app/output.h"
#include "app/prepared.h"
#include "app/urdf.h"
#include "core/calibration/calibrate.h"
#include "core/campaign/certificate.h"
#include "core/effects/all.h"
#include "core/elastic_model/elastic_model.h"
#include "core/elastic_model/simulator_models.h"
#include "core/extended_model/effect_fit.h"
#include "core/identification/identify.h"
#include "core/identification/known_stiffness.h"
#include "core/identification/warnings.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/write_file.h"
#include "core/robot/body_inertia.h"
#include "reports/certificate/dcc.h"
#include "reports/json/campaign_json.h"
#include "reports/json/export_json.h"
#include "reports/json/json.h"
#include "reports/text/text.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

namespace {

struct UrdfArguments {
  std::string campaign, out, json;
  bool raw = false;
};

/// Where the sweeps have the arm, in base_link; empty where they do not place it.
std::optional<robot::Robot> sweptArm(const campaign::Campaign& campaign) {
  const frames::ArmInR0 swept = identification::solvedFrames(campaign).arm;
  if (!swept.points_placed) return std::nullopt;
  const Eigen::Isometry3d base_from_r0 = swept.r0_from_base_link.inverse();
  robot::Robot arm = campaign.robot;
  for (std::size_t j = 0; j < arm.axes_in_base_at_zero.size(); ++j) {
    const metrology::Line& axis = swept.arm.axes_in_base_at_zero[j];
    arm.axes_in_base_at_zero[j] = {base_from_r0 * axis.point, base_from_r0.linear() * axis.direction};
  }
  arm.base_from_flange_at_zero = base_from_r0 * swept.arm.base_from_flange_at_zero;
  return arm;
}

int exportUrdf(const UrdfArguments& arguments) {
  requireOwnFiles({{"--out", arguments.out}, {"--json", arguments.json}});
  const preparation::PreparedCampaign prepared =
      openPrepared(arguments.campaign, arguments.raw, hashesFor(arguments.json));
  const campaign::Campaign& campaign = prepared.campaign;
  const calibration::Calibration calibration = calibration::calibrate(prepared, {});
  const bool by_postures = calibration.reason.empty();
  std::optional<robot::Robot> arm;
  if (by_postures) {
    arm = calibration.geometry().fit.arm(campaign.robot);
  } else {
    arm = sweptArm(campaign);
  }
  if (!arm) {
    std::fprintf(stderr, "stiffscope: %s: neither sweeps of axes 1 and 2 nor unloaded postures give a geometry: %s\n",
                 arguments.campaign.c_str(), reports::words(calibration.reason).c_str());
    return kNotUsable;
  }
  writeCalibratedUrdf(campaign, *arm, arguments.out);
  deliver(
      [&] {
        return reports::withPreparation(reports::urdfExportJson(campaign, arguments.out, by_postures),
                                        prepared.preparation);
      },
      [&] {
        return reports::urdfExportText(campaign, arguments.out, by_postures) +
               reports::preparationText(prepared.preparation);
      },
      arguments.json);
  return kDone;
}

void addUrdf(CLI::App& parent, Run& run) {
  const auto arguments = std::make_shared<UrdfArguments>();
  CLI::App* command = parent.add_subcommand("urdf", "The campaign's URDF with calibrated joint origins");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  command->add_option("--out", arguments->out, "file to write")->required();
  addRawOption(*command, arguments->raw);
  command->add_option("--json", arguments->json, "write what was exported to this file, - for standard output");
  command->callback([arguments, &run] { run = [arguments] { return exportUrdf(*arguments); }; });
}

/// What is exported of an identified day.
struct IdentifiedArguments {
  std::string campaign, out, json, method, step;
  bool raw = false;
  ModelChoice model;
};

void addIdentifiedOptions(CLI::App& command, IdentifiedArguments& arguments) {
  command.add_option("CAMPAIGN", arguments.campaign, "campaign folder or its campaign.xml")->required();
  command.add_option("--out", arguments.out, "file to write")->required();
  command.add_option("--method", arguments.method, "cp, pp or dpp; without it the one that identify shows first");
  command.add_option("--step", arguments.step, "load step to identify from");
  addModelOptions(command, arguments.model);
  addRawOption(command, arguments.raw);
  command.add_option("--json", arguments.json, "write what was exported to this file, - for standard output");
}

using Writer = std::string (*)(const elastic_model::ElasticChain& chain, const std::vector<std::string>& comments);

struct ElasticArguments : IdentifiedArguments {
  std::string format;
  Writer write = nullptr;
};

int exportElastic(const ElasticArguments& arguments) {
  const MethodAndStep choice = methodAndStep(arguments.method, arguments.step);
  requireOwnFiles({{"--out", arguments.out}, {"--json", arguments.json}});
  const preparation::PreparedCampaign prepared =
      openPrepared(arguments.campaign, arguments.raw, hashesFor(arguments.json));
  if (prepared.campaign.robot.coupled()) {
    throw io::InputError({urdfOf(prepared.campaign).string(), 0, "mimic"}, "",
                         "expected joints that turn an axis each: an elastic joint that others follow is not written; "
                         "`export urdf` is");
  }
  Identified found = identifiedBy(prepared, arguments.campaign, arguments.model, choice);
  const campaign::Campaign& campaign = found.campaign(prepared);
  const identification::MethodResult& method = found.of_method();
  identification::StiffnessEstimate estimate = method.estimate;
  identification::completeByKnown(campaign.known_stiffness, estimate);
  elastic_model::ElasticSource source{campaign, method.geometry, estimate, found.result().frames.tcp_in_flange};
  source.inertias =
      robot::bodyInertias(urdfBytes(campaign), urdfOf(campaign).string(), campaign.base_link, campaign.flange_link);
  if (found.improved) {
    const extended_model::EffectFit& effects = found.improved->effects;
    source.effects = extended_model::machineEffects(effects, effects.parameters());
    for (const extended_model::AddedEffect& one : effects.added) source.added.push_back(one.effect);
  }
  const elastic_model::ElasticModel model = elastic_model::elasticModel(source);
  const reports::ExportedModel exported{arguments.format, arguments.out, found.method, arguments.model.springs_only,
                                        model};
  io::requireNotRead(arguments.out);
  io::writeFileWhole(arguments.out, arguments.write(model.chain, reports::exportComments(campaign, exported)));
  deliver(
      [&] {
        reports::Json json = reports::exportJson(campaign, exported);
        if (found.improved) json = reports::withEffects(std::move(json), *found.improved, {found.method});
        return reports::withPreparation(std::move(json), prepared.preparation);
      },
      [&] {
        return reports::exportText(campaign, exported) +
               (found.improved ? reports::addedEffectsText(found.improved->effects) : "") +
               reports::preparationText(prepared.preparation);
      },
      arguments.json);
  return kDone;
}

void addElastic(CLI::App& parent, Run& run, const std::string& format, const std::string& program, Writer write) {
  const auto arguments = std::make_shared<ElasticArguments>();
  arguments->format = format;
  arguments->write = write;
  CLI::App* command = parent.add_subcommand(format, "The arm as bodies, drives and springs in series, for " + program);
  addIdentifiedOptions(*command, *arguments);
  command->callback([arguments, &run] { run = [arguments] { return exportElastic(*arguments); }; });
}

int exportDcc(const IdentifiedArguments& arguments) {
  const MethodAndStep choice = methodAndStep(arguments.method, arguments.step);
  requireOwnFiles({{"--out", arguments.out}, {"--json", arguments.json}});
  const preparation::PreparedCampaign prepared = openPrepared(arguments.campaign, arguments.raw);
  std::vector<std::string> warnings;
  const campaign::Certificate certificate = campaign::readCertificate(prepared.campaign, warnings);
  printWarnings(warnings);
  const std::vector<std::string> missing = certificate.missing();
  if (!missing.empty()) {
    throw io::InputError(
        {(prepared.campaign.folder / prepared.campaign.inputs.front().name).string(), 0, "certificate"}, "",
        fmt::format("expected what a certificate has to say; missing: {}", fmt::join(missing, ", ")));
  }
  Identified found = identifiedBy(prepared, arguments.campaign, arguments.model, choice);
  const campaign::Campaign& campaign = found.campaign(prepared);
  const reports::DccContent content{
      campaign,          certificate, found.result(), found.method, found.improved ? &*found.improved : nullptr,
      STIFFSCOPE_VERSION};
  io::requireNotRead(arguments.out);
  io::writeFileWhole(arguments.out, reports::dccXml(content));
  deliver(
      [&] { return reports::withPreparation(reports::dccExportJson(content, arguments.out), prepared.preparation); },
      [&] { return reports::dccExportText(content, arguments.out) + reports::preparationText(prepared.preparation); },
      arguments.json);
  return identification::anyUsable(found.result(), {found.method}) ? kDone : kNotUsable;
}

void addDcc(CLI::App& parent, Run& run) {
  const auto arguments = std::make_shared<IdentifiedArguments>();
  CLI::App* command =
      parent.add_subcommand("dcc", "Digital Calibration Certificate (PTB's schema 3.3.0) of the joint stiffnesses");
  command->footer(
      "What it has to say besides results stands in the element certificate of campaign.xml; what is missing\n"
      "there is listed, and nothing is written. It is not signed: that is the laboratory's.");
  addIdentifiedOptions(*command, *arguments);
  command->callback([arguments, &run] { run = [arguments] { return exportDcc(*arguments); }; });
}

}  // namespace

void addExport(CLI::App& app, Run& run) {
  CLI::App* command =
      app.add_subcommand("export", "For other programs: URDF, MuJoCo, SDFormat, calibration certificate");
  command->require_subcommand(1);
  addUrdf(*command, run);
  addElastic(*command, run, "mjcf", "MuJoCo", &elastic_model::mjcf);
  addElastic(*command, run, "sdf", "Gazebo and what else reads SDFormat", &elastic_model::sdf);
  addDcc(*command, run);
}

}  // namespace stiffscope::app
