#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/command_line.h"
#include "app/computations.h"
#include "app/figures/figures.h"
#include "app/model.h"
#include "app/options.h"
#include "app/output.h"
#include "app/prepared.h"
#include "app/terminal.h"
#include "core/accuracy/diagnose_accuracy.h"
#include "core/campaign/campaign.h"
#include "core/campaign/state_points.h"
#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/spike_study.h"
#include "core/identification/identify.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/write_file.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/text/text.h"

namespace stiffscope::app {

namespace {

struct DiagnoseArguments {
  std::string campaign, json, picture, angles = "reported";
  std::vector<std::string> spike;
  diagnosis::SpikeOptions options;
};

std::vector<effects::Effect> effectsToAdd(const std::vector<std::string>& words) {
  std::vector<effects::Effect> wanted;
  for (const std::string& word : words) {
    if (word.empty()) continue;  // the option without a value
    const auto effect = effects::effectOf(word);
    if (!effect) {
      const std::vector<std::string> known(effects::kEffectIds.begin(), effects::kEffectIds.end());
      throw io::InputError({"--spike"}, word,
                           fmt::format("expected none, for all, or effects of: {}{}",
                                       fmt::join(effects::kEffectIds, ", "), io::nearestNameHint(word, known)));
    }
    wanted.push_back(*effect);
  }
  return wanted;
}

void drawSpikes(const std::string& file, const campaign::Campaign& campaign, const diagnosis::Diagnosis& baseline,
                const diagnosis::SpikeStudy& study) {
  const std::optional<render::PointChart> chart = spikeCurves(campaign, baseline, study);
  if (!chart) {
    printWarnings({file + ": not drawn: no effect could be added to this day"});
    return;
  }
  constexpr int kPanelWidth = 400, kPanelHeight = 250, kAround = 190, kLeastWidth = 1000;
  const int panels = static_cast<int>(chart->diagrams.size());
  const int rows = (panels + chart->columns - 1) / chart->columns;
  const std::vector<std::uint8_t> png = render::encodePng(
      render::render(*chart, {std::max(kLeastWidth, kPanelWidth * chart->columns), kAround + kPanelHeight * rows}));
  io::writeFileWhole(file, std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
}

/// The diagnosis with the stiffnesses that identify states: its subsets decide which method's are shown. Of a day that
/// has nothing to identify from: what it lacks.
diagnosis::Diagnosis diagnosed(const preparation::PreparedCampaign& prepared) {
  const Remark lacking = identification::whatLoadsLack(prepared.campaign);
  if (lacking.empty()) return diagnosisOf(prepared, modelOf(prepared, {}, {}, extended_model::Followed::by_diagnosis));
  diagnosis::Diagnosis none(prepared.campaign.robot.joints());
  none.unusable_reason = lacking;
  return none;
}

int diagnoseWithSpikes(DiagnoseArguments& arguments) {
  arguments.options.effects = effectsToAdd(arguments.spike);
  requireOwnFiles({{"--picture", arguments.picture}, {"--json", arguments.json}});
  const campaign::Campaign campaign = openCampaign(arguments.campaign);
  if (!arguments.picture.empty()) io::requireNotRead(arguments.picture);  // before the study, which takes minutes
  requireLoad(campaign);
  const diagnosis::Diagnosis diagnosis = diagnosed(preparation::prepareCampaign(campaign));
  const diagnosis::SpikeStudy study =
      diagnosis::spikeStudy(campaign, diagnosis, arguments.options,
                            [](std::size_t done, std::size_t total) { atWork("diagnosed", done, total); });
  if (!arguments.picture.empty()) drawSpikes(arguments.picture, campaign, diagnosis, study);
  deliver([&] { return reports::withSpikes(reports::diagnosisJson(campaign, diagnosis), study); },
          [&] {
            const std::string text = reports::diagnosisText(campaign, diagnosis);
            return diagnosis.usable ? text + reports::spikeText(diagnosis, study) : text;
          },
          arguments.json);
  return diagnosis.usable ? kDone : kNotUsable;
}

int diagnoseAccuracyOf(const preparation::PreparedCampaign& prepared, const std::string& angles, const Outlet& outlet) {
  calibration::CalibrationOptions options = accuracy::kDiagnosisFolds;
  options.angles = jointAnglesNamed(angles);
  requireCommanded(prepared.campaign, options.angles);
  const accuracy::AccuracyDiagnosis diagnosis = accuracy::diagnoseAccuracy(prepared, options);
  outlet.deliver([&] { return reports::accuracyJson(prepared.campaign, diagnosis); },
                 [&] { return reports::accuracyText(prepared.campaign, diagnosis); });
  return diagnosis.usable ? kDone : kNotUsable;
}

}  // namespace

int diagnoseCampaign(const std::string& angles, const CampaignSource& source, const Outlet& outlet) {
  const auto opened = source.open();
  const preparation::PreparedCampaign& prepared = *opened;
  if (campaign::isUnloadedDay(prepared.campaign)) return diagnoseAccuracyOf(prepared, angles, outlet);
  if (jointAnglesNamed(angles) != calibration::JointAngles::reported)
    throw io::InputError({"--angles"}, angles, "expected a day without a load");
  const diagnosis::Diagnosis diagnosis = diagnosed(prepared);
  outlet.deliver([&] { return reports::diagnosisJson(prepared.campaign, diagnosis); },
                 [&] { return reports::diagnosisText(prepared.campaign, diagnosis); });
  return diagnosis.usable ? kDone : kNotUsable;
}

void addDiagnose(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<DiagnoseArguments>();
  CLI::App* command =
      app.add_subcommand("diagnose", "What the stiffness model misses: where, which effect, how far it shrinks");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  CLI::Option* spike =
      command
          ->add_option("--spike", arguments->spike,
                       "prove it on this day: add effects (all, or those named, with commas between them) to its own "
                       "readings in several sizes, diagnose each such day, and count how often they are named")
          ->type_name("[EFFECT,...]")
          ->delimiter(',')
          ->expected(0, 1)
          ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      ->add_option("--sizes", arguments->options.sizes,
                   "sizes to add, times the smallest that would have been seen, with commas between them")
      ->type_name("FLOAT,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str()
      ->needs(spike);
  command->add_option("--draws", arguments->options.draws, "days for each effect and size")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->needs(spike);
  command->add_option("--seed", arguments->options.seed, "another seed, other joints, parts and directions")
      ->capture_default_str()
      ->needs(spike);
  command->add_option("--picture", arguments->picture, "draw the counts over the sizes into this PNG file")
      ->needs(spike);
  command->add_option("--angles", arguments->angles, "of a day without a load: reported or commanded joint angles")
      ->capture_default_str()
      ->excludes(spike);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, spike, &run] {
    run = [arguments, spiked = spike->count() > 0] {
      if (spiked) return diagnoseWithSpikes(*arguments);
      return diagnoseCampaign(arguments->angles, sourceOf(arguments->campaign, false),
                              commandLineOutlet(arguments->json));
    };
  });
}

}  // namespace stiffscope::app
