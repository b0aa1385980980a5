#include "core/audit/audit.h"
#include "core/mistakes/find_mistakes.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"

#include "reports/json/campaign_json.h"
#include "reports/words/audit_figures.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

Json figure(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

void addSuspected(const std::vector<mistakes::Suspected>& some, Json& all) {
  for (const mistakes::Suspected& one : some) {
    all.push_back({{"mistake", one.mistake.name()},
                   {"where", words(one.where)},
                   {"remedy", words(one.remedy)},
                   {"before", number(one.before)},
                   {"after", number(one.after)}});
  }
}

Json suspectedJson(const std::vector<mistakes::Suspected>& some) {
  Json all = Json::array();
  addSuspected(some, all);
  return all;
}

}  // namespace

Json withAgreement(Json result, const mistakes::ModelAgreement& agreement) {
  if (!agreement.contradicted()) return result;
  Json all = Json::array();
  addSuspected(agreement.arm, all);
  addSuspected(agreement.loads, all);
  result["contradicts_model"] = {
      {"arm", agreement.arm_contradicted}, {"loads", agreement.loads_contradicted}, {"suspected", all}};
  return result;
}

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
  return {{"campaign", campaignJson(campaign)},
          {"purpose", report.purpose == audit::Purpose::calibrate ? "calibrate" : "identify"},
          {"verdict", nameOf(report.verdict)},
          {"made", report.made},
          {"of", report.of},
          {"unanswered", words(report.unanswered)},
          {"checks", checks},
          {"suspected", suspectedJson(report.suspected)},
          {"rejected", rejectedJson(report.rejected)}};
}

}  // namespace stiffscope::reports
