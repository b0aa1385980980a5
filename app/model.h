#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/diagnosis/diagnose.h"
#include "core/extended_model/extend_model.h"
#include "core/identification/identify.h"
#include "core/preparation/prepare.h"

namespace CLI {
class App;
}

namespace stiffscope::app {

/// Which model a command computes by.
struct ModelChoice {
  std::vector<std::string> with;  ///< effects asked for; empty or "auto": what the data support
  bool springs_only = false;      ///< the paper's
};

/// Adds --with and --springs-only to a command.
void addModelOptions(CLI::App& command, ModelChoice& choice);

/// The model that was asked for, fitted to the campaign as it is used; empty for joint springs alone. Throws InputError
/// for names that are unknown or do not go together, and for effects that the campaign cannot show.
std::optional<extended_model::ExtendedModel> modelOf(
    const preparation::PreparedCampaign& prepared, const ModelChoice& choice,
    const identification::IdentifyOptions& options,
    extended_model::Followed followed = extended_model::Followed::by_nothing);

/// The diagnosis of a loaded day, from the model's own study where it has one, with the stiffnesses that the model has.
diagnosis::Diagnosis diagnosisOf(const preparation::PreparedCampaign& prepared,
                                 const std::optional<extended_model::ExtendedModel>& model,
                                 const diagnosis::DiagnoseOptions& options = {});

}  // namespace stiffscope::app
