#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/spike_study.h"
#include "reports/json/campaign_json.h"
#include "reports/json/gap_json.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"

#include "core/io/units.h"
#include "reports/words/effect_words.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

Json idsOf(const std::vector<effects::Effect>& effects) {
  Json ids = Json::array();
  for (const effects::Effect effect : effects) ids.push_back(std::string(effects::idOf(effect)));
  return ids;
}

Json verdictJson(const diagnosis::Verdict& verdict) {
  Json entries = Json::array();
  if (verdict.entries.empty()) entries.push_back({"none"});
  for (const diagnosis::VerdictEntry& entry : verdict.entries) {
    entries.push_back(entry.effects.empty() ? Json::array({"unknown"}) : idsOf(entry.effects));
  }
  return entries;
}

Json classJson(const diagnosis::EffectClass& one, bool positions) {
  Json json{{"effects", idsOf(one.effects)},    {"detail", one.detail},
            {"score", number(one.score)},       {"in_verdict", one.in_verdict},
            {"shrink", shrinkJson(one.shrink)}, {"explained", number(one.explained)}};
  if (positions) json["shrink_of_positions"] = shrinkJson(one.shrink_of_positions);
  json["parameters"] = words(one.parameters);
  return json;
}

Json gapJson(const diagnosis::Gap& gap) {
  return {{"deflection_um", micrometres(gap.deflection)},
          {"before_um", micrometres(gap.before)},
          {"noise_um", micrometres(gap.noise)},
          {"after_um", micrometres(gap.after)}};
}

Json stiffnessJson(const diagnosis::Diagnosis& diagnosis, const JointVector& values) {
  Json list = Json::array();
  for (Eigen::Index j = 0; j < values.size(); ++j) {
    list.push_back(diagnosis.identifiable[static_cast<std::size_t>(j)] ? number(values[j]) : Json(nullptr));
  }
  return list;
}

}  // namespace

Json withNext(Json json, const std::vector<diagnosis::NextMeasurement>& measurements) {
  Json next = Json::array();
  for (const diagnosis::NextMeasurement& one : measurements)
    next.push_back(
        {{"separates", idsOf(one.separates)}, {"measure", words(one.what)}, {"gain_chi2", number(one.gain)}});
  json["next"] = next;
  return json;
}

Json diagnosisJson(const campaign::Campaign& campaign, const diagnosis::Diagnosis& diagnosis) {
  Json json{{"campaign", campaignJson(campaign)}, {"usable", diagnosis.usable}};
  if (!diagnosis.usable) {
    json["reason"] = words(diagnosis.unusable_reason);
    return json;
  }
  json["verdict"] = verdictJson(diagnosis.verdict);
  Json details = Json::array();
  for (const diagnosis::VerdictEntry& entry : diagnosis.verdict.entries) details.push_back(entry.detail);
  json["verdict_details"] = details;
  json["reason"] = reasonWords(diagnosis.verdict);
  Json classes = Json::array(), aliases = Json::array();
  for (const diagnosis::EffectClass& one : diagnosis.classes)
    classes.push_back(classJson(one, diagnosis.positions_tested));
  for (const auto& group : diagnosis.aliases) aliases.push_back(idsOf(group));
  json["classes"] = classes;
  json["shrink_together"] = shrinkJson(diagnosis.shrink_together);
  json["gap"] = gapJson(diagnosis.gap);
  if (diagnosis.positions_tested) json["gap_of_positions"] = gapJson(diagnosis.positions);
  json["aliases"] = aliases;
  Json detectable = Json::object(), not_testable = Json::object();
  for (const diagnosis::DetectableSize& one : diagnosis.detectable)
    detectable[std::string(effects::idOf(one.effect))] = one.size ? micrometres(*one.size) : Json(nullptr);
  for (const diagnosis::NotTestable& one : diagnosis.not_testable)
    not_testable[std::string(effects::idOf(one.effect))] = words(one.missing);
  json["detectable_um"] = detectable;
  json["not_testable"] = not_testable;
  if (diagnosis.geometry.tested) {
    const diagnosis::GeometryError& geometry = diagnosis.geometry;
    json["geometry"] = {{"rms_um", micrometres(geometry.rms)},
                        {"limit_um", micrometres(geometry.limit)},
                        {"largest_shift_um", micrometres(geometry.largest_shift)},
                        {"largest_tilt_urad", micrometres(geometry.largest_tilt)}};
  }
  json["limits"] = {{"significance_bic", number(diagnosis.significance_limit)},
                    {"size_um", micrometres(diagnosis.size_limit)}};
  json["noise"] = {{"state_um", micrometres(diagnosis.state_noise)},
                   {"source", words(diagnosis.noise_source)},
                   {"factor_along_beam", number(diagnosis.noise_factor_along)},
                   {"factor_across_beam", number(diagnosis.noise_factor_across)}};
  json["chi2_per_equation"] = {{"before", number(diagnosis.lack_of_fit)},
                               {"after", number(diagnosis.left_over)},
                               {"after_limit", number(diagnosis.left_over_limit)}};
  json["geometric_stiffness_share"] = number(diagnosis.geometric_stiffness_share);
  json["stiffness_before_nm_per_rad"] = stiffnessJson(diagnosis, diagnosis.stiffness_before);
  json["stiffness_after_nm_per_rad"] = stiffnessJson(diagnosis, diagnosis.stiffness_after);
  json["stiffness_after_sd_nm_per_rad"] = stiffnessJson(diagnosis, diagnosis.stiffness_after_sd);
  if (diagnosis.stated) {
    json["stiffness_by"] = namesOf(diagnosis.stated->method).key;
    json["stiffness_u_nm_per_rad"] = stiffnessJson(diagnosis, diagnosis.stated->expanded);
    Json intervals = Json::array();
    for (std::size_t j = 0; j < diagnosis.identifiable.size(); ++j) {
      const identification::CoverageInterval& one = diagnosis.stated->interval[j];
      intervals.push_back(diagnosis.identifiable[j] ? Json{number(one.low), number(one.high)} : Json(nullptr));
    }
    json["stiffness_interval_nm_per_rad"] = intervals;
  }
  json["where"] = tablesJson(diagnosis.where);
  json["where_after"] = tablesJson(diagnosis.where_after);
  if (Json overlaps = overlapsJson(diagnosis.where); !overlaps.is_null())
    json["where_overlapping"] = std::move(overlaps);
  if (diagnosis.positions_tested) json["where_positions"] = tablesJson(diagnosis.where_positions);
  return withNext(std::move(json), diagnosis.next);
}

namespace {

Json spikeCountsJson(const diagnosis::SpikeCounts& at) {
  Json others = Json::object();
  for (const auto& [effect, count] : at.others) others[std::string(effects::idOf(effect))] = count;
  return {{"times", at.times},
          {"size_um", micrometres(at.size)},
          {"draws", at.draws},
          {"named", at.named},
          {"part_named", at.part_named},
          {"class_size", at.named > 0 ? number(at.class_size) : Json(nullptr)},
          {"other_named", at.other_named},
          {"unknown", at.unknown},
          {"others", others}};
}

}  // namespace

Json withSpikes(Json diagnosis, const diagnosis::SpikeStudy& study) {
  Json effects = Json::array();
  for (const diagnosis::SpikedEffect& one : study.effects) {
    Json json{{"effect", std::string(effects::idOf(one.effect))},
              {"detectable_um", one.detectable ? micrometres(*one.detectable) : Json(nullptr)},
              {"in_baseline", one.in_baseline}};
    if (!one.detectable) json["reason"] = words(one.reason);
    json["sizes"] = Json::array();
    for (const diagnosis::SpikeCounts& at : one.sizes) json["sizes"].push_back(spikeCountsJson(at));
    effects.push_back(std::move(json));
  }
  diagnosis["spike"] = {{"seed", study.seed},
                        {"draws", study.draws},
                        {"baseline", diagnosis.contains("verdict") ? diagnosis["verdict"] : Json(nullptr)},
                        {"effects", effects}};
  return diagnosis;
}

}  // namespace stiffscope::reports
