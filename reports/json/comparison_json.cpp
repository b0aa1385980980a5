#include "core/comparison/compare.h"
#include "reports/json/campaign_json.h"
#include "reports/json/identification_json.h"
#include "reports/json/json.h"

#include "core/io/units.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

/// The change of the compliance and what follows of it: U is the expanded uncertainty, 95 %.
void addDifference(const comparison::JointChange& joint, Json& row) {
  row["compliance_difference_rad_per_nm"] = number(joint.difference.value);
  row["u_compliance_difference_rad_per_nm"] = number(joint.difference.expanded());
  row["sd_compliance_difference_rad_per_nm"] = number(joint.difference.sd);
  row["degrees_of_freedom"] = number(joint.difference.dof);
  row["p_value"] = number(joint.p_value);
  row["p_value_holm"] = number(joint.p_holm);
  row["taken_away"] = number(joint.taken.value);
  row["u_taken_away"] = number(joint.taken.expanded());
  row["avoided_at_targets"] = number(joint.avoided.value);
  row["u_avoided_at_targets"] = number(joint.avoided.expanded());
}

Json jointsJson(const comparison::StiffnessChange& change, bool ratios_hold) {
  Json joints = Json::array();
  for (std::size_t j = 0; j < change.joints.size(); ++j) {
    const comparison::JointChange& joint = change.joints[j];
    Json row{{"joint", j + 1}};
    if (joint.comparable) {
      addDifference(joint, row);
      row["before"] = number(joint.before.value);
      row["sd_before"] = number(joint.before.sd);
      row["u_before"] = number(joint.before.expanded());
      row["after"] = number(joint.after.value);
      row["sd_after"] = number(joint.after.sd);
      row["u_after"] = number(joint.after.expanded());
      row["unit"] = "Nm/rad";
      row["ratio"] = number(joint.ratio.value);
      row["sd_ratio"] = number(joint.ratio.sd);
      row["u_ratio"] = number(joint.ratio.expanded());
      row["ratio_keeps_bias"] = !ratios_hold;
      row["correlation"] = number(joint.correlation);
      if (joint.gear) {
        row["gear"] = {{"compliance_rad_per_nm", number(joint.gear->compliance.value)},
                       {"u_compliance_rad_per_nm", number(joint.gear->compliance.expanded())},
                       {"p_value_of_agreement", number(joint.gear->p_value)}};
      }
      if (!joint.mark.empty()) row["mark"] = words(joint.mark);
    } else {
      for (const char* key : {"compliance_difference_rad_per_nm", "before", "after", "ratio", "p_value"}) {
        row[key] = nullptr;
      }
      row["reason"] = words(joint.reason);
    }
    joints.push_back(row);
  }
  return joints;
}

Json residualJson(const comparison::CommonResidual& residual) {
  if (!residual.available) return nullptr;
  const auto micrometres = [](const std::optional<double>& value) {
    return value ? number(*value / io::kMicrometre) : Json(nullptr);
  };
  return {{"before_um", micrometres(residual.before)},
          {"after_um", micrometres(residual.after)},
          {"noise_before_um", micrometres(residual.noise_before)},
          {"noise_after_um", micrometres(residual.noise_after)},
          {"difference_um", micrometres(residual.of_difference)},
          {"correlation", number(residual.correlation)},
          {"recurs_p_value", number(residual.recurs_p)},
          {"is_noise", residual.isNoise()}};
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

Json changeJson(const comparison::StiffnessChange& change, bool ratios_hold) {
  if (!change.available) return {{"unavailable", words(change.reason)}};
  return {{"same_postures", change.same_postures},
          {"by_models", change.by_models},
          {"postures", change.postures},
          {"joints", jointsJson(change, ratios_hold)},
          {"avoided_rest_at_targets", number(change.avoided_rest)}};
}

Json comparisonJson(const campaign::Campaign& before, const campaign::Campaign& after,
                    const comparison::Comparison& comparison) {
  Json json{{"before", campaignJson(before)}, {"after", campaignJson(after)}};
  json["comparable"] = comparison.comparable;
  if (!comparison.comparable) json["reason"] = words(comparison.reason);
  const identification::Method best = comparison.best();
  const bool any = comparison.of(best).available;
  json["method"] = any ? Json(namesOf(best).key) : Json(nullptr);
  json["shown_first"] = shownFirstJson(comparison.shown_first);
  const bool ratios_hold = comparison.ratiosHold();
  json["joints"] = any ? jointsJson(comparison.of(best), ratios_hold) : Json::array();
  Json methods;
  for (const identification::Method method : identification::kMethods) {
    methods[namesOf(method).key] = changeJson(comparison.of(method), ratios_hold);
  }
  json["methods"] = methods;
  json["residual"] = residualJson(comparison.residual);
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
