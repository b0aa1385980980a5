#include "core/io/units.h"
#include "core/planning/unloaded_plan.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

Json effectsJson(const std::vector<planning::EffectSight>& effects) {
  Json list = Json::array();
  for (const planning::EffectSight& one : effects) {
    list.push_back({{"effect", one.effect},
                    {"detail", one.detail},
                    {"detectable_mm", number(one.detectable / io::kMillimetre)},
                    {"inflation", number(one.inflation)}});
  }
  return list;
}

Json randomJson(const planning::RandomSight& random) {
  return {{"postures", random.postures},
          {"predicted_mm", number(random.predicted / io::kMillimetre)},
          {"predicted_geometry_mm", number(random.predicted_geometry / io::kMillimetre)},
          {"effects", effectsJson(random.effects)}};
}

}  // namespace

Json unloadedPlanJson(const campaign::Campaign& campaign, const planning::UnloadedPlan& plan) {
  Json json{{"campaign", campaignJson(campaign)},
            {"load", "none"},
            {"candidates", plan.candidates},
            {"drawn", plan.drawn},
            {"assumed", words(plan.arm.assumed)},
            {"predicted_mm", number(plan.sight.predicted / io::kMillimetre)},
            {"predicted_geometry_mm", number(plan.sight.predicted_geometry / io::kMillimetre)}};
  Json rows = Json::array();
  for (const planning::UnloadedPosture& posture : plan.postures) {
    rows.push_back({{"pose", posture.id},
                    {"q_deg", array(posture.q, 1.0 / io::kDegree)},
                    {"tracker_distance_m", posture.tracker_distance ? Json(*posture.tracker_distance) : Json(nullptr)},
                    {"predicted_mm", number(posture.predicted / io::kMillimetre)},
                    {"gain", number(posture.gain)}});
    addReading(campaign, posture.q, rows.back());
  }
  json["rows"] = rows;
  json["effects"] = effectsJson(plan.sight.effects);
  json["random"] = randomJson(plan.random_same);
  json["random_twice"] = randomJson(plan.random_double);
  return json;
}

}  // namespace stiffscope::reports
