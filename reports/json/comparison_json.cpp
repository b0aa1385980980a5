#include "core/comparison/compare.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"

#include "core/io/units.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

Json jointsJson(const comparison::StiffnessChange& change) {
  Json joints = Json::array();
  for (std::size_t j = 0; j < 6; ++j) {
    const comparison::JointChange& joint = change.joints[j];
    Json row{{"joint", j + 1}};
    if (joint.comparable) {
      row["before"] = number(joint.before);
      row["sd_before"] = number(joint.before_sd);
      row["after"] = number(joint.after);
      row["sd_after"] = number(joint.after_sd);
      row["unit"] = "Nm/rad";
      row["ratio"] = number(joint.ratio);
      row["sd_ratio"] = number(joint.ratio_sd);
      row["p_value"] = number(joint.p_value);
      row["correlation"] = number(joint.correlation);
      if (!joint.mark.empty()) row["mark"] = words(joint.mark);
    } else {
      for (const char* key : {"before", "after", "ratio", "p_value"}) row[key] = nullptr;
      row["reason"] = words(joint.reason);
    }
    joints.push_back(row);
  }
  return joints;
}

Json avoidedJson(const comparison::DeflectionAvoided& avoided, const char* place) {
  if (!avoided.available) return {{"at", place}, {"unavailable", words(avoided.reason)}};
  Json postures = Json::array();
  for (const comparison::PostureDeflection& one : avoided.postures) {
    postures.push_back({{"pose", one.pose},
                        {"before_um", one.before / io::kMicrometre},
                        {"after_um", one.after / io::kMicrometre},
                        {"share", number(one.share())}});
  }
  return {{"at", place},
          {"share", avoided.share},
          {"low", number(avoided.low)},
          {"high", number(avoided.high)},
          {"postures", postures}};
}

}  // namespace

Json comparisonJson(const campaign::Campaign& before, const campaign::Campaign& after,
                    const comparison::Comparison& comparison) {
  Json json{{"before", campaignJson(before)}, {"after", campaignJson(after)}};
  json["comparable"] = comparison.comparable;
  if (!comparison.comparable) json["reason"] = words(comparison.reason);
  const identification::Method best = comparison.best();
  const bool any = comparison.of(best).available;
  json["method"] = any ? Json(namesOf(best).key) : Json(nullptr);
  json["joints"] = any ? jointsJson(comparison.of(best)) : Json::array();
  Json methods;
  for (const identification::Method method : identification::kMethods) {
    const comparison::StiffnessChange& change = comparison.of(method);
    methods[namesOf(method).key] =
        change.available ? Json{{"joints", jointsJson(change)}} : Json{{"unavailable", words(change.reason)}};
  }
  json["methods"] = methods;
  const bool wrist = comparison.judgedAtWrist();
  json["avoided"] = avoidedJson(comparison.avoided(), wrist ? "P_wrist" : "reflectors");
  json["avoided_at_targets"] = avoidedJson(comparison.at_targets, "reflectors");
  Json unmatched = Json::array();
  for (const comparison::UnmatchedPosture& one : comparison.matched.unmatched) {
    unmatched.push_back({{"pose", one.pose}, {"reason", words(one.reason)}});
  }
  json["unmatched"] = unmatched;
  json["cautions"] = words(comparison.cautions);
  return json;
}

}  // namespace stiffscope::reports
