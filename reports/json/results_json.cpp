#include "reports/json/results_json.h"

#include "core/input/units.h"
#include "reports/json/frames_json.h"
#include "reports/json/identification_json.h"

namespace stiffscope {

namespace {

Json avoidedJson(const AvoidedShare& avoided) {
  Json postures = Json::array();
  for (const AvoidedPosture& posture : avoided.postures) {
    postures.push_back({{"pose", posture.pose},
                        {"inactive_mm", posture.inactive / kMillimetre},
                        {"active_mm", posture.active / kMillimetre}});
  }
  return {{"share", avoided.share}, {"at", avoided.at_wrist ? "P_wrist" : "reflectors"}, {"postures", postures}};
}

}  // namespace

Json resultsJson(const ReportContent& content) {
  Json versions = Json::object();
  for (const NamedText& version : content.versions) versions[version.name] = version.text;
  Json campaigns = Json::array();
  for (const ReportCampaign& one : content.campaigns) {
    campaigns.push_back({{"frames", framesJson(one.campaign, one.identification.frames)},
                         {"identify", identificationJson(one.campaign, one.identification,
                                                         {kMethods.begin(), kMethods.end()})}});
  }
  Json json{{"versions", versions}, {"campaigns", campaigns}};
  json["avoided"] = content.avoided ? avoidedJson(*content.avoided) : Json(nullptr);
  return json;
}

}  // namespace stiffscope
