#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/io/units.h"
#include "reports/page/facts.h"
#include "reports/page/html.h"
#include "reports/page/key_numbers.h"
#include "reports/page/sections.h"
#include "reports/report_content.h"
#include "reports/words/accuracy_words.h"
#include "reports/words/audit_plain.h"
#include "reports/words/conformity_words.h"
#include "reports/words/day_words.h"
#include "reports/words/effect_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"
#include "reports/words/verdict.h"

// The first screen and the first printed page: what was found, whether it is to be believed, of what it is.

namespace stiffscope::page {

namespace {

/// What the checks of the audit found, in plain words with each check's name; the audit's own section explains them.
void addAuditWarnings(const audit::AuditReport& audit, std::vector<std::string>& items) {
  for (const preparation::AuditVerdict verdict : {preparation::AuditVerdict::fail, preparation::AuditVerdict::warn}) {
    for (auto check = audit.checks.begin(); check != audit.checks.end(); ++check) {
      const auto same = [&](const preparation::AuditCheck& one) {
        return one.id == check->id && one.verdict == verdict;
      };
      if (check->verdict != verdict || std::find_if(audit.checks.begin(), check, same) != check) continue;
      std::string where;  // axes one by one, of a check that is made for each
      for (auto one = check; one != audit.checks.end(); ++one) {
        if (same(*one) && !one->where.empty() && one->id == "circle_arc") where += ", " + reports::words(one->where);
      }
      items.push_back(fmt::format("The audit {}: {} ({}{}).", reports::auditWord(verdict),
                                  reports::amissWords(check->id), reports::auditName(check->id), where));
    }
  }
}

/// What a reader must know before believing the numbers of a campaign.
std::vector<std::string> warningsOf(const reports::ReportCampaign& one) {
  std::vector<std::string> items;
  if (one.audit != nullptr) {
    const std::string untested = reports::untestedWords(*one.audit, kindOf(one));
    if (!untested.empty()) items.push_back(untested);
    for (std::string& mistake : suspectedWords(*one.audit)) items.push_back(std::move(mistake));
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
  std::vector<std::vector<std::string>> own;
  for (const reports::ReportCampaign& one : campaigns) own.push_back(warningsOf(one));
  // What holds of every campaign is said once.
  std::vector<std::string> shared;
  if (campaigns.size() > 1) shared = own.front();
  for (const std::vector<std::string>& other : own)
    std::erase_if(shared, [&](const auto& item) { return std::find(other.begin(), other.end(), item) == other.end(); });
  for (std::vector<std::string>& items : own)
    std::erase_if(items,
                  [&](const auto& item) { return std::find(shared.begin(), shared.end(), item) != shared.end(); });
  for (const std::string& item : shared)
    of_all.push_back((campaigns.size() == 2 ? "Both days: " : "All days: ") + item);
  const bool any = std::any_of(own.begin(), own.end(), [](const auto& items) { return !items.empty(); });
  if (!any && of_all.empty()) return;
  html.paragraph("Before you believe these numbers:");
  html.list(of_all);
  if (!any) return;
  const auto cautions = html.element("div", {{"class", campaigns.size() > 1 ? "several" : "cautions"}});
  for (std::size_t i = 0; i < campaigns.size(); ++i) {
    if (own[i].empty()) continue;
    const auto column = html.element("div");
    if (campaigns.size() > 1) html.paragraph(reports::asIs(campaigns[i].campaign.name), "name");
    html.list(own[i]);
  }
}

/// Column heads for campaigns of a kind: their names, or `alone` where there is one.
std::vector<std::string> headsOf(const reports::ReportContent& content, const About& about, const std::string& alone) {
  if (content.campaigns.size() == 1) return {alone};
  const std::vector<std::string> names = columnNames(content);
  std::vector<std::string> heads;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (about(content.campaigns[i])) heads.push_back(names[i]);
  }
  return heads;
}

/// `alone`: the only day of its table, which has room for words.
std::string stiffnessWords(const reports::ReportCampaign& one, int joint, const reports::StiffnessUnit& unit,
                           bool alone) {
  const auto shown = reports::shownMethod(one.identification);
  if (!shown) return "–";
  const identification::StiffnessEstimate& estimate = one.identification.of(*shown).estimate;
  if (joint >= estimate.joints()) return "–";
  const auto at = static_cast<std::size_t>(joint);
  if (!estimate.identifiable[at])
    return alone ? reports::unseenWords(one.identification.identifiability.joints[at]) : "not seen";
  const double u = identification::expandedUncertainty(estimate, joint);
  const double k = estimate.stiffness(joint) / unit.size;
  const std::string mark = reports::words(estimate.mark(joint));
  const std::string words = std::isfinite(u) ? reports::withUncertainty(k, u / unit.size)
                                             : fmt::format("{} (U open)", reports::significant(k, 3));
  return mark.empty() ? words : fmt::format("{} ({})", words, mark);
}

/// The effects in the model beside the joint springs, where all days have the same.
std::string modelOf(const reports::ReportContent& content) {
  std::optional<std::vector<effects::Effect>> all;
  for (const reports::ReportCampaign& one : content.campaigns) {
    if (!isLoaded(one)) continue;
    std::vector<effects::Effect> own;
    if (one.improved != nullptr) {
      for (const extended_model::AddedEffect& added : one.improved->effects.added) own.push_back(added.effect);
    }
    if (all && *all != own) return {};
    all = own;
  }
  if (!all || all->empty()) return {};
  return fmt::format(", {} in the model", reports::effectNames(*all, ", "));
}

void addStiffnesses(const reports::ReportContent& content, reports::Table& table) {
  std::vector<std::string> methods;
  for (const reports::ReportCampaign& one : content.campaigns) {
    const auto shown = reports::shownMethod(one.identification);
    if (!isLoaded(one) || !shown) continue;
    if (const std::string name = reports::longName(*shown);
        std::find(methods.begin(), methods.end(), name) == methods.end())
      methods.push_back(name);
  }
  if (methods.empty()) return;  // the verdict says why
  const bool one_method = methods.size() == 1;
  std::vector<double> stiffnesses;
  for (const reports::ReportCampaign& one : content.campaigns) {
    const auto shown = reports::shownMethod(one.identification);
    if (!isLoaded(one) || !shown) continue;
    const identification::StiffnessEstimate& estimate = one.identification.of(*shown).estimate;
    for (int joint = 0; joint < estimate.joints(); ++joint) {
      if (estimate.identifiable[static_cast<std::size_t>(joint)]) stiffnesses.push_back(estimate.stiffness(joint));
    }
  }
  const reports::StiffnessUnit unit = reports::stiffnessUnit(stiffnesses);
  table.caption = fmt::format("Joint stiffness k ± U (95 %), {}{}{}", unit.name,
                              one_method ? ", by " + methods.front() : "", modelOf(content));
  table.columns = {"Joint"};
  for (const std::string& head : headsOf(content, isLoaded, "k ± U")) table.columns.push_back(head);
  if (methods.size() > 1) {
    std::size_t column = 1;
    for (const reports::ReportCampaign& one : content.campaigns) {
      const auto shown = reports::shownMethod(one.identification);
      if (isLoaded(one) && shown) table.columns[column] += " (" + reports::shortName(*shown) + ")";
      if (isLoaded(one)) ++column;
    }
  }
  const int joints = reports::mostJointsOf(reports::ofKind(content.campaigns, reports::DayKind::loaded));
  for (int joint = 0; joint < joints; ++joint) {
    reports::Row row{reports::jointName(joint)};
    for (const reports::ReportCampaign& one : content.campaigns) {
      if (isLoaded(one)) row.emplace_back(stiffnessWords(one, joint, unit, table.columns.size() == 2));
    }
    table.groups.front().rows.push_back(std::move(row));
  }
}

bool isUnloaded(const reports::ReportCampaign& one) { return one.accuracy != nullptr; }

void addErrors(const reports::ReportContent& content, reports::Table& table) {
  table.caption = "Position error in postures that took no part, mm";
  table.columns = {"Model"};
  const bool several = content.campaigns.size() > 1;
  for (const std::string& head : headsOf(content, isUnloaded, "")) {
    table.columns.push_back(several ? head + ": rms" : "rms");
    table.columns.push_back("largest");
  }
  using calibration::CalibratedModel;
  for (const CalibratedModel model : {CalibratedModel::nominal, CalibratedModel::geometry, CalibratedModel::effects}) {
    reports::Row row{reports::capitalised(reports::modelWords(model))};
    bool any = false;
    for (const reports::ReportCampaign& one : content.campaigns) {
      if (!isUnloaded(one)) continue;
      const auto& models = one.accuracy->calibration.models;
      const auto found =
          std::find_if(models.begin(), models.end(), [model](const auto& m) { return m.model == model; });
      any = any || found != models.end();
      const bool there = found != models.end();
      const calibration::PositionErrors errors =
          there ? (found->held_out.readings > 0 ? found->held_out : found->fitted) : calibration::PositionErrors{};
      row.emplace_back(there ? reports::significant(errors.rms / io::kMillimetre, 3) : "–");
      row.emplace_back(there ? reports::significant(errors.largest / io::kMillimetre, 3) : "–");
    }
    if (any) table.groups.front().rows.push_back(std::move(row));
  }
}

void addDistances(const reports::ReportContent& content, reports::Table& table) {
  table.caption = "Distance of axes from the URDF's ± U, mm";
  table.columns = {"Axes"};
  for (const std::string& head : headsOf(content, isAny, "Difference")) table.columns.push_back(head);
  const auto links = static_cast<std::size_t>(reports::mostJointsOf(content.campaigns)) - 1;
  for (std::size_t i = 0; i < links; ++i) {
    reports::Row row{fmt::format("{} and {}", i + 1, i + 2)};
    bool any = false;
    for (const reports::ReportCampaign& one : content.campaigns) {
      if (i >= one.identification.frames.links.size()) {
        row.emplace_back("–");
        continue;
      }
      const frames::LinkGeometry& link = one.identification.frames.links[i];
      any = any || link.distance_sd.has_value();
      row.emplace_back(link.distance_sd
                           ? reports::withUncertainty((link.distance - link.nominal_distance) / io::kMillimetre,
                                                      reports::expanded(*link.distance_sd) / io::kMillimetre)
                           : "–");
    }
    if (any) table.groups.front().rows.push_back(std::move(row));
  }
}

/// The result in a small table: of loads the stiffnesses by the method shown first, of an unloaded day its errors, of
/// sweeps the distances between axes.
reports::Table resultTable(const reports::ReportContent& content) {
  reports::Table table;
  table.on_page_alone = true;
  table.groups.emplace_back();
  const bool loaded = reports::anyOfKind(content.campaigns, reports::DayKind::loaded);
  const bool unloaded = reports::anyOfKind(content.campaigns, reports::DayKind::unloaded);
  if (loaded)
    addStiffnesses(content, table);
  else if (unloaded)
    addErrors(content, table);
  else
    addDistances(content, table);
  return table;
}

/// The limits with what came of them, of one campaign.
void writeLimits(Html& html, const reports::ReportCampaign& one) {
  reports::Table table{
      "Acceptance limits", {"Limit on", "Asked for", "Found (95\u00a0%)", "Verdict", "Reason"}, {{}}, true, "limits"};
  reports::DataTable& data = table.data.emplace();
  data.columns = {"name", "least", "most", "value", "low", "high", "verdict", "in_guard_band", "missing", "reason"};
  for (const conformity::Decision& decision : *one.decisions) {
    const conformity::Limit& limit = decision.limit;
    table.groups.front().rows.push_back({reports::limitName(limit.quantity), reports::limitAsked(limit),
                                         reports::foundWords(decision), reports::verdictWords(decision),
                                         reports::asIs(limit.reason)});
    const double unit = conformity::nameOf(limit.quantity).unit;
    const auto number = [unit](const std::optional<double>& value) {
      return value ? reports::DataCell(*value / unit) : reports::DataCell();
    };
    const auto& found = decision.measured;
    data.rows.push_back(
        {std::string(conformity::nameOf(limit.quantity).name), number(limit.least), number(limit.most),
         found ? number(found->value) : reports::DataCell(), found ? number(found->interval.low) : reports::DataCell(),
         found ? number(found->interval.high) : reports::DataCell(), std::string(reports::nameOf(decision.verdict)),
         decision.in_guard_band ? 1.0 : 0.0, std::string(reports::nameOf(decision.missing)), limit.reason});
  }
  writeTable(html, table);
}

bool hasDecisions(const reports::ReportCampaign& one) { return one.decisions != nullptr && !one.decisions->empty(); }

void writeAcceptance(Html& html, const reports::ReportContent& content) {
  if (content.limits_file.empty()) return;
  std::vector<std::vector<conformity::Decision>> by_day;
  for (const reports::ReportCampaign& one : content.campaigns) {
    if (hasDecisions(one)) by_day.push_back(*one.decisions);
  }
  if (by_day.empty()) return;
  const auto part = html.element("div", {{"id", "limits"}});
  html.paragraph(reports::acceptanceSentence(by_day), "finding");
  writeEach(html, content, "limits", hasDecisions, [&](const reports::ReportCampaign& one) { writeLimits(html, one); });
  html.paragraph(reports::decisionRuleWords(), "faint");
}

bool auditFails(const reports::ReportCampaign& one) {
  return one.audit != nullptr && one.audit->verdict == preparation::AuditVerdict::fail;
}

/// What those who measured, or simulated, say of their days: before anything is read from the numbers.
void writeNotes(Html& html, const reports::ReportContent& content) {
  const auto& campaigns = content.campaigns;
  const auto noteOf = [](const reports::ReportCampaign& one) -> const std::string& { return one.campaign.texts.note; };
  const auto first =
      std::find_if(campaigns.begin(), campaigns.end(), [&](const auto& one) { return !noteOf(one).empty(); });
  if (first == campaigns.end()) return;
  if (std::all_of(campaigns.begin(), campaigns.end(), [&](const auto& one) { return noteOf(one) == noteOf(*first); })) {
    html.paragraph("Note: " + reports::asIs(noteOf(*first)), "stated");
    return;
  }
  // Of one day it is not to be taken for the others'.
  const std::vector<std::string> names = columnNames(content);
  for (std::size_t i = 0; i < campaigns.size(); ++i) {
    if (!noteOf(campaigns[i]).empty())
      html.paragraph(fmt::format("Note on {}: {}", names[i], reports::asIs(noteOf(campaigns[i]))), "stated");
  }
}

/// What the audit says of the readings, once where it says the same of all; an unloaded day's verdict has it already.
void writeJudgements(Html& html, const reports::ReportContent& content) {
  std::vector<std::string> sentences;
  for (const reports::ReportCampaign& one : content.campaigns) {
    if (one.audit == nullptr || !isLoaded(one)) continue;
    sentences.push_back(reports::auditMeaning(*one.audit, kindOf(one)));
  }
  if (sentences.empty()) return;
  const bool same =
      std::all_of(sentences.begin(), sentences.end(), [&](const auto& one) { return one == sentences.front(); });
  const bool fails = std::any_of(content.campaigns.begin(), content.campaigns.end(), auditFails);
  const char* css_class = fails ? "judgement bad" : "judgement";
  if (same) {
    html.paragraph(sentences.size() > 1 ? "Both days: " + sentences.front() : sentences.front(), css_class);
    return;
  }
  const std::vector<std::string> names = columnNames(content);
  std::size_t next = 0;
  for (std::size_t i = 0; i < content.campaigns.size(); ++i) {
    if (content.campaigns[i].audit == nullptr || !isLoaded(content.campaigns[i])) continue;
    html.paragraph(fmt::format("{}: {}", names[i], sentences[next++]), css_class);
  }
}

/// The audit fails and knows a mistake of the files that would do so.
bool explainedByMistakes(const reports::ReportCampaign& one) {
  return auditFails(one) && !one.audit->suspected.empty();
}

std::string mendWords(const mistakes::Suspected& suspected) {
  return fmt::format("The audit suspects a mistake in the files, {} of the {}: {}, then make this report again.",
                     reports::auditName(std::string(suspected.mistake.name())), reports::words(suspected.where),
                     reports::words(suspected.remedy));
}

/// What a reader does with the result, the most pressing first; nothing where nothing is known to be open.
void writeNext(Html& html, const reports::ReportContent& content) {
  std::vector<std::string> steps;
  const auto& campaigns = content.campaigns;
  for (const reports::ReportCampaign& one : campaigns) {
    if (!explainedByMistakes(one)) continue;
    for (const mistakes::Suspected& suspected : one.audit->suspected) steps.push_back(mendWords(suspected));
  }
  if (steps.empty() && std::any_of(campaigns.begin(), campaigns.end(), auditFails)) {
    steps.emplace_back(
        "See under Audit which readings fail and why; measure them again, or state why the result stands without "
        "them.");
  }
  for (const reports::ReportCampaign& one : campaigns) {
    // What a diagnosis says of readings with a mistake in them, it says of the mistake.
    if (explainedByMistakes(one)) continue;
    std::vector<std::string> own;
    if (one.diagnosis != nullptr && one.diagnosis->usable) own = diagnosisActions(*one.diagnosis);
    if (isCalibrated(one)) own = reports::accuracyActions(*one.accuracy);
    for (std::string& step : own) {
      if (std::find(steps.begin(), steps.end(), step) == steps.end()) steps.push_back(std::move(step));
    }
  }
  if (steps.empty()) return;
  constexpr std::size_t kMost = 3;
  const bool more = steps.size() > kMost;
  if (more) steps.resize(kMost);
  const auto paragraph = html.element("p", {{"class", "next"}});
  html.leaf("b", "Next:");
  html.rich(fmt::format(" {}", fmt::join(steps, " ")));
  if (more)
    html.rich(fmt::format(" More under {}.", reports::anyOfKind(campaigns, reports::DayKind::loaded)
                                                 ? "What the model misses"
                                                 : "What to do next"));
}

}  // namespace

namespace {

/// The campaign, or of several the machine, and the dates, before the report's number.
std::string whatAndWhen(const reports::ReportContent& content) {
  std::vector<std::string> parts;
  const auto add = [&parts](const std::string& words) {
    if (!words.empty() && std::find(parts.begin(), parts.end(), reports::asIs(words)) == parts.end())
      parts.push_back(reports::asIs(words));
  };
  for (const reports::ReportCampaign& one : content.campaigns)
    add(content.campaigns.size() == 1 ? one.campaign.name : one.campaign.robot.name);
  for (const reports::ReportCampaign& one : content.campaigns) add(one.campaign.date);
  return parts.empty() ? std::string() : fmt::format("{} · ", fmt::join(parts, " · "));
}

}  // namespace

void writeOpening(Html& html, const reports::ReportContent& content) {
  const auto header = html.element("header");
  html.leaf("h1", content.title);
  html.paragraph(whatAndWhen(content) + fmt::format("Report {}", reports::reportId(content)), "faint");
  const bool loaded = reports::anyOfKind(content.campaigns, reports::DayKind::loaded);
  writeNotes(html, content);
  // Of loads two sentences: what the audit says, what the diagnosis finds; the numbers are in the table below.
  writeJudgements(html, content);
  const bool mistaken = std::any_of(content.campaigns.begin(), content.campaigns.end(), explainedByMistakes);
  if (const std::string diagnosis = reports::diagnosisVerdict(content.campaigns); !diagnosis.empty() && !mistaken)
    html.paragraph(diagnosis, "verdict");
  const bool fails = std::any_of(content.campaigns.begin(), content.campaigns.end(), auditFails);
  if (!loaded) html.paragraph(content.verdict, fails ? "verdict bad" : "verdict");
  if (content.campaigns.empty()) return;
  writeNext(html, content);
  if (const std::vector<KeyNumber> numbers = keyNumbers(content); !numbers.empty()) {
    const auto list = html.element("ul", {{"class", "numbers"}});
    for (const KeyNumber& number : numbers) {
      const auto item = html.element("li");
      html.leaf("b", number.value);
      html.leaf("span", number.words);
    }
  }
  // Beside pictures one above the other there is room for the words; on paper they stand below.
  const bool several_pictures =
      loaded && std::count_if(content.figures.begin(), content.figures.end(),
                              [](const reports::Figure& figure) { return figure.section == "opening"; }) > 1;
  {
    const auto first = html.element("div", {{"class", "first"}});
    {
      const auto result = html.element("div", {{"class", "result"}});
      if (const reports::Table table = resultTable(content); !table.groups.front().rows.empty())
        writeTable(html, table);
      std::vector<Facts> facts;
      for (const reports::ReportCampaign& one : content.campaigns) facts.push_back(whoAndWhat(one));
      writeFacts(html, "What was measured, by whom and with what", columnNames(content), sideBySide(facts));
    }
    writeFiguresOf(html, content, "opening");
    if (several_pictures) html.paragraph(content.verdict, "told");
  }
  writeAcceptance(html, content);
  if (loaded && !several_pictures) html.paragraph(content.verdict);
  writeWarnings(html, content);
}

}  // namespace stiffscope::page
