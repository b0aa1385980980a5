#include "reports/page/sections.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "reports/page/html.h"
#include "reports/report_content.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"

namespace stiffscope::page {

namespace {

void writeFigure(Html& html, const reports::Figure& figure, int number, bool has_scene) {
  const auto element = html.element("figure", {{"id", figure.id}});
  {
    // Of a chart a narrow screen shows a part, as large as can be read; the rest comes by scrolling. A scene fits it.
    const auto holder = html.element("div", {{"class", has_scene ? "picture" : "picture readable"}});
    html.voidElement("img", {{"src", "data:image/png;base64," + base64(figure.png)},
                             {"alt", figure.alt},
                             {"width", std::to_string(figure.width)},
                             {"height", std::to_string(figure.height)}});
  }
  const auto caption = html.element("figcaption");
  html.leaf("b", fmt::format("Figure {}. {}.", number, figure.title));
  html.text(" ");
  html.rich(figure.caption);
}

}  // namespace

void writeContents(Html& html, const std::vector<Html::Section>& sections) {
  const auto nav = html.element("nav", {{"aria-label", "Contents"}});
  const auto fold = html.element("details");
  html.leaf("summary", "Contents");
  const auto list = html.element("ul");
  for (const Html::Section& section : sections) {
    const auto item = html.element("li");
    html.leaf("a", section.name, {{"href", "#" + section.id}});
  }
}

bool hasFigures(const reports::ReportContent& content, const std::string& section) {
  return std::any_of(content.figures.begin(), content.figures.end(),
                     [&](const reports::Figure& figure) { return figure.section == section; });
}

namespace {

/// Those of a section that `chosen` takes, under the numbers that they have among all.
void writeChosen(Html& html, const reports::ReportContent& content, const std::string& section,
                 const std::function<bool(const reports::Figure&)>& chosen) {
  const auto here = [&](const reports::Figure& figure) { return figure.section == section && chosen(figure); };
  if (std::none_of(content.figures.begin(), content.figures.end(), here)) return;
  int number = 0;
  for (const char* earlier : reports::kFigureSections) {
    if (section == earlier) break;
    number += static_cast<int>(std::count_if(content.figures.begin(), content.figures.end(),
                                             [&](const reports::Figure& figure) { return figure.section == earlier; }));
  }
  const auto grid = html.element("div", {{"class", "figures"}});
  for (const reports::Figure& figure : content.figures) {
    if (figure.section != section) continue;
    ++number;
    const bool has_scene = std::any_of(content.scenes.begin(), content.scenes.end(),
                                       [&](const reports::PageScene& scene) { return scene.figure == figure.id; });
    if (chosen(figure)) writeFigure(html, figure, number, has_scene);
  }
}

}  // namespace

void writeFiguresOf(Html& html, const reports::ReportContent& content, const std::string& section) {
  writeChosen(html, content, section, [](const reports::Figure&) { return true; });
}

void writeFigures(Html& html, const reports::ReportContent& content) {
  if (!hasFigures(content, "figures")) return;
  const auto section = html.element("section", {{"id", "figures"}});
  html.leaf("h2", "Figures");
  writeFiguresOf(html, content, "figures");
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
      // A campaign's figures stand with its tables: on paper they fill the room that a table leaves.
      if (several)
        writeChosen(html, content, id, [i](const reports::Figure& figure) { return figure.campaign == i; });
      else
        writeFiguresOf(html, content, id);
    }
    html.setTableSuffix("");
  }
  if (several) writeChosen(html, content, id, [](const reports::Figure& figure) { return !figure.campaign; });
}

}  // namespace stiffscope::page
