#include "reports/page/sections.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "reports/page/html.h"
#include "reports/report_content.h"
#include "reports/words/accuracy_words.h"
#include "reports/words/day_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"
#include "reports/words/verdict.h"

namespace stiffscope::page {

namespace {

void writeFigure(Html& html, const reports::Figure& figure, int number) {
  const auto element = html.element("figure", {{"id", figure.id}});
  html.voidElement("img", {{"src", "data:image/png;base64," + base64(figure.png)},
                           {"alt", figure.alt},
                           {"width", std::to_string(figure.width)},
                           {"height", std::to_string(figure.height)}});
  const auto caption = html.element("figcaption");
  html.leaf("b", fmt::format("Figure {}. {}.", number, figure.title));
  html.text(" ");
  html.rich(figure.caption);
}

}  // namespace

bool hasFigures(const reports::ReportContent& content, const std::string& section) {
  return std::any_of(content.figures.begin(), content.figures.end(),
                     [&](const reports::Figure& figure) { return figure.section == section; });
}

void writeFiguresOf(Html& html, const reports::ReportContent& content, const std::string& section) {
  if (!hasFigures(content, section)) return;
  int number = 0;
  for (const char* earlier : reports::kFigureSections) {
    if (section == earlier) break;
    number += static_cast<int>(std::count_if(content.figures.begin(), content.figures.end(),
                                             [&](const reports::Figure& figure) { return figure.section == earlier; }));
  }
  const auto grid = html.element("div", {{"class", "figures"}});
  for (const reports::Figure& figure : content.figures) {
    if (figure.section == section) writeFigure(html, figure, ++number);
  }
}

void writeFigures(Html& html, const reports::ReportContent& content) {
  if (!hasFigures(content, "figures")) return;
  const auto section = html.element("section", {{"id", "figures"}});
  html.leaf("h2", "Figures");
  writeFiguresOf(html, content, "figures");
}

namespace {

struct KeyNumber {
  std::string value, words;
};

/// Name, date, machine and tracker of a campaign in a line.
std::string campaignLine(const campaign::Campaign& campaign) {
  std::vector<std::string> parts;
  for (const std::string& text : {campaign.name, campaign.date, campaign.robot.name}) {
    if (!text.empty()) parts.push_back(reports::asIs(text));
  }
  parts.push_back(reports::encoderWords(campaign.double_encoder));
  parts.push_back(campaign.tracker ? reports::asIs(campaign.tracker->model) : "tracker not declared");
  std::erase(parts, "");
  return fmt::format("{}", fmt::join(parts, " · "));
}

/// The campaign the first numbers are of: a loaded one before others, and of these the one with active double encoders
/// where there are several, as in the paper.
const reports::ReportCampaign& leading(const reports::ReportContent& content) {
  const auto& campaigns = content.campaigns;
  const bool loaded = reports::anyOfKind(campaigns, reports::DayKind::loaded);
  const auto first = std::find_if(campaigns.begin(), campaigns.end(),
                                  [loaded](const reports::ReportCampaign& one) { return !loaded || isLoaded(one); });
  const auto active = std::find_if(first, campaigns.end(), [loaded](const reports::ReportCampaign& one) {
    return (!loaded || isLoaded(one)) && one.campaign.double_encoder == campaign::DoubleEncoder::active;
  });
  return active == campaigns.end() ? *first : *active;
}

/// ", double encoders active", where that is declared.
std::string stateOf(const reports::ReportCampaign& one) {
  const std::string words = reports::encoderWords(one.campaign.double_encoder);
  return words.empty() ? words : ", " + words;
}

KeyNumber deflection(const reports::ReportCampaign& one, const reports::JudgedPoint& point) {
  const auto& displacement = reports::displacementAt(one.identification, point.at_wrist);
  if (displacement.empty()) return {"–", "deflection: no posture could be used"};
  return {
      fmt::format("{}\u00a0mm", reports::fixed(reports::kMmPerM * reports::mean(displacement), 2)),
      fmt::format("mean deflection at {} under {}\u00a0kN, {} postures{}", point.name,
                  reports::fixed(1e-3 * reports::meanForce(one.identification), 2), displacement.size(), stateOf(one))};
}

/// At the reflectors, by which the method was chosen, and at P_wrist; beside the paper in the paper's order.
KeyNumber compensated(const reports::ReportCampaign& one, bool paper) {
  const auto shown = reports::shownMethod(one.identification);
  if (!shown) return {"–", "compensated: no method is available, see the stiffnesses"};
  const identification::MethodResult& method = one.identification.of(*shown);
  const bool wrist = reports::compensationAt(method, true).has_value(), first_at_wrist = wrist && paper;
  const auto share = [&](bool at_wrist) {
    const auto held_out = reports::heldOut(method, at_wrist);
    const auto& all = reports::compensationAt(method, at_wrist);
    return reports::percent(held_out ? *held_out : all ? all->all_postures : std::nan(""), 0);
  };
  const auto point = [](bool at_wrist) { return at_wrist ? "P_{wrist}" : "the reflectors"; };
  std::string words =
      fmt::format("of the deflection at {} compensated by {} in postures {}", point(first_at_wrist),
                  reports::shortName(*shown), reports::heldOut(method, first_at_wrist) ? "held out" : "used");
  if (wrist) words += fmt::format("; {} at {}", share(!first_at_wrist), point(!first_at_wrist));
  return {share(first_at_wrist), words};
}

/// The joints that the verdict does not doubt.
KeyNumber trusted(const identification::Identification& identification) {
  const auto shown = reports::shownMethod(identification);
  if (!shown) return {"0 of 6", "joint stiffnesses: no method is available, see the stiffnesses"};
  const identification::StiffnessEstimate& estimate = identification.of(*shown).estimate;
  int count = 0;
  std::vector<std::string> doubtful;
  for (int joint = 0; joint < 6; ++joint) {
    if (!estimate.identifiable[static_cast<std::size_t>(joint)]) continue;
    if (estimate.mark(joint).empty()) {
      ++count;
    } else {
      doubtful.push_back(reports::jointName(joint));
    }
  }
  std::string words = fmt::format("joint stiffnesses found by {}", reports::shortName(*shown));
  if (!doubtful.empty()) {
    words += fmt::format("; {} {} not to be trusted and not counted", fmt::join(doubtful, ", "),
                         doubtful.size() == 1 ? "is" : "are");
  }
  return {fmt::format("{} of 6", count), words};
}

KeyNumber third(const reports::ReportContent& content, const reports::ReportCampaign& one) {
  if (content.avoided && content.avoided->available) {
    return {reports::percent(content.avoided->share, 0),
            fmt::format("of the deflection at {} with double encoders inactive is avoided by active ones",
                        reports::pointOf(*content.avoided))};
  }
  return trusted(one.identification);
}

/// What a day of sweeps alone gives: axes and the lengths between them.
std::vector<KeyNumber> sweepNumbers(const frames::Frames& frames) {
  const auto measured =
      std::count_if(frames.axes.begin(), frames.axes.end(), [](const auto& axis) { return axis.measured; });
  double rms = 0.0;
  for (const frames::MeasuredAxis& axis : frames.axes) rms = std::max(rms, axis.measured ? axis.fit.rms : 0.0);
  const double off = reports::largestLinkDifference(frames);
  return {{fmt::format("{} of 6", measured), "joint axes found from their sweeps"},
          {fmt::format("{}\u00a0mm", reports::significant(reports::kMmPerM * off, 2)),
           "largest difference of a distance between axes from the nominal one"},
          {fmt::format("{}\u00a0µm", reports::significant(1e6 * rms, 2)),
           "rms by which readings leave their circles, of the worst axis"}};
}

/// What a day without a load gives: position errors by model.
std::vector<KeyNumber> accuracyNumbers(const reports::ReportCampaign& one) {
  using calibration::CalibratedModel;
  std::vector<KeyNumber> numbers;
  for (const calibration::ModelResult& model : one.accuracy->calibration.models) {
    if (model.model == CalibratedModel::gravity) continue;
    if (model.model == CalibratedModel::effects && model.fit.parts.empty()) continue;
    const bool held_out = model.held_out.readings > 0;
    const calibration::PositionErrors& errors = held_out ? model.held_out : model.fitted;
    numbers.push_back({reports::millimetres(errors.rms),
                       fmt::format("rms position error, {}, {}; largest {}", reports::modelWords(model.model),
                                   held_out ? "held out" : "fitted", reports::millimetres(errors.largest))});
  }
  return numbers;
}

std::vector<KeyNumber> keyNumbers(const reports::ReportContent& content) {
  const reports::ReportCampaign& one = leading(content);
  if (one.accuracy != nullptr) return accuracyNumbers(one);
  const reports::JudgedPoint point = reports::judgedPoint(one);
  const bool sweeps_alone = one.identification.cases.empty() && one.identification.frames.axes.front().measured;
  if (sweeps_alone) return sweepNumbers(one.identification.frames);
  return {deflection(one, point), compensated(one, content.compare_with_paper), third(content, one)};
}

/// The checks of the audit that found something, by name; the audit's own section explains them.
void addAuditWarnings(const audit::AuditReport& audit, std::vector<std::string>& items) {
  for (const preparation::AuditVerdict verdict : {preparation::AuditVerdict::fail, preparation::AuditVerdict::warn}) {
    std::vector<std::string> names;
    for (const preparation::AuditCheck& check : audit.checks) {
      if (check.verdict != verdict) continue;
      names.push_back(reports::auditName(check.id));
      if (!check.where.empty() && check.id == "circle_arc") names.back() += " of " + reports::words(check.where);
    }
    if (!names.empty()) {
      items.push_back(
          fmt::format("The audit of the readings {} on: {}.", reports::auditWord(verdict), fmt::join(names, ", ")));
    }
  }
}

/// What a reader must know before believing the numbers of a campaign.
std::vector<std::string> warningsOf(const reports::ReportCampaign& one) {
  std::vector<std::string> items;
  if (one.audit != nullptr) {
    const std::string untested = reports::untestedWords(*one.audit, kindOf(one));
    if (!untested.empty()) items.push_back(untested);
    addAuditWarnings(*one.audit, items);
  }
  if (one.preparation != nullptr && (one.preparation->drift.taken_off || !one.preparation->rejected.empty())) {
    items.push_back(fmt::format("Readings: {}.", reports::withMicro(reports::preparationWords(*one.preparation))));
  }
  for (const Remark& caution : one.identification.cautions)
    items.push_back(reports::capitalised(reports::withMicro(reports::words(caution))) + ".");
  return items;
}

void writeWarnings(Html& html, const reports::ReportContent& content) {
  const auto& campaigns = content.campaigns;
  std::vector<std::string> of_all;
  for (const std::string& doubt : reports::doubtsOfTheMachine(campaigns)) of_all.push_back(reports::asIs(doubt) + ".");
  const bool any = std::any_of(campaigns.begin(), campaigns.end(),
                               [](const reports::ReportCampaign& one) { return !warningsOf(one).empty(); });
  if (!any && of_all.empty()) return;
  html.paragraph("Before you believe these numbers:");
  html.list(of_all);
  const auto cautions = html.element("div", {{"class", campaigns.size() > 1 ? "several" : "cautions"}});
  for (const reports::ReportCampaign& one : campaigns) {
    const auto column = html.element("div");
    if (campaigns.size() > 1) html.paragraph(reports::asIs(one.campaign.name), "name");
    html.list(warningsOf(one));
  }
}

}  // namespace

void writeOpening(Html& html, const reports::ReportContent& content) {
  const auto header = html.element("header");
  html.leaf("h1", content.title);
  html.paragraph(fmt::format("Report {}", reports::reportId(content)), "faint");
  for (const reports::ReportCampaign& one : content.campaigns)
    html.leaf("p", campaignLine(one.campaign), {{"class", "faint"}});
  html.paragraph(content.verdict, "verdict");
  if (content.campaigns.empty()) return;
  if (const std::vector<KeyNumber> numbers = keyNumbers(content); !numbers.empty()) {
    const auto list = html.element("ul", {{"class", "numbers"}});
    for (const KeyNumber& number : numbers) {
      const auto item = html.element("li");
      html.leaf("b", number.value);
      html.leaf("span", number.words);
    }
  }
  writeWarnings(html, content);
}

bool isAny(const reports::ReportCampaign&) { return true; }

bool isLoaded(const reports::ReportCampaign& one) { return kindOf(one) == reports::DayKind::loaded; }

bool isCalibrated(const reports::ReportCampaign& one) {
  return one.accuracy != nullptr && one.accuracy->calibration.reason.empty() &&
         !one.accuracy->calibration.models.empty();
}

bool hasAxes(const reports::ReportCampaign& one) { return isLoaded(one) || one.campaign.circle_sweeps.has_value(); }

bool hasWrist(const reports::ReportCampaign& one) { return isLoaded(one) || one.campaign.wrist_sweep.has_value(); }

namespace {

std::size_t countOf(const reports::ReportContent& content, const About& about) {
  return static_cast<std::size_t>(std::count_if(content.campaigns.begin(), content.campaigns.end(), about));
}

}  // namespace

void writeForEach(Html& html, const reports::ReportContent& content, const char* id, const char* heading,
                  const About& about, const std::function<void(const reports::ReportCampaign&)>& write) {
  // A report of no campaign keeps its headings.
  if (!content.campaigns.empty() && countOf(content, about) == 0) return;
  const auto section = html.element("section", {{"id", id}});
  html.leaf("h2", heading);
  writeEach(html, content, id, about, write);
}

void writeEach(Html& html, const reports::ReportContent& content, const char* id, const About& about,
               const std::function<void(const reports::ReportCampaign&)>& write) {
  const bool several = countOf(content, about) > 1;
  {
    const auto row = html.element("div", {{"class", several ? "several" : "one"}});
    for (std::size_t i = 0; i < content.campaigns.size(); ++i) {
      if (!about(content.campaigns[i])) continue;
      const auto column = html.element("div", {{"class", "each"}});
      if (content.campaigns.size() > 1) {
        html.leaf("h3", reports::asIs(content.campaigns[i].campaign.name));
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
