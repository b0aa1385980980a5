#include "core/audit/audit.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"

#include "reports/json/campaign_json.h"
#include "reports/words/audit_figures.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

Json figure(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

}  // namespace

const char* nameOf(preparation::AuditVerdict verdict) {
  switch (verdict) {
    case preparation::AuditVerdict::pass:
      return "pass";
    case preparation::AuditVerdict::warn:
      return "warn";
    case preparation::AuditVerdict::fail:
      return "fail";
    case preparation::AuditVerdict::not_testable:
      break;
  }
  return "not_testable";
}

Json auditJson(const campaign::Campaign& campaign, const audit::AuditReport& report) {
  Json checks = Json::array();
  for (const preparation::AuditCheck& check : report.checks) {
    const AuditFigures figures = figuresOf(check);
    checks.push_back({{"id", check.id},
                      {"verdict", nameOf(check.verdict)},
                      {"value", figure(figures.value)},
                      {"limit", figure(figures.limit)},
                      {"unit", figures.unit},
                      {"where", words(check.where)},
                      {"message", words(check.message)},
                      {"limit_source", words(check.limit_source)}});
    if (!check.details.empty()) checks.back()["details"] = words(check.details);
  }
  Json suspected = Json::array();
  for (const audit::Suspected& one : report.suspected) {
    suspected.push_back({{"mistake", one.mistake},
                         {"where", words(one.where)},
                         {"remedy", words(one.remedy)},
                         {"before", number(one.before)},
                         {"after", number(one.after)}});
  }
  return {{"campaign", campaignJson(campaign)},
          {"verdict", nameOf(report.verdict)},
          {"made", report.made},
          {"of", report.of},
          {"unanswered", words(report.unanswered)},
          {"checks", checks},
          {"suspected", suspected},
          {"rejected", rejectedJson(report.rejected)}};
}

}  // namespace stiffscope::reports
