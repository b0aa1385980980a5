#include "app/model.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "core/extended_model/extend_model.h"
#include "core/extended_model/requested_effects.h"
#include "core/io/input_error.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

void addModelOptions(CLI::App& command, ModelChoice& choice) {
  CLI::Option* with =
      command
          .add_option(
              "--with", choice.with,
              "effects that the model has besides joint springs, by their names in diagnose, with a part where "
              "that is to be chosen (bearing_tilt:3, joint_coupling:2-3, target_motion:P12); without it, and by "
              "auto, those that the data support")
          ->type_name("EFFECT")
          ->delimiter(',')
          ->allow_extra_args(false);
  command.add_flag("--springs-only", choice.springs_only, "joint springs and nothing else, the model of the paper")
      ->excludes(with);
}

namespace {

extended_model::EffectFit effectsAsked(const preparation::PreparedCampaign& prepared,
                                       const std::vector<std::string>& words) {
  try {
    return extended_model::fitEffects(prepared, extended_model::requestedEffects(words, prepared.campaign));
  } catch (const extended_model::UnfitEffect& error) {
    throw io::InputError(extended_model::kWithOption, std::string(effects::idOf(error.effect())),
                         reports::words(error.reason()));
  }
}

}  // namespace

std::optional<extended_model::ExtendedModel> modelOf(const preparation::PreparedCampaign& prepared,
                                                     const ModelChoice& choice,
                                                     const identification::IdentifyOptions& options,
                                                     extended_model::Followed followed) {
  if (choice.springs_only) return std::nullopt;
  const bool by_data =
      choice.with.empty() || std::find(choice.with.begin(), choice.with.end(), "auto") != choice.with.end();
  if (by_data && choice.with.size() > 1)
    throw io::InputError({"--with"}, "auto", "expected auto alone, or effects without it");
  return extended_model::withoutOutlying(
      prepared, options, [&](const preparation::PreparedCampaign& day, const identification::IdentifyOptions& how) {
        // Raw readings, too, are screened before effects are sought in them.
        std::optional<preparation::PreparedCampaign> screened;
        if (day.preparation.raw) screened = preparation::prepareCampaign(day.campaign);
        const preparation::PreparedCampaign& sought = screened ? *screened : day;
        if (by_data) return extended_model::supportedModel(sought, day.campaign, how, followed);
        return extended_model::extendModel(day.campaign, effectsAsked(sought, choice.with), how);
      });
}

diagnosis::Diagnosis diagnosisOf(const preparation::PreparedCampaign& prepared,
                                 const std::optional<extended_model::ExtendedModel>& model,
                                 const diagnosis::DiagnoseOptions& options) {
  diagnosis::Diagnosis diagnosis;
  if (prepared.preparation.raw) {
    diagnosis = diagnosis::diagnose(prepared.campaign, options);
  } else {
    // A study without the outlying postures is of another day.
    diagnosis = model && model->study && model->study->hasEquations() && !model->with.robust
                    ? diagnosis::diagnose(prepared, *model->study, options)
                    : diagnosis::diagnose(prepared, options);
  }
  if (model && diagnosis.usable) extended_model::stateStiffnesses(*model, diagnosis);
  return diagnosis;
}

}  // namespace stiffscope::app
