#include "core/extended_model/extended_model.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"

#include <cmath>

#include "core/effects/all.h"
#include "core/io/units.h"
#include "reports/words/effect_words.h"
#include "reports/words/extended_model_words.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

const char* natureKey(effects::EffectNature nature) {
  switch (nature) {
    case effects::EffectNature::machine:
      return "machine";
    case effects::EffectNature::load:
      return "load";
    case effects::EffectNature::measurement:
      return "measurement";
    case effects::EffectNature::geometry:
      return "geometry";
  }
  return "";
}

Json effectJson(effects::Effect effect) {
  return {{"effect", std::string(effects::idOf(effect))},
          {"nature", natureKey(effects::natureOf(effect))},
          {"enters_compensation", effects::entersCompensation(effect)},
          {"use", reports::effectUse(effect)}};
}

Json addedJson(const extended_model::AddedEffect& one) {
  Json json = effectJson(one.effect);
  json["detail"] = one.detail;
  json["shape"] = one.shape;
  json["score"] = number(one.score);
  json["plausible"] = one.plausible;
  Json parameters = Json::array();
  for (const extended_model::EffectParameter& parameter : one.parameters) {
    parameters.push_back({{"name", parameter.name},
                          {"unit", parameter.unit},
                          {"value", number(parameter.value)},
                          {"sd", number(parameter.sd)}});
  }
  json["parameters"] = parameters;
  return json;
}

Json shareJson(const std::optional<identification::Compensation>& share, bool subsets) {
  if (!share) return nullptr;
  return {{"held_out", subsets ? number(share->subsets.held_out) : Json(nullptr)},
          {"all_postures", number(share->all_postures)}};
}

Json shownMethodJson(const identification::MethodResult& method) {
  if (!method.available) return {{"unavailable", words(method.reason)}};
  const identification::StiffnessEstimate& estimate = method.estimate;
  const auto byJoint = [&](const auto& entry) {
    Json list = Json::array();
    for (int joint = 0; joint < estimate.joints(); ++joint)
      list.push_back(estimate.identifiable[static_cast<std::size_t>(joint)] ? number(entry(joint)) : Json(nullptr));
    return list;
  };
  const bool subsets = !method.subsets.compliances.empty();
  return {{"stiffness_nm_per_rad", byJoint([&](int j) { return estimate.stiffness(j); })},
          {"sd_nm_per_rad", byJoint([&](int j) { return estimate.stiffnessSd(j); })},
          {"sd_by_effects_nm_per_rad", byJoint([&](int j) {
             return std::sqrt(estimate.parts.effects(j, j)) / (estimate.compliance[j] * estimate.compliance[j]);
           })},
          {"rms_residual_mm", number(estimate.rms_residual / io::kMillimetre)},
          {"sigma_mm", number(estimate.sigma / io::kMillimetre)},
          {"compensated", shareJson(method.at_wrist, subsets)},
          {"compensated_at_targets", shareJson(method.at_targets, subsets)}};
}

}  // namespace

Json extendedModelJson(const extended_model::ExtendedModel& model, const std::vector<identification::Method>& methods) {
  Json effects = Json::array(), geometry = Json::array();
  for (const extended_model::AddedEffect& one : model.effects.added) effects.push_back(addedJson(one));
  for (const effects::Effect effect : model.effects.geometry) geometry.push_back(effectJson(effect));
  Json json{{"effects", effects}, {"nothing_added_for", geometry}, {"notes", words(model.effects.notes)}};
  if (model.effects.added.empty()) return json;
  const diagnosis::Gap& gap = model.effects.gap;
  const diagnosis::Shrink& shrink = model.effects.shrink;
  json["explained"] = number(model.effects.explained);
  json["shrink"] = {{"value", number(shrink.value)}, {"low", number(shrink.low)}, {"high", number(shrink.high)}};
  json["gap"] = {{"deflection_um", number(gap.deflection / io::kMicrometre)},
                 {"before_um", number(gap.before / io::kMicrometre)},
                 {"noise_um", number(gap.noise / io::kMicrometre)},
                 {"after_um", number(gap.after / io::kMicrometre)}};
  Json by_method = Json::object();
  for (const identification::Method which : methods) {
    by_method[namesOf(which).key] = {{"without", shownMethodJson(model.without.of(which))},
                                     {"with", shownMethodJson(model.with.of(which))}};
  }
  json["methods"] = by_method;
  return json;
}

namespace {

Json budgetJson(const std::vector<extended_model::BudgetLine>& budget,
                const identification::StiffnessEstimate& estimate) {
  Json rows = Json::array();
  for (const extended_model::BudgetLine& line : budget) {
    Json u = Json::array(), dof = Json::array();
    for (int j = 0; j < estimate.joints(); ++j) {
      const bool seen = estimate.identifiable[static_cast<std::size_t>(j)];
      const double slope = 1.0 / (estimate.compliance[j] * estimate.compliance[j]);
      const double sd = std::copysign(std::sqrt(std::abs(line.variance[j])), line.variance[j]);
      u.push_back(seen ? number(sd * slope) : Json(nullptr));
      dof.push_back(seen && line.dof[j] > 0.0 ? number(line.dof[j]) : Json(nullptr));
    }
    rows.push_back({{"source", budgetKey(line)}, {"in_model", line.in_model}, {"u_nm_per_rad", u}, {"dof", dof}});
    if (line.declared) rows.back()["declared"] = true;
  }
  return rows;
}

Json combinationsJson(const std::vector<extended_model::SeenCombination>& combinations) {
  Json rows = Json::array();
  for (const extended_model::SeenCombination& one : combinations) {
    rows.push_back({{"joint", one.joint + 1},
                    {"effect", std::string(effects::idOf(one.parameter.effect))},
                    {"parameter", one.parameter.name},
                    {"parameter_unit", one.parameter.unit},
                    {"ratio", number(one.ratio)},
                    {"value_rad_per_nm", number(one.value)},
                    {"sd_rad_per_nm", number(one.sd)},
                    {"message", combinationWords(one)}});
  }
  return rows;
}

}  // namespace

Json withSupport(Json json, const extended_model::ExtendedModel& model,
                 const std::vector<identification::Method>& methods) {
  if (!model.hidden) return json;
  const extended_model::HiddenEffects& hidden = *model.hidden;
  Json effects = Json::array();
  for (const extended_model::AddedEffect& one : model.effects.added)
    effects.push_back({{"effect", std::string(effects::idOf(one.effect))}, {"detail", one.detail}});
  json["model"] = {{"effects", effects},
                   {"lack_of_fit", number(hidden.lack_of_fit)},
                   {"left_over", number(hidden.left_over)},
                   {"unexplained_share", number(hidden.unexplained_share)},
                   {"unexplained", hidden.unexplained},
                   {"message", residualWords(model)}};
  Json apparent = Json::object();
  for (const identification::Method which : methods) {
    const char* key = namesOf(which).key;
    apparent[key] = shownMethodJson(model.without.of(which));
    if (!model.with.of(which).available) continue;
    const auto at = static_cast<std::size_t>(which);
    json["methods"][key]["budget"] = budgetJson(hidden.budget[at], model.with.of(which).estimate);
    json["methods"][key]["combinations"] = combinationsJson(hidden.combinations[at]);
  }
  json["apparent"] = apparent;
  return json;
}

Json withEffects(Json json, const extended_model::ExtendedModel& model,
                 const std::vector<identification::Method>& methods) {
  json["with"] = extendedModelJson(model, methods);
  return json;
}

}  // namespace stiffscope::reports
