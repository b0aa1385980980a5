#include "core/comparison/geometry_change.h"
#include "core/io/units.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/words/geometry_change_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

constexpr double kMilliradian = 1e-3;

Json numberJson(const comparison::NumberChange& one) {
  const bool length = one.number.isLength();
  const double unit = length ? io::kMillimetre : kMilliradian;
  Json json{{"number", nameOf(one.number.kind)}, {"name", numberName(one.number)}};
  if (one.number.kind == comparison::NumberKind::joint_zero && one.number.joint > 0) json["joint"] = one.number.joint;
  json["axes"] = {one.number.axis, one.number.axis + 1};
  json["unit"] = length ? "mm" : "mrad";
  if (!one.identified) {
    for (const char* key : {"difference", "sd_difference", "u_difference", "p_value", "p_value_holm"})
      json[key] = nullptr;
    json["reason"] = "not seen by both days";
    return json;
  }
  json["difference"] = number(one.difference.value / unit);
  json["sd_difference"] = number(one.difference.sd / unit);
  json["u_difference"] = number(one.difference.expanded() / unit);
  if (one.number.kind == comparison::NumberKind::joint_zero)
    json["difference_deg"] = number(one.difference.value / io::kDegree);
  json["degrees_of_freedom"] = number(one.difference.dof);
  json["p_value"] = number(one.p_value);
  json["p_value_holm"] = number(one.p_holm);
  json["at_targets_mm"] = number(one.at_targets / io::kMillimetre);
  return json;
}

Json causeJson(const comparison::CauseEvidence& one) {
  using comparison::ChangeCause;
  Json json{{"cause", nameOf(one)}};
  if (one.cause == ChangeCause::joint_zero) json["joint"] = one.joint;
  if (one.cause == ChangeCause::link) json["link"] = one.axis;
  if (one.cause == ChangeCause::axis) json["axis"] = one.axis;
  json["unknowns"] = one.unknowns;
  json["chi2"] = number(one.chi2);
  json["left_p_value"] = number(one.left_p);
  json["bic"] = number(one.bic);
  if (one.size) {
    const bool growth = one.cause == ChangeCause::growth;
    const double unit = growth ? 1.0 : kMilliradian;
    json["size"] = number(one.size->value / unit);
    json["sd_size"] = number(one.size->sd / unit);
    json["u_size"] = number(one.size->expanded() / unit);
    json["unit"] = growth ? "m/m" : "mrad";
  }
  json["at_targets_mm"] = number(one.at_targets / io::kMillimetre);
  json["words"] = causeWords(one);
  return json;
}

}  // namespace

Json geometryChangeJson(const campaign::Campaign& before, const campaign::Campaign& after,
                        const comparison::GeometryChange& change) {
  Json json{{"before", campaignJson(before)}, {"after", campaignJson(after)}};
  json["comparable"] = change.reason.empty();
  if (!change.reason.empty()) {
    json["reason"] = words(change.reason);
    return json;
  }
  json["postures"] = {
      {"before", change.postures_before}, {"after", change.postures_after}, {"common", change.postures_common}};
  json["same_postures"] = change.same_postures;
  json["effects"] = change.effects;
  json["effects_p_value"] = change.effects.empty() ? Json(nullptr) : number(change.effects_p);
  json["left_mm"] = {{"before", change.left_before / io::kMillimetre}, {"after", change.left_after / io::kMillimetre}};
  json["machine"] = {{"changed", change.machine_changed},
                     {"chi2", number(change.chi2)},
                     {"numbers", change.unknowns},
                     {"p_value", number(change.machine_p)},
                     {"at_targets_mm", number(change.at_targets / io::kMillimetre)},
                     {"sd_at_targets_mm", number(change.at_targets_sd / io::kMillimetre)}};
  Json numbers = Json::array(), targets = Json::array(), causes = Json::array();
  for (const comparison::NumberChange& one : change.numbers) numbers.push_back(numberJson(one));
  json["numbers"] = numbers;
  for (const comparison::ReflectorChange& one : change.reflectors) {
    targets.push_back({{"target", one.target},
                       {"shift_in_flange_mm", array(one.shift, 1.0 / io::kMillimetre)},
                       {"sd_mm", array(one.sd, 1.0 / io::kMillimetre)},
                       {"p_value", number(one.p_value)},
                       {"p_value_holm", number(one.p_holm)}});
  }
  json["reflectors"] = {
      {"moved", change.reflectors_moved}, {"p_value", number(change.reflectors_p)}, {"targets", targets}};
  json["base"] = {{"machine_change", false},
                  {"shift_mm", array(change.base.shift, 1.0 / io::kMillimetre)},
                  {"turn_deg", array(change.base.turn, 1.0 / io::kDegree)}};
  for (const comparison::CauseEvidence& one : change.causes) causes.push_back(causeJson(one));
  json["cause"] = change.explained() ? causes.front() : Json(nullptr);
  json["causes"] = causes;
  json["summary"] = changeWords(change);
  json["cautions"] = words(change.cautions);
  return json;
}

}  // namespace stiffscope::reports
