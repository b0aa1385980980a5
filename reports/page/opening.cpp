#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <optional>

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
#include "reports/words/extended_model_words.h"
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

/// What the machine itself does, which the audit does not know: a reader who sees both can tell why it warns.
std::string whyTheAuditWarns(const reports::ReportCampaign& one) {
  if (one.diagnosis == nullptr || one.diagnosis->verdict.entries.empty()) return {};
  constexpr std::array kByTheMachine{"circle_residual", "axis_agreement", "wrist_sphere", "unloaded_positions"};
  const bool warns =
      std::any_of(one.audit->checks.begin(), one.audit->checks.end(), [&](const preparation::AuditCheck& check) {
        return check.verdict == preparation::AuditVerdict::warn &&
               std::find(kByTheMachine.begin(), kByTheMachine.end(), check.id) != kByTheMachine.end();
      });
  if (!warns) return {};
  return fmt::format(
      "The audit knows the URDF and joint springs alone: warnings of circles, axes, wrist and unloaded positions can "
      "come from what the readings show besides, {}.",
      reports::presentWords(one.diagnosis->verdict));
}

/// What a reader must know before believing the numbers of a campaign.
std::vector<std::string> warningsOf(const reports::ReportCampaign& one) {
  std::vector<std::string> items;
  if (one.audit != nullptr) {
    const std::string untested = reports::untestedWords(*one.audit, kindOf(one));
    if (!untested.empty()) items.push_back(untested);
    for (std::string& mistake : suspectedWords(*one.audit)) items.push_back(std::move(mistake));
    addAuditWarnings(*one.audit, items);
    if (std::string why = whyTheAuditWarns(one); !why.empty()) items.push_back(std::move(why));
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

/// What mends the files, a sentence a remedy, with all the places that it is for.
std::vector<std::string> mendWords(const std::vector<mistakes::Suspected>& suspected) {
  struct Mend {
    std::string mistake, remedy;
    std::vector<std::string> places;
  };
  std::vector<Mend> mends;
  for (const mistakes::Suspected& one : suspected) {
    const Mend own{reports::auditName(std::string(one.mistake.name())), reports::words(one.remedy), {}};
    auto same = std::find_if(mends.begin(), mends.end(), [&own](const Mend& other) {
      return other.mistake == own.mistake && other.remedy == own.remedy;
    });
    if (same == mends.end()) same = mends.insert(mends.end(), own);
    same->places.push_back("of the " + reports::words(one.where));
  }
  std::vector<std::string> sentences;
  for (const Mend& mend : mends) {
    sentences.push_back(fmt::format("The audit suspects {} in the files, {} {}: {}, then make this report again.",
                                    mend.places.size() > 1 ? "mistakes" : "a mistake", mend.mistake,
                                    fmt::join(mend.places, "; "), mend.remedy));
  }
  return sentences;
}

/// What a reader does with the result, the most pressing first; nothing where nothing is known to be open.
void writeNext(Html& html, const reports::ReportContent& content) {
  std::vector<std::string> steps;
  const auto& campaigns = content.campaigns;
  for (const reports::ReportCampaign& one : campaigns) {
    if (!explainedByMistakes(one)) continue;
    for (std::string& mend : mendWords(one.audit->suspected)) steps.push_back(std::move(mend));
  }
  if (steps.empty() && std::any_of(campaigns.begin(), campaigns.end(), auditFails)) {
    steps.emplace_back(
        "See which readings fail and why (@{Audit}); measure them again, or state why the result stands without "
        "them.");
  }
  if (content.avoided && content.avoided->available &&
      !reports::changedWithoutEncoder(reports::ofKind(campaigns, reports::DayKind::loaded), *content.avoided).empty())
    steps.emplace_back(
        "Find out what else changed between the two days, and measure them again: joints without a double encoder "
        "differ as well.");
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
    html.rich(fmt::format(" More in @{{{}}}.", reports::anyOfKind(campaigns, reports::DayKind::loaded)
                                                   ? "What the model misses"
                                                   : "What to do next"));
}

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

/// Of several days with a load what the verdict says, and what the effects in the model change, one by one.
std::vector<std::string> findings(const reports::ReportContent& content) {
  std::vector<std::string> items = reports::verdictItems(content.campaigns, content.avoided);
  const std::vector<std::string> names = columnNames(content);
  for (std::size_t i = 0; i < content.campaigns.size(); ++i) {
    if (const extended_model::ExtendedModel* improved = content.campaigns[i].improved; improved != nullptr)
      items.push_back(fmt::format("{}: {}", names[i], reports::asIs(reports::gainWords(*improved))));
  }
  return items;
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
    // What the audit refuses is not to be read as a result, however large it stands there.
    if (fails) html.paragraph(reports::doubtedNumbersWords(), "faint");
    const auto list = html.element("ul", {{"class", fails ? "numbers doubted" : "numbers"}});
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
    if (several_pictures) {
      const auto told = html.element("div", {{"class", "told"}});
      html.list(findings(content));
    }
  }
  writeAcceptance(html, content);
  if (loaded && !several_pictures) html.paragraph(content.verdict);
  writeWarnings(html, content);
}

}  // namespace stiffscope::page
