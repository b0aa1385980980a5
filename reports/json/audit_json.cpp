#include "reports/json/audit_json.h"

#include "reports/json/campaign_json.h"
#include "reports/json/preparation_json.h"

namespace stiffscope {

namespace {

Json figure(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

}  // namespace

const char* nameOf(AuditVerdict verdict) {
  switch (verdict) {
    case AuditVerdict::pass:
      return "pass";
    case AuditVerdict::warn:
      return "warn";
    case AuditVerdict::fail:
      return "fail";
    case AuditVerdict::not_testable:
      break;
  }
  return "not_testable";
}

Json auditJson(const Campaign& campaign, const AuditReport& report) {
  Json checks = Json::array();
  for (const AuditCheck& check : report.checks) {
    checks.push_back({{"id", check.id},
                      {"verdict", nameOf(check.verdict)},
                      {"value", figure(check.value)},
                      {"limit", figure(check.limit)},
                      {"unit", check.unit},
                      {"where", check.where},
                      {"message", check.message},
                      {"limit_source", check.limit_source}});
    if (!check.details.empty()) checks.back()["details"] = check.details;
  }
  return {{"campaign", campaignJson(campaign)},
          {"verdict", nameOf(report.verdict)},
          {"checks", checks},
          {"rejected", rejectedJson(report.rejected)}};
}

}  // namespace stiffscope
