#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/stated_results.h"
#include "reports/words/names.h"

namespace stiffscope::reports {

namespace {

Json statedJson(const StatedCampaign& one) {
  Json json{{"file", one.file},
            {"name", one.name},
            {"date", one.date},
            {"robot", one.robot},
            {"robot_serial", one.serial.empty() ? Json(nullptr) : Json(one.serial)},
            {"double_encoder", one.double_encoder},
            {"audit", nullptr},
            {"diagnosis", nullptr}};
  if (one.audit) json["audit"] = one.audit->verdict;
  if (one.diagnosis && one.diagnosis->usable) json["diagnosis"] = one.diagnosis->verdict;
  return json;
}

Json changeOf(const comparison::StatedChange& change) {
  return {{"difference", number(change.difference.value)},
          {"u_difference", number(change.difference.expanded())},
          {"p_value", number(change.p_value)},
          {"p_value_holm", number(change.p_holm)},
          {"significant", change.significant()}};
}

Json linksJson(const StatedComparison& comparison) {
  Json links = Json::array();
  for (std::size_t i = 0; i < comparison.lengths.size(); ++i) {
    const auto optional = [](const auto& change) { return change ? changeOf(*change) : Json(nullptr); };
    links.push_back({{"between_axes", {comparison.before.links[i].axis, comparison.before.links[i].axis + 1}},
                     {"length_mm", optional(comparison.lengths[i])},
                     {"angle_deg", optional(comparison.angles[i])}});
  }
  return links;
}

Json methodsJson(const StatedComparison& comparison) {
  Json methods = Json::object();
  for (const identification::Method method : identification::kMethods) {
    const std::size_t m = static_cast<std::size_t>(method);
    if (comparison.changes[m].empty()) continue;
    Json joints = Json::array();
    for (std::size_t j = 0; j < comparison.changes[m].size(); ++j) {
      const auto &before = comparison.before.compliances[m][j], &after = comparison.after.compliances[m][j];
      const auto interval = [](const auto& one) -> Json {
        if (!one) return nullptr;
        return {number(one->interval.low), number(one->interval.high)};
      };
      Json joint{{"joint", j + 1},
                 {"before_rad_per_nm", before ? number(before->value) : Json(nullptr)},
                 {"before_interval_rad_per_nm", interval(before)},
                 {"after_rad_per_nm", after ? number(after->value) : Json(nullptr)},
                 {"after_interval_rad_per_nm", interval(after)},
                 {"change_rad_per_nm", nullptr}};
      if (const auto& change = comparison.changes[m][j]) joint["change_rad_per_nm"] = changeOf(*change);
      joints.push_back(std::move(joint));
    }
    methods[namesOf(method).key] = std::move(joints);
  }
  return methods;
}

}  // namespace

Json statedComparisonJson(const StatedComparison& comparison) {
  Json postures = Json::array();
  for (const StatedComparison::Pair& pair : comparison.postures)
    postures.push_back(comparison.before.postures[pair.before].pose);
  return {{"before", statedJson(comparison.before)},
          {"after", statedJson(comparison.after)},
          {"refused", comparison.refused.empty() ? Json(nullptr) : Json(comparison.refused)},
          {"cautions", comparison.cautions},
          {"shown_first", comparison.shown_first ? Json(namesOf(*comparison.shown_first).key) : Json(nullptr)},
          {"methods", methodsJson(comparison)},
          {"links", linksJson(comparison)},
          {"postures", std::move(postures)},
          {"not_compared", comparison.unmatched}};
}

}  // namespace stiffscope::reports
