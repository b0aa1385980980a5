#pragma once

#include <optional>
#include <string>

#include "app/model.h"
#include "core/extended_model/extended_model.h"
#include "core/identification/identification.h"

namespace stiffscope::app {

/// A loaded day identified, and the one method of it that a prediction is made by.
struct Identified {
  std::optional<extended_model::ExtendedModel> improved;  ///< empty: joint springs alone, in `springs`
  std::optional<identification::Identification> springs;
  identification::Method method{};
  std::optional<identification::ShownFirst> shown_first;

  identification::Identification& result() { return improved ? improved->with : *springs; }
  identification::MethodResult& of_method() { return result().methods[static_cast<std::size_t>(method)]; }
  /// The one that it was identified from.
  const campaign::Campaign& campaign(const preparation::PreparedCampaign& prepared) const {
    return improved ? improved->campaign : prepared.campaign;
  }
};

/// What --method and --step say. Throws InputError, naming the option, for more methods than one and for what is none.
struct MethodAndStep {
  std::optional<identification::Method> method;  ///< empty: the one that identify shows first
  std::optional<int> step;                       ///< empty: the heaviest
};
MethodAndStep methodAndStep(const std::string& method, const std::string& step);

/// Throws InputError for a day without a load, and for a method that is not available; `name` is the campaign's on the
/// command line.
Identified identifiedBy(const preparation::PreparedCampaign& prepared, const std::string& name,
                        const ModelChoice& model, const MethodAndStep& asked);

}  // namespace stiffscope::app
