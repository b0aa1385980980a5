#include "core/accuracy/accuracy_diagnosis.h"

#include <utility>

#include "core/io/units.h"
#include "reports/json/campaign_json.h"
#include "reports/json/gap_json.h"
#include "reports/json/json.h"
#include "reports/words/calibration_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

Json idsOf(const std::vector<accuracy::UnloadedEffect>& effects) {
  Json ids = Json::array();
  for (const accuracy::UnloadedEffect effect : effects) ids.push_back(std::string(idOf(effect)));
  return ids;
}

Json classJson(const accuracy::AccuracyClass& one) {
  Json parts = Json::array();
  std::size_t k = 0;
  for (const calibration::EffectPart& part : one.parts) {
    Json json{{"detail", part.detail}};
    if (part.order) json["order"] = *part.order;
    Json terms = Json::array();
    for (const calibration::EffectTerm& term : part.terms) {
      terms.push_back(
          {{"name", term.name}, {"unit", term.unit}, {"value", number(one.sizes[k])}, {"sd", number(one.sds[k])}});
      ++k;
    }
    json["terms"] = std::move(terms);
    parts.push_back(std::move(json));
  }
  return {{"effects", idsOf(one.effects)},      {"detail", one.detail},          {"score", number(one.score)},
          {"size_um", micrometres(one.size)},   {"in_verdict", one.in_verdict},  {"shrink", shrinkJson(one.shrink)},
          {"explained", number(one.explained)}, {"parameters", std::move(parts)}};
}

}  // namespace

Json accuracyJson(const campaign::Campaign& campaign, const accuracy::AccuracyDiagnosis& accuracy) {
  Json json{{"campaign", campaignJson(campaign)}, {"usable", accuracy.usable}, {"unloaded", true}};
  if (!accuracy.usable) {
    json["reason"] = words(accuracy.unusable_reason);
    return json;
  }
  Json verdict = Json::array(), details = Json::array();
  if (accuracy.verdict.empty()) verdict.push_back({"none"});
  for (const accuracy::AccuracyEntry& entry : accuracy.verdict) {
    verdict.push_back(entry.effects.empty() ? Json::array({"unknown"}) : idsOf(entry.effects));
    details.push_back(entry.detail);
  }
  json["verdict"] = std::move(verdict);
  json["verdict_details"] = std::move(details);
  std::string reason;
  for (const std::string& sentence : words(accuracy.reasons)) reason += (reason.empty() ? "" : " ") + sentence;
  json["reason"] = reason;
  Json classes = Json::array(), aliases = Json::array();
  for (const accuracy::AccuracyClass& one : accuracy.classes) classes.push_back(classJson(one));
  for (const auto& group : accuracy.aliases) aliases.push_back(idsOf(group));
  json["classes"] = std::move(classes);
  json["aliases"] = std::move(aliases);
  json["shrink_together"] = shrinkJson(accuracy.shrink_together);
  json["gap"] = {{"nominal_um", micrometres(accuracy.gap.nominal)},
                 {"before_um", micrometres(accuracy.gap.before)},
                 {"noise_um", micrometres(accuracy.gap.noise)},
                 {"after_um", micrometres(accuracy.gap.after)}};
  Json detectable = Json::object(), not_testable = Json::object();
  for (const accuracy::DetectableEffect& one : accuracy.detectable)
    detectable[std::string(idOf(one.effect))] = one.size ? micrometres(*one.size) : Json(nullptr);
  for (const accuracy::UntestableEffect& one : accuracy.not_testable)
    not_testable[std::string(idOf(one.effect))] = words(one.missing);
  json["detectable_um"] = std::move(detectable);
  json["not_testable"] = std::move(not_testable);
  json["geometry"] = {{"rms_um", micrometres(accuracy.gap.nominal)},
                      {"limit_um", micrometres(accuracy.geometry_limit)}};
  json["limits"] = {{"size_um", micrometres(accuracy.size_limit)}};
  json["chi2_per_equation"] = {{"after", number(accuracy.left_over)},
                               {"after_limit", number(accuracy.left_over_limit)}};
  json["of_readings"] = accuracy.as_read ? "as_read" : "as_used";
  json["postures"] = accuracy.postures;
  json["readings"] = accuracy.readings;
  json["where"] = tablesJson(accuracy.where);
  json["where_after"] = tablesJson(accuracy.where_after);
  if (Json overlaps = overlapsJson(accuracy.where); !overlaps.is_null())
    json["where_overlapping"] = std::move(overlaps);
  Json next = Json::array();
  for (const Remark& one : accuracy.next) next.push_back({{"measure", words(one)}});
  json["next"] = std::move(next);
  json["joint_angles"] = anglesJson(accuracy.calibration);
  return json;
}

}  // namespace stiffscope::reports
