#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/model.h"
#include "core/compensation/compensate.h"
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

/// What predictions by one method are made of. While it lives, the stiffnesses of every model that a prediction may
/// come from have what is known of joints that the day cannot see (known_stiffness in campaign.xml); afterwards they
/// are the day's again, as tables show them. Refers to all of its arguments. `load_sd`: of the loads' size, a share;
/// without it that of the load cell's scale.
class PredictedArm {
 public:
  PredictedArm(const campaign::Campaign& campaign, std::optional<extended_model::ExtendedModel>& improved,
               identification::Identification& result, identification::Method method,
               std::optional<double> load_sd = {});
  ~PredictedArm();
  PredictedArm(const PredictedArm&) = delete;
  PredictedArm& operator=(const PredictedArm&) = delete;

  const compensation::DeflectingArm& arm() const { return *arm_; }
  const std::vector<campaign::KnownStiffness>& known() const { return known_; }  ///< those put in

 private:
  std::vector<identification::StiffnessEstimate*> estimates_;
  std::vector<identification::StiffnessEstimate> of_the_day_;
  std::vector<campaign::KnownStiffness> known_;
  std::optional<effects::EffectDeflection> with_;
  std::optional<compensation::Certainty> certainty_;
  std::optional<compensation::DeflectingArm> arm_;
};

}  // namespace stiffscope::app
