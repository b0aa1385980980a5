#include "reports/json/results_json.h"

#include <utility>

#include "core/input/units.h"
#include "reports/json/audit_json.h"
#include "reports/json/diagnosis_json.h"
#include "reports/json/frames_json.h"
#include "reports/json/identification_json.h"
#include "reports/json/improved_json.h"
#include "reports/json/preparation_json.h"
#include "reports/one_machine.h"

namespace stiffscope {

namespace {

Json avoidedJson(const AvoidedByEncoders& avoided) {
  Json postures = Json::array();
  for (const PostureDeflection& posture : avoided.postures) {
    postures.push_back({{"pose", posture.pose},
                        {"inactive_mm", posture.before / kMillimetre},
                        {"active_mm", posture.after / kMillimetre}});
  }
  return {{"share", avoided.share}, {"low", number(avoided.low)}, {"high", number(avoided.high)}, {"at", avoided.at_wrist ? "P_wrist" : "reflectors"}, {"postures", postures}};
}

Json campaignResults(const ReportCampaign& one) {
  Json json = objectWithRoom(5);
  if (one.preparation != nullptr) json["preparation"] = preparationJson(*one.preparation);
  if (one.audit != nullptr) json["audit"] = auditJson(one.campaign, *one.audit);
  json["frames"] = framesJson(one.campaign, one.identification.frames);
  json["identify"] =
      identificationJson(one.campaign, one.identification, {kMethods.begin(), kMethods.end()});
  if (one.improved != nullptr) json["identify"]["with"] = improvedJson(*one.improved, {kMethods.begin(), kMethods.end()});
  if (one.diagnosis != nullptr) json["diagnose"] = diagnosisJson(one.campaign, *one.diagnosis);
  return json;
}

}  // namespace

Json resultsJson(const ReportContent& content) {
  Json versions = Json::object();
  for (const NamedText& version : content.versions) versions[version.name] = version.text;
  Json campaigns = Json::array();
  for (const ReportCampaign& one : content.campaigns) {
    campaigns.push_back(campaignResults(one));
  }
  Json json = objectWithRoom(5);
  json["versions"] = std::move(versions);
  json["campaigns"] = std::move(campaigns);
  json["cautions"] = doubtsOfTheMachine(content.campaigns);
  json["avoided"] = content.avoided && content.avoided->available ? avoidedJson(*content.avoided) : Json(nullptr);
  return json;
}

}  // namespace stiffscope
