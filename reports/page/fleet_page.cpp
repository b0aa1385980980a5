#include "reports/page/pages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

#include "reports/page/html.h"
#include "reports/page/style.h"
#include "reports/words/fleet_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/rich_text.h"

namespace stiffscope::page {

namespace {

using fleet::Fleet;
using fleet::Stated;
using reports::asIs;

void writeFleetHead(Html& html, const std::string& id) {
  const auto head = html.element("head");
  html.voidElement("meta", {{"charset", "utf-8"}});
  html.voidElement("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  html.voidElement("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
  html.leaf("title", "stiffscope: fleet");
  html.style(pageStyle(id));
}

void writeCount(Html& html, std::size_t count, const char* one, const char* more) {
  const auto item = html.element("li");
  html.leaf("b", std::to_string(count));
  html.leaf("span", count == 1 ? one : more);
}

std::size_t machinesWith(const Fleet& fleet, fleet::NeedId id) {
  return static_cast<std::size_t>(
      std::count_if(fleet.machines.begin(), fleet.machines.end(), [id](const fleet::Machine& one) {
        return std::any_of(one.needs.begin(), one.needs.end(), [id](const fleet::Need& need) { return need.id == id; });
      }));
}

void writeFleetOpening(Html& html, const Fleet& fleet) {
  const auto header = html.element("header");
  html.leaf("h1", "Fleet");
  const auto failed = static_cast<std::size_t>(std::count_if(
      fleet.campaigns.begin(), fleet.campaigns.end(), [](const fleet::FleetCampaign& one) { return !one.result; }));
  const auto numbers = html.element("ul", {{"class", "numbers"}});
  writeCount(html, fleet.machines.size(), "machine", "machines");
  writeCount(html, fleet.campaigns.size(), "campaign", "campaigns");
  writeCount(html, failed, "campaign without a result", "campaigns without a result");
  writeCount(html, machinesWith(fleet, fleet::NeedId::changed), "machine that has changed",
             "machines that have changed");
}

void writeNeeds(Html& html, const Fleet& fleet) {
  const auto section = html.element("section", {{"id", "needs"}});
  html.leaf("h2", "What machines need");
  const auto scroll = html.element("div", {{"class", "scroll"}});
  const auto table = html.element("table", {{"class", "words long"}});
  html.leaf("caption", "Machines that need most first; all needs of each");
  {
    const auto head = html.element("thead");
    const auto row = html.element("tr");
    for (const char* column : {"machine", "need", "day", "next step", "reason"})
      html.leaf("th", column, {{"scope", "col"}});
  }
  std::size_t shown = 0;
  for (const fleet::Machine& machine : fleet.machines) {
    if (++shown > kMostMachinesShown) break;
    const auto body = html.element("tbody");
    bool first = true;
    for (const fleet::Need& need : machine.needs) {
      const auto row = html.element("tr");
      html.leaf("th", first ? asIs(machine.name) : "", {{"scope", "row"}});
      first = false;
      html.leaf("td", reports::needName(need.id));
      {
        const auto cell = html.element("td");
        const fleet::FleetCampaign& campaign = fleet.campaigns[need.campaign];
        if (campaign.report.empty()) {
          html.leaf("span", asIs(campaign.date));
        } else {
          html.leaf("a", asIs(campaign.date), {{"href", campaign.report}});
        }
      }
      html.leaf("td", reports::words(need.next));
      html.leaf("td", reports::words(need.reason));
    }
  }
  if (fleet.machines.size() > kMostMachinesShown)
    html.paragraph(fmt::format("{} of {} machines; `needs.csv` has all.", kMostMachinesShown, fleet.machines.size()));
}

std::string stepName(const fleet::FleetStep& step) {
  switch (step.what) {
    case fleet::FleetStep::What::compliance:
      return fmt::format("compliance of joint {}", step.compliance.joint + 1);
    case fleet::FleetStep::What::geometry:
      return "geometry";
    case fleet::FleetStep::What::effect_appeared:
      return "appeared: " + asIs(fmt::format("{}", fmt::join(step.effects, " or ")));
    case fleet::FleetStep::What::effect_gone:
      break;
  }
  return "gone: " + asIs(fmt::format("{}", fmt::join(step.effects, " or ")));
}

std::string stepSize(const fleet::FleetStep& step) {
  if (step.what == fleet::FleetStep::What::geometry) return reports::withMicro(reports::lengthWords(step.size, 0));
  if (step.what != fleet::FleetStep::What::compliance) return "–";
  const Stated share = step.compliance.share();
  return reports::withUncertainty(100.0 * share.value, 100.0 * (share.high - share.value)) + " %";
}

void writeSteps(Html& html, const Fleet& fleet) {
  const auto section = html.element("section", {{"id", "changes"}});
  html.leaf("h2", "What has changed");
  html.paragraph(fmt::format(
      "What is another from a date on, held against the days before it. Effects that all days share cancel in these "
      "differences. p-values are corrected for the dates at which a change could have been, and by Holm for the {} "
      "questions of the whole fleet; what is said to have changed is below {}. Between any two dates that follow each "
      "other: `changes.csv`.",
      fleet.chart_questions, reports::percent(fleet::kFleetLevel, 0)));
  if (fleet.steps.empty()) return html.paragraph("Nothing has.");
  reports::Table table{
      "Changes", {"machine", "holds from", "what", "size", "p (Holm)", "dates before", "dates since"}, {{"", {}}}};
  for (const fleet::FleetStep& step : fleet.steps) {
    table.groups[0].rows.push_back({asIs(step.machine), asIs(fleet.campaigns[step.campaign].date), stepName(step),
                                    stepSize(step), reports::significant(step.p_holm, 2),
                                    std::to_string(step.days_before), std::to_string(step.days_after)});
  }
  writeTable(html, table);
}

std::string detectableCell(const fleet::Detectable& one) {
  if (!std::isfinite(one.middle) && !std::isfinite(one.last)) return "–";
  return fmt::format("{} ({})", reports::percent(one.middle), reports::percent(one.last));
}

/// What a change has to be to be found: what is not said to have changed may have changed by less.
void writeDetectable(Html& html, const Fleet& fleet) {
  const auto section = html.element("section", {{"id", "detectable"}});
  html.leaf("h2", "What a change has to be to be found");
  html.paragraph(
      "A joint's compliance has to change by so much from the middle of the dates on (in brackets: on the last date "
      "alone) to be found nine times in ten, among all questions of the fleet, by the uncertainties of these days. –: "
      "these days do not see the joint. Days without a load see joints that the arm's own weight turns by more in some "
      "postures than in others, and another tool or weight on the arm as if joints had changed.");
  reports::Table table{"", {"", "dates", "days"}, {{"", {}}}};
  const int joints = reports::mostJointsOf(fleet);
  for (int joint = 0; joint < joints; ++joint) table.columns.push_back(reports::jointName(joint));
  for (const fleet::Machine& machine : fleet.machines) {
    for (const fleet::SeriesCharts& charts : fleet.charts) {
      const fleet::DaySeries& series = fleet.series[charts.series];
      if (series.machine != machine.name || series.campaigns.size() < 2) continue;
      if (table.groups[0].rows.size() == kMostMachinesShown) break;
      reports::Row row{asIs(reports::machineWords(fleet, series)), std::to_string(series.campaigns.size()),
                       std::string(series.kind == fleet::DayKind::unloaded ? "without a load" : "with loads") +
                           (charts.same_postures ? "" : ", other postures")};
      for (const fleet::Detectable& one : charts.detectable) row.push_back(detectableCell(one));
      row.resize(table.columns.size(), "–");
      table.groups[0].rows.push_back(std::move(row));
    }
  }
  if (table.groups[0].rows.empty())
    return html.paragraph("No machine has two dates that can be held against each other.");
  writeTable(html, table);
}

void writeCharts(Html& html, const Fleet& fleet, const std::vector<reports::Figure>& figures) {
  if (figures.empty()) return;
  const auto section = html.element("section", {{"id", "charts"}});
  html.leaf("h2", "Control charts");
  html.paragraph(fmt::format(
      "Compliance by date against the mean of the dates before the first change, in percent of it. Whiskers: 95 %, of "
      "what is not the same on every date. Limits, in grey: three standard deviations from the stated uncertainties, "
      "outside which one date in {:.0f} is by chance.",
      1.0 / fleet::kOutside));
  const auto charted = std::count_if(fleet.charts.begin(), fleet.charts.end(), [&](const fleet::SeriesCharts& one) {
    return fleet.series[one.series].campaigns.size() > 1;
  });
  if (static_cast<std::size_t>(charted) > figures.size())
    html.paragraph(fmt::format("Drawn: {} of {}, of the machines that need most.", figures.size(), charted));
  const auto grid = html.element("div", {{"class", "figures"}});
  for (const reports::Figure& figure : figures) {
    const auto element = html.element("figure", {{"id", figure.id}});
    html.voidElement("img", {{"src", "data:image/png;base64," + base64(figure.png)},
                             {"alt", figure.alt},
                             {"width", std::to_string(figure.width)},
                             {"height", std::to_string(figure.height)}});
    html.leaf("figcaption", figure.title + ". " + figure.caption);
  }
}

std::string statedCell(const Stated& one, double unit) {
  if (!std::isfinite(one.value)) return "–";
  if (!std::isfinite(one.low)) return reports::significant(one.value / unit, 4);
  if (!std::isfinite(one.high))
    return fmt::format("{} (above {})", reports::significant(one.value / unit, 3),
                       reports::significant(one.low / unit, 3));
  const double width = (one.high - one.low) / unit;
  return fmt::format("{} ({} to {})", reports::toPlaceOf(one.value / unit, width),
                     reports::toPlaceOf(one.low / unit, width), reports::toPlaceOf(one.high / unit, width));
}

/// `joints`: whose columns the table has.
reports::Row campaignRow(const fleet::FleetCampaign& one, int joints, const reports::StiffnessUnit& unit) {
  reports::Row row{asIs(one.date)};
  if (!one.result) {
    row.emplace_back("no result");
    constexpr int kBeside = 3;  // compensated, accuracy, besides joint springs
    for (int i = 0; i < joints + kBeside; ++i) row.emplace_back("–");
    return row;
  }
  const fleet::CampaignResult& day = *one.result;
  row.emplace_back(reports::auditWord(day.audit));
  for (const Stated& k : day.stiffness) row.emplace_back(statedCell(k, unit.size));
  for (int joint = day.joints(); joint < joints; ++joint) row.emplace_back("–");
  row.emplace_back(statedCell(day.compensated, 0.01));
  row.emplace_back(
      statedCell(day.kind == fleet::DayKind::unloaded ? day.calibrated : Stated{}, 1.0 / reports::kMmPerM));
  row.emplace_back(day.diagnosed ? asIs(reports::effectsKey(day)) : "–");
  return row;
}

void writeDays(Html& html, const Fleet& fleet) {
  const auto section = html.element("section", {{"id", "dates"}});
  html.leaf("h2", "Stiffness and accuracy by machine and date");
  std::vector<reports::StiffnessUnit> units;  // a machine's own, by its size
  bool one_unit = true;
  for (const fleet::Machine& machine : fleet.machines) {
    std::vector<double> stiffnesses;
    for (const std::size_t one : machine.campaigns) {
      if (!fleet.campaigns[one].result) continue;
      for (const Stated& k : fleet.campaigns[one].result->stiffness) stiffnesses.push_back(k.value);
    }
    units.push_back(reports::stiffnessUnit(stiffnesses));
    one_unit = one_unit && units.back().size == units.front().size;
  }
  reports::Table table{
      fmt::format("Stiffness in {}, deflection compensated on postures held out in\u00a0%, calibrated accuracy "
                  "in\u00a0mm; in brackets the 95\u00a0% interval",
                  units.empty() || one_unit ? (units.empty() ? reports::StiffnessUnit{} : units.front()).name
                                            : "the unit beside the machine"),
      {"", "date", "audit"},
      {}};
  const int joints = reports::mostJointsOf(fleet);
  for (int joint = 0; joint < joints; ++joint) table.columns.push_back(reports::jointName(joint));
  table.columns.insert(table.columns.end(), {"compensated", "accuracy", "besides joint springs"});
  for (const fleet::Machine& machine : fleet.machines) {
    if (table.groups.size() == kMostMachinesShown) break;
    const reports::StiffnessUnit& unit = units[table.groups.size()];
    reports::RowGroup group{asIs(machine.name) + (one_unit ? std::string() : fmt::format(" ({})", unit.name)), {}};
    for (const std::size_t one : machine.campaigns)
      group.rows.push_back(campaignRow(fleet.campaigns[one], joints, unit));
    table.groups.push_back(std::move(group));
  }
  writeTable(html, table);
  if (fleet.machines.size() > kMostMachinesShown)
    html.paragraph(fmt::format("{} of {} machines; `fleet.csv` has all.", kMostMachinesShown, fleet.machines.size()));
  std::vector<std::string> failures;
  for (const fleet::FleetCampaign& one : fleet.campaigns) {
    if (!one.result) failures.push_back(asIs(one.folder + ": " + one.failure));
  }
  html.list(failures);
}

}  // namespace

std::string fleetPage(const Fleet& fleet, const std::vector<reports::Figure>& figures, const std::string& id) {
  Html html;
  {
    const auto root = html.element("html", {{"lang", "en"}});
    writeFleetHead(html, id);
    const auto body = html.element("body");
    const auto main = html.element("main");
    writeFleetOpening(html, fleet);
    writeNeeds(html, fleet);
    writeSteps(html, fleet);
    writeDetectable(html, fleet);
    writeCharts(html, fleet, figures);
    writeDays(html, fleet);
  }
  return html.bytes();
}

}  // namespace stiffscope::page
