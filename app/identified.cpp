#include "app/identified.h"

#include <array>
#include <vector>

#include "app/options.h"
#include "app/prepared.h"
#include "core/extended_model/effect_deflection.h"
#include "core/identification/identify.h"
#include "core/identification/known_stiffness.h"
#include "core/io/input_error.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

MethodAndStep methodAndStep(const std::string& method, const std::string& step) {
  MethodAndStep asked;
  if (!method.empty()) {
    const std::vector<identification::Method> methods = methodsNamed(method);
    if (methods.size() > 1) throw io::InputError({"--method"}, method, "expected one of cp, pp or dpp");
    asked.method = methods.front();
  }
  asked.step = loadStepNamed(step);
  return asked;
}

Identified identifiedBy(const preparation::PreparedCampaign& prepared, const std::string& name,
                        const ModelChoice& model, const MethodAndStep& asked) {
  requireLoad(prepared.campaign);
  identification::IdentifyOptions options;
  options.step = asked.step;
  Identified found;
  found.improved = modelOf(prepared, model, options);
  if (!found.improved) found.springs = identification::identify(prepared.campaign, options);
  const identification::Identification& result = found.result();
  found.method = asked.method ? *asked.method : identification::bestMethod(result);
  found.shown_first =
      asked.method ? identification::shownFirstOf(result, std::array{found.method}) : result.shown_first;
  if (!found.of_method().available) {
    throw io::InputError({name}, "",
                         std::string(reports::namesOf(found.method).full) +
                             " is unavailable here: " + reports::words(found.of_method().reason));
  }
  return found;
}

PredictedArm::PredictedArm(const campaign::Campaign& campaign, std::optional<extended_model::ExtendedModel>& improved,
                           identification::Identification& result, identification::Method method,
                           std::optional<double> load_sd) {
  identification::MethodResult& own = result.methods[static_cast<std::size_t>(method)];
  estimates_.push_back(&own.estimate);
  if (improved) estimates_.push_back(&improved->without.methods[static_cast<std::size_t>(method)].estimate);
  for (identification::StiffnessEstimate* estimate : estimates_) {
    of_the_day_.push_back(*estimate);
    known_ = identification::completeByKnown(campaign.known_stiffness, *estimate);
  }
  const double by = load_sd.value_or(campaign.load_cell->gain_sigma);
  certainty_ =
      improved ? compensation::certaintyOf(*improved, method, by) : compensation::certaintyOf(result, method, by);
  if (improved && extended_model::deflectsByEffects(improved->effects))
    with_ = extended_model::effectDeflection(*improved, method);
  arm_.emplace(compensation::DeflectingArm{campaign, own.geometry, own.estimate, result.frames.tcp_in_flange,
                                           with_ ? &*with_ : nullptr, &*certainty_});
}

PredictedArm::~PredictedArm() {
  for (std::size_t i = 0; i < estimates_.size(); ++i) *estimates_[i] = of_the_day_[i];
}

}  // namespace stiffscope::app
