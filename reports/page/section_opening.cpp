#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/page/names.h"
#include "reports/page/numbers.h"
#include "reports/one_machine.h"
#include "reports/page/report_id.h"
#include "reports/page/sections.h"
#include "reports/page/with_micro.h"
#include "reports/text/preparation_text.h"

namespace stiffscope::page {

namespace {

constexpr double kMmPerM = 1e3;

struct KeyNumber {
  std::string value, words;
};

/// Name, date, machine and tracker of a campaign in a line.
std::string campaignLine(const Campaign& campaign) {
  std::vector<std::string> parts;
  for (const std::string& text : {campaign.name, campaign.date, campaign.robot.name}) {
    if (!text.empty()) parts.push_back(asIs(text));
  }
  parts.push_back(encoderWords(campaign.double_encoder));
  parts.push_back(campaign.tracker ? asIs(campaign.tracker->model) : "tracker not declared");
  std::erase(parts, "");
  return fmt::format("{}", fmt::join(parts, " · "));
}

/// The campaign the first numbers are of: the one with active double encoders where there are several, as in
/// the paper.
const ReportCampaign& leading(const ReportContent& content) {
  const auto active = std::find_if(
      content.campaigns.begin(), content.campaigns.end(),
      [](const ReportCampaign& one) { return one.campaign.double_encoder == DoubleEncoder::active; });
  return active == content.campaigns.end() ? content.campaigns.front() : *active;
}

/// ", double encoders active", where that is declared.
std::string stateOf(const ReportCampaign& one) {
  const std::string words = encoderWords(one.campaign.double_encoder);
  return words.empty() ? words : ", " + words;
}

KeyNumber deflection(const ReportCampaign& one, const JudgedPoint& point) {
  const auto& displacement = displacementAt(one.identification, point.at_wrist);
  if (displacement.empty()) return {"–", "deflection: no posture could be used"};
  return {fmt::format("{}\u00a0mm", fixed(kMmPerM * mean(displacement), 2)),
          fmt::format("mean deflection at {} under {}\u00a0kN, {} postures{}", point.name,
                      fixed(1e-3 * meanForce(one.identification), 2), displacement.size(), stateOf(one))};
}

KeyNumber compensated(const ReportCampaign& one, const JudgedPoint& point) {
  const auto shown = shownMethod(one.identification);
  if (!shown) return {"–", "compensated: no method is available, see the stiffnesses"};
  const MethodResult& method = one.identification.of(*shown);
  if (const auto share = heldOut(method, point.at_wrist)) {
    return {percent(*share, 0),
            fmt::format("of it compensated by {} in postures held out", shortName(*shown))};
  }
  const auto& compensation = compensationAt(method, point.at_wrist);
  return {percent(compensation ? compensation->all_postures : std::nan(""), 0),
          fmt::format("of it compensated by {}, judged on the postures used", shortName(*shown))};
}

/// The joints that the verdict does not doubt.
KeyNumber trusted(const Identification& identification) {
  const auto shown = shownMethod(identification);
  if (!shown) return {"0 of 6", "joint stiffnesses: no method is available, see the stiffnesses"};
  const StiffnessEstimate& estimate = identification.of(*shown).estimate;
  int count = 0;
  std::vector<std::string> doubtful;
  for (int joint = 0; joint < 6; ++joint) {
    if (!estimate.identifiable[static_cast<std::size_t>(joint)]) continue;
    if (estimate.mark(joint).empty()) {
      ++count;
    } else {
      doubtful.push_back(jointName(joint));
    }
  }
  std::string words = fmt::format("joint stiffnesses found by {}", shortName(*shown));
  if (!doubtful.empty()) {
    words += fmt::format("; {} {} not to be trusted and not counted", fmt::join(doubtful, ", "),
                         doubtful.size() == 1 ? "is" : "are");
  }
  return {fmt::format("{} of 6", count), words};
}

KeyNumber third(const ReportContent& content, const ReportCampaign& one) {
  if (content.avoided && content.avoided->available) {
    return {percent(content.avoided->share, 0),
            fmt::format("of the deflection at {} with double encoders inactive is avoided by active ones",
                        pointOf(*content.avoided))};
  }
  return trusted(one.identification);
}

/// What a day of sweeps alone gives: axes and the lengths between them.
std::vector<KeyNumber> sweepNumbers(const Frames& frames) {
  const auto measured =
      std::count_if(frames.axes.begin(), frames.axes.end(), [](const auto& axis) { return axis.measured; });
  double rms = 0.0, off = 0.0;
  for (const MeasuredAxis& axis : frames.axes) rms = std::max(rms, axis.measured ? axis.fit.rms : 0.0);
  for (const LinkGeometry& link : frames.links) {
    if (link.distance_sd) off = std::max(off, std::abs(link.distance - link.nominal_distance));
  }
  return {{fmt::format("{} of 6", measured), "joint axes found from their sweeps"},
          {fmt::format("{}\u00a0mm", significant(kMmPerM * off, 2)),
           "largest difference of a distance between axes from the nominal one"},
          {fmt::format("{}\u00a0µm", significant(1e6 * rms, 2)),
           "rms by which readings leave their circles, of the worst axis"}};
}

std::vector<KeyNumber> keyNumbers(const ReportContent& content) {
  const ReportCampaign& one = leading(content);
  const JudgedPoint point = judgedPoint(one);
  const bool sweeps_alone =
      one.identification.cases.empty() && one.identification.frames.axes.front().measured;
  if (sweeps_alone) return sweepNumbers(one.identification.frames);
  return {deflection(one, point), compensated(one, point), third(content, one)};
}

/// The checks of the audit that found something, by name; the audit's own section explains them.
void addAuditCautions(const AuditReport& audit, std::vector<std::string>& items) {
  for (const AuditVerdict verdict : {AuditVerdict::fail, AuditVerdict::warn}) {
    std::vector<std::string> names;
    for (const AuditCheck& check : audit.checks) {
      if (check.verdict != verdict) continue;
      names.push_back(auditName(check.id));
      if (!check.where.empty() && check.id == "circle_arc") names.back() += " of " + check.where;
    }
    if (!names.empty()) {
      items.push_back(
          fmt::format("The audit of the readings {} on: {}.", auditWord(verdict), fmt::join(names, ", ")));
    }
  }
}

/// What a reader must know before believing the numbers of a campaign.
std::vector<std::string> cautionsOf(const ReportCampaign& one) {
  std::vector<std::string> items;
  if (one.audit != nullptr) addAuditCautions(*one.audit, items);
  if (one.preparation != nullptr &&
      (one.preparation->drift.taken_off || !one.preparation->rejected.empty())) {
    items.push_back(fmt::format("Readings: {}.", withMicro(preparationWords(*one.preparation))));
  }
  for (const std::string& caution : one.identification.cautions)
    items.push_back(capitalised(withMicro(caution)) + ".");
  return items;
}

void writeCautions(Html& html, const ReportContent& content) {
  const auto& campaigns = content.campaigns;
  std::vector<std::string> of_all;
  for (const std::string& doubt : doubtsOfTheMachine(campaigns)) of_all.push_back(asIs(doubt) + ".");
  const bool any = std::any_of(campaigns.begin(), campaigns.end(),
                               [](const ReportCampaign& one) { return !cautionsOf(one).empty(); });
  if (!any && of_all.empty()) return;
  html.paragraph("Before you believe these numbers:");
  html.list(of_all);
  const auto cautions = html.element("div", {{"class", campaigns.size() > 1 ? "several" : "cautions"}});
  for (const ReportCampaign& one : campaigns) {
    const auto column = html.element("div");
    if (campaigns.size() > 1) html.paragraph(asIs(one.campaign.name), "name");
    html.list(cautionsOf(one));
  }
}

}  // namespace

void writeOpening(Html& html, const ReportContent& content) {
  const auto header = html.element("header");
  html.leaf("h1", content.title);
  html.paragraph(fmt::format("Report {}", reportId(content)), "faint");
  for (const ReportCampaign& one : content.campaigns)
    html.leaf("p", campaignLine(one.campaign), {{"class", "faint"}});
  html.paragraph(content.verdict, "verdict");
  if (content.campaigns.empty()) return;
  {
    const auto list = html.element("ul", {{"class", "numbers"}});
    for (const KeyNumber& number : keyNumbers(content)) {
      const auto item = html.element("li");
      html.leaf("b", number.value);
      html.leaf("span", number.words);
    }
  }
  writeCautions(html, content);
}

void writeForEach(Html& html, const ReportContent& content, const char* id, const char* heading,
                  const std::function<void(const ReportCampaign&)>& write) {
  const auto section = html.element("section", {{"id", id}});
  html.leaf("h2", heading);
  writeEach(html, content, id, write);
}

void writeEach(Html& html, const ReportContent& content, const char* id,
               const std::function<void(const ReportCampaign&)>& write) {
  const bool several = content.campaigns.size() > 1;
  {
    const auto row = html.element("div", {{"class", several ? "several" : "one"}});
    for (std::size_t i = 0; i < content.campaigns.size(); ++i) {
      const auto column = html.element("div", {{"class", "each"}});
      if (several) {
        html.leaf("h3", asIs(content.campaigns[i].campaign.name));
        html.setTableSuffix(fmt::format("-{}", i + 1));
      }
      write(content.campaigns[i]);
      if (!several) writeFiguresOf(html, content, id);
    }
    html.setTableSuffix("");
  }
  if (several) writeFiguresOf(html, content, id);
}

}  // namespace stiffscope::page
