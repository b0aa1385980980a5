#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/report_content.h"

#include <utility>
#include <vector>

#include "core/audit/audit.h"
#include "core/campaign/campaign.h"
#include "core/diagnosis/diagnosis.h"
#include "core/extended_model/extended_model.h"
#include "core/frames/frames.h"
#include "core/io/units.h"
#include "reports/json/campaign_json.h"
#include "reports/json/identification_json.h"
#include "reports/words/conformity_words.h"
#include "reports/words/names.h"
#include "reports/words/verdict.h"

namespace stiffscope::reports {

namespace {

Json avoidedJson(const AvoidedByEncoders& avoided) {
  Json postures = Json::array();
  for (const comparison::PostureDeflection& posture : avoided.postures) {
    postures.push_back({{"pose", posture.pose},
                        {"inactive_mm", posture.before / io::kMillimetre},
                        {"active_mm", posture.after / io::kMillimetre}});
  }
  return {{"share", avoided.share},
          {"low", number(avoided.low)},
          {"high", number(avoided.high)},
          {"at", avoided.at_wrist ? "P_wrist" : "reflectors"},
          {"postures", postures},
          {"method", namesOf(avoided.method).key},
          {"joints", avoided.by_joint.available ? changeJson(avoided.by_joint, avoided.residual_is_noise)["joints"]
                                                : Json::array()}};
}

/// Values in the unit that the name ends in.
Json limitsJson(const std::vector<conformity::Decision>& decisions) {
  Json limits = Json::array();
  for (const conformity::Decision& one : decisions) {
    const conformity::QuantityName& name = conformity::nameOf(one.limit.quantity);
    const auto optional = [&name](const std::optional<double>& value) {
      return value ? number(*value / name.unit) : Json(nullptr);
    };
    Json json{{"name", name.name},
              {"least", optional(one.limit.least)},
              {"most", optional(one.limit.most)},
              {"reason", one.limit.reason},
              {"verdict", nameOf(one.verdict)},
              {"in_guard_band", one.in_guard_band},
              {"value", nullptr},
              {"low", nullptr},
              {"high", nullptr},
              {"missing", nullptr}};
    if (one.measured) {
      json["value"] = number(one.measured->value / name.unit);
      json["low"] = number(one.measured->interval.low / name.unit);
      json["high"] = number(one.measured->interval.high / name.unit);
    } else {
      json["missing"] = nameOf(one.missing);
    }
    limits.push_back(std::move(json));
  }
  return limits;
}

JsonDocument campaignResults(const ReportCampaign& one) {
  JsonDocument document(Json::object());
  Json& json = document.json;
  if (one.preparation != nullptr) json["preparation"] = preparationJson(*one.preparation);
  if (one.audit != nullptr) json["audit"] = auditJson(one.campaign, *one.audit);
  json["frames"] = framesJson(one.campaign, one.identification.frames);
  document.set("/identify"_json_pointer,
               identificationJson(one.campaign, one.identification,
                                  {identification::kMethods.begin(), identification::kMethods.end()}));
  if (one.improved != nullptr) {
    const std::vector<identification::Method> methods{identification::kMethods.begin(), identification::kMethods.end()};
    json["identify"]["with"] = extendedModelJson(*one.improved, methods);
    json["identify"] = withSupport(std::move(json["identify"]), *one.improved, methods);
  }
  if (one.decisions != nullptr) json["limits"] = limitsJson(*one.decisions);
  if (one.workspace != nullptr) json["stiffness"] = workspaceJson(*one.workspace, SlicePlaces::left_out);
  if (one.diagnosis != nullptr) json["diagnose"] = diagnosisJson(one.campaign, *one.diagnosis);
  if (one.accuracy != nullptr) {
    json["calibration"] = calibrationJson(one.campaign, one.accuracy->calibration, one.calibrated_by);
    json["diagnosis"] = accuracyJson(one.campaign, *one.accuracy);
  }
  return document;
}

}  // namespace

JsonDocument resultsJson(const ReportContent& content) {
  Json versions = Json::object();
  for (const NamedText& version : content.versions) versions[version.name] = version.text;
  JsonDocument document(Json::object());
  Json& json = document.json;
  json["versions"] = std::move(versions);
  json["campaigns"] = Json::array();
  const Json::json_pointer campaigns("/campaigns");
  for (std::size_t i = 0; i < content.campaigns.size(); ++i)
    document.set(campaigns / i, campaignResults(content.campaigns[i]));
  json["cautions"] = doubtsOfTheMachine(content.campaigns);
  json["avoided"] = content.avoided && content.avoided->available ? avoidedJson(*content.avoided) : Json(nullptr);
  return document;
}

}  // namespace stiffscope::reports
