#include "app/prediction.h"

#include "reports/json/identification_json.h"
#include "reports/json/json_document.h"
#include "reports/text/text.h"
#include "reports/words/numbers.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

Prediction::Prediction(const CampaignSource& source, const PredictionRequest& request) {
  const MethodAndStep choice = methodAndStep(request.method, request.step);
  prepared_ = source.open();
  found_ = identifiedBy(*prepared_, source.name, request.model, choice);
  std::optional<double> load_sd;
  if (request.load_sd_percent) load_sd = 0.01 * *request.load_sd_percent;
  predicted_.emplace(campaign(), found_.improved, found_.result(), found_.method, load_sd);
  known_ = predicted_->known();
}

std::vector<compensation::CompensatedPosture> Prediction::compensate(
    const std::vector<compensation::PostureToCompensate>& postures) const {
  const compensation::DeflectingArm& by = arm();
  return compensation::compensate(by.campaign, by.geometry, by.estimate, by.tcp_in_flange, postures, {}, by.with,
                                  by.certainty);
}

int Prediction::deliver(const std::vector<compensation::CompensatedPosture>& rows,
                        const std::function<reports::Json(const std::vector<std::string>& cautions)>& json,
                        const std::function<std::string(const std::vector<std::string>& cautions)>& text,
                        const Outlet& outlet) {
  predicted_.reset();
  const identification::Identification& result = found_.result();
  const std::optional<identification::ShownFirst>& first = found_.shown_first;
  const std::vector<identification::Method> methods{found_.method};
  std::vector<std::string> cautions = reports::words(result.cautions);
  for (const Remark& note : compensation::jointCountRemarks(rows)) cautions.push_back(reports::words(note));
  for (const Remark& caution : compensation::implausibleCommands(rows)) cautions.push_back(reports::words(caution));
  outlet.deliver(
      [&] {
        reports::Json document = json(cautions);
        document["shown_first"] = reports::shownFirstJson(first);
        document["cautions"] = cautions;
        if (found_.improved) document = reports::withEffects(std::move(document), *found_.improved, methods);
        return reports::withPreparation(std::move(document), prepared_->preparation);
      },
      [&] {
        return text(cautions) + (first ? reports::wrapped(reports::shownFirstWords(result, *first), 2) + "\n" : "") +
               (found_.improved ? reports::extendedModelText(*found_.improved, methods) : "") +
               reports::preparationText(prepared_->preparation);
      });
  return compensation::summaryOf(rows).mostRefused() ? kNotUsable : kDone;
}

}  // namespace stiffscope::app
