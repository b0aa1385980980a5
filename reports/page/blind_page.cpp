#include "reports/page/blind_page.h"

#include <fmt/format.h>

#include "reports/page/blind_sections.h"
#include "reports/page/html.h"
#include "reports/page/numbers.h"
#include "reports/page/style.h"

namespace stiffscope {

namespace {

using namespace blind;
using page::Html;

void writeHead(Html& html, const std::string& seal) {
  const auto head = html.element("head");
  html.voidElement("meta", {{"charset", "utf-8"}});
  html.voidElement("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  html.voidElement("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
  html.leaf("title", "stiffscope: the diagnosis on machines whose effect was withheld");
  html.leaf("style", page::pageStyle(seal.substr(0, 12)));
}

void writeNumber(Html& html, const Rate& rate, const char* words) {
  const auto item = html.element("li");
  html.leaf("b", rate.trials > 0 ? page::percent(rate.value(), 0) : "–");
  html.leaf("span", rate.trials > 0
                        ? fmt::format("{}: {} of {}, 95 % interval {} to {}", words, rate.hits, rate.trials,
                                      page::percent(rate.low, 0), page::percent(rate.high, 0))
                        : fmt::format("{}: no case", words));
}

void writeOpening(Html& html, const BlindOptions& options, const BlindResult& result) {
  const auto header = html.element("header");
  html.leaf("h1", "The diagnosis on machines whose effect was withheld");
  html.paragraph(
      fmt::format("{} simulated machines, seed {}. Truth sealed before the diagnosis started, SHA-256",
                  result.score.cases.size(), options.seed));
  html.leaf("code", result.seal);
  html.paragraph("Answers frozen before the seal was opened, SHA-256");
  html.leaf("code", result.answers_hash);
  const auto numbers = html.element("ul", {{"class", "numbers"}});
  const Score& score = result.score;
  writeNumber(html, score.rate("singles_from_2"), "one effect of size 2 and more, named and nothing else");
  writeNumber(html, score.rate("false_alarms"), "clean machines where something was said");
  writeNumber(html, score.rate("unknown_from_2"), "outside the vocabulary, size 2 and more, called unknown");
  writeNumber(html, score.rate("doubles_both_found"), "doubles with both effects found");
}

}  // namespace

std::string blindPage(const BlindOptions& options, const BlindResult& result) {
  Html html;
  {
    const auto root = html.element("html", {{"lang", "en"}});
    writeHead(html, result.seal);
    const auto body = html.element("body");
    const auto main = html.element("main");
    writeOpening(html, options, result);
    page::writeBlindRates(html, result.score);
    page::writeBlindSizes(html, result.score);
    page::writeBlindConfusion(html, result.score.confusion);
    page::writeBlindEffects(html, result.score);
    page::writeBlindShrink(html, result.score);
    page::writeBlindMethod(html);
  }
  return html.bytes();
}

}  // namespace stiffscope
