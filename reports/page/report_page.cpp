#include "reports/page/report_page.h"

#include "reports/page/html.h"
#include "reports/page/sections.h"
#include "reports/page/style.h"

namespace stiffscope {

namespace {

void writeHead(page::Html& html, const ReportContent& content) {
  const auto head = html.element("head");
  html.voidElement("meta", {{"charset", "utf-8"}});
  html.voidElement("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  html.voidElement("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
  html.leaf("title", page::plain(content.title));
  html.leaf("style", page::pageStyle());
}

}  // namespace

std::string reportPage(const ReportContent& content) {
  page::Html html;
  {
    const auto root = html.element("html", {{"lang", "en"}});
    writeHead(html, content);
    const auto body = html.element("body");
    const auto main = html.element("main");
    page::writeOpening(html, content);
    page::writeConditions(html, content);
    page::writeWrist(html, content);
    page::writeLinks(html, content);
    page::writeStiffness(html, content);
    page::writeSubsets(html, content);
    page::writeCompensation(html, content);
    page::writeFigures(html, content);
    page::writeAudit(html, content);
    page::writeLeftOut(html, content);
    page::writeProvenance(html, content);
  }
  return html.bytes();
}

}  // namespace stiffscope
