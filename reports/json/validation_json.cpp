#include "core/validation/run_blind.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/words/remark_words.h"
#include "reports/words/validation_words.h"

namespace stiffscope::reports {

namespace {

Json rateJson(const numerics::Rate& rate) {
  return {{"hits", rate.hits},
          {"trials", rate.trials},
          {"value", rate.trials > 0 ? Json(rate.value()) : Json(nullptr)},
          {"low", rate.low},
          {"high", rate.high}};
}

Json verdictJson(const validation::Answer& answer) {
  Json list = Json::array();
  for (const validation::Answer::Entry& entry : answer.entries) {
    list.push_back(entry.effects.empty() ? Json{"unknown"} : Json(entry.effects));
  }
  if (list.empty()) list.push_back(Json{"none"});
  return list;
}

Json caseJson(const validation::ScoredCase& one) {
  Json truth = Json::array();
  for (const validation::LabelledEffect& effect : one.label.effects) {
    truth.push_back({{"effect", effect.id},
                     {"detail", effect.detail},
                     {"shows", effect.shows},
                     {"size", effect.size},
                     {"size_deflection", effect.deflection},
                     {"size_positions", effect.positions}});
  }
  Json json{{"case", one.label.name},
            {"kind", validation::nameOf(one.label.kind)},
            {"truth", truth},
            {"arm", one.label.arm},
            {"loading", one.label.loading},
            {"noise_factor", one.label.noise_factor},
            {"background", one.label.background},
            {"true_stiffness_nm_per_rad", one.label.stiffness},
            {"verdict", one.answer.failure.empty() ? verdictJson(one.answer) : Json(nullptr)}};
  if (!one.answer.failure.empty()) json["failure"] = one.answer.failure;
  if (one.distance) json["noises_from_any_effect"] = *one.distance;
  json["found"] = one.found;
  json["right"] = one.right;
  return json;
}

Json effectsJson(const std::vector<validation::EffectScore>& effects) {
  Json list = Json::array();
  for (const validation::EffectScore& one : effects) {
    list.push_back({{"effect", one.id},
                    {"all", rateJson(one.all)},
                    {"from_2", rateJson(one.from_2)},
                    {"from_5", rateJson(one.from_5)},
                    {"answered_none", one.answered_none},
                    {"mean_class_size", one.mean_class_size}});
  }
  return list;
}

Json shrinkJson(const std::vector<validation::ShrinkPair>& pairs) {
  Json list = Json::array();
  for (const validation::ShrinkPair& one : pairs) {
    list.push_back({{"case", one.name},
                    {"effect", one.effect},
                    {"promised", {{"value", one.promised}, {"low", one.low}, {"high", one.high}}},
                    {"truth_noise_free", one.truth},
                    {"truth_seen", one.truth_seen}});
  }
  return list;
}

}  // namespace

Json blindJson(const validation::BlindOptions& options, const validation::BlindResult& result) {
  const validation::Score& score = result.score;
  Json json{{"seal", result.seal},
            {"answers_sha256", result.answers_hash},
            {"seed", options.seed},
            {"as_is_share", options.as_is_share}};
  if (options.unloaded) json["unloaded"] = true;
  json["cases"] = Json::array();
  for (const validation::ScoredCase& one : score.cases) json["cases"].push_back(caseJson(one));
  json["confusion"] = {
      {"truths", score.confusion.truths}, {"answers", score.confusion.answers}, {"counts", score.confusion.counts}};
  json["rates"] = Json::object();
  for (const validation::NamedRate& one : score.rates) {
    json["rates"][one.id] = rateJson(one.rate);
    json["rates"][one.id]["meaning"] = words(one.meaning);
  }
  json["by_size"] = Json::array();
  for (const validation::SizeClass& one : score.by_size) {
    json["by_size"].push_back(rateJson(one.rate));
    json["by_size"].back()["size"] = sizeWords(one);
  }
  json["effects"] = effectsJson(score.effects);
  json["outside"] = effectsJson(score.outside);
  json["as_is"] = effectsJson(score.as_is);
  json["shrink"] = shrinkJson(score.shrinks);
  return json;
}

}  // namespace stiffscope::reports
