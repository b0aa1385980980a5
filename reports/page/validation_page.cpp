#include "reports/page/pages.h"

#include <fmt/format.h>
#include <numeric>

#include "core/validation/score.h"
#include "reports/page/html.h"
#include "reports/page/style.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/validation_words.h"

namespace stiffscope::page {

// The sections of the blind test's page, in its order.

void writeBlindRates(Html& html, const validation::Score& score);
void writeBlindSizes(Html& html, const validation::Score& score);
/// Rows that had no case are left out; cells are shaded by their share of the row.
void writeBlindConfusion(Html& html, const validation::Confusion& confusion);
void writeBlindEffects(Html& html, const validation::Score& score);
void writeBlindShrink(Html& html, const validation::Score& score);
void writeBlindMethod(Html& html, bool unloaded);  ///< what sizes and rates mean

namespace {

std::string styleOf(int count, int row_total, bool right) {
  constexpr const char* kNarrow = "padding:.28rem .4rem;text-align:center";
  if (count == 0) return kNarrow;
  const double share = static_cast<double>(count) / row_total;
  return fmt::format("{};background:rgba({},{:.2f})", kNarrow, right ? "40,140,80" : "200,80,40", 0.12 + 0.6 * share);
}

}  // namespace

void writeBlindConfusion(Html& html, const validation::Confusion& confusion) {
  html.leaf("h2", "What was, and what was said");
  html.paragraph(
      "Rows: the truth, doubles and machines as they are aside. Columns: the answer; a class with the true effect in "
      "it counts as "
      "that effect.");
  const auto scroll = html.element("div", {{"class", "scroll"}});
  const auto table = html.element("table");
  {
    const auto head = html.element("thead");
    const auto row = html.element("tr");
    html.leaf("th", "", {{"scope", "col"}});
    for (const std::string& name : confusion.answers) {
      html.leaf("th", name, {{"scope", "col"}, {"style", "writing-mode:vertical-rl;padding:.3rem .2rem"}});
    }
  }
  const auto body = html.element("tbody");
  for (std::size_t r = 0; r < confusion.truths.size(); ++r) {
    const std::vector<int>& counts = confusion.counts[r];
    const int total = std::accumulate(counts.begin(), counts.end(), 0);
    if (total == 0) continue;
    const auto row = html.element("tr");
    html.leaf("th", confusion.truths[r], {{"scope", "row"}});
    for (std::size_t c = 0; c < counts.size(); ++c) {
      const bool right = confusion.answers[c] == confusion.truths[r] ||
                         (confusion.truths[r] == "outside" && confusion.answers[c] == "unknown");
      html.leaf("td", counts[c] > 0 ? std::to_string(counts[c]) : "", {{"style", styleOf(counts[c], total, right)}});
    }
  }
}

namespace {

void writeHead(Html& html, const std::string& seal) {
  const auto head = html.element("head");
  html.voidElement("meta", {{"charset", "utf-8"}});
  html.voidElement("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  html.voidElement("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
  html.leaf("title", "stiffscope: the diagnosis on machines whose effect was withheld");
  html.style(pageStyle(seal.substr(0, 12)));
}

void writeNumber(Html& html, const numerics::Rate& rate, const char* words) {
  const auto item = html.element("li");
  html.leaf("b", rate.trials > 0 ? reports::percent(rate.value(), 0) : "–");
  html.leaf("span", rate.trials > 0 ? fmt::format("{}: {} of {}, 95 % interval {} to {}", words, rate.hits, rate.trials,
                                                  reports::percent(rate.low, 0), reports::percent(rate.high, 0))
                                    : fmt::format("{}: no case", words));
}

void writeOpening(Html& html, const validation::BlindOptions& options, const validation::BlindResult& result) {
  const auto header = html.element("header");
  html.leaf("h1", "The diagnosis on machines whose effect was withheld");
  html.paragraph(fmt::format("{} simulated machines{}, seed {}. Truth sealed before the diagnosis started, SHA-256",
                             result.score.cases.size(), options.unloaded ? " on days without a load" : "",
                             options.seed));
  html.leaf("code", result.seal);
  html.paragraph("Answers frozen before the seal was opened, SHA-256");
  html.leaf("code", result.answers_hash);
  const auto numbers = html.element("ul", {{"class", "numbers"}});
  const validation::Score& score = result.score;
  writeNumber(html, score.rate("singles_from_2"), "one effect of size 2 and more, named and nothing else");
  writeNumber(html, score.rate("false_alarms"), "clean machines where something was said");
  writeNumber(html, score.rate("unknown_from_2"), "outside the vocabulary, size 2 and more, called unknown");
  writeNumber(html, score.rate("doubles_both_found"), "doubles with both effects found");
}

}  // namespace

std::string blindPage(const validation::BlindOptions& options, const validation::BlindResult& result) {
  Html html;
  {
    const auto root = html.element("html", {{"lang", "en"}});
    writeHead(html, result.seal);
    const auto body = html.element("body");
    const auto main = html.element("main");
    writeOpening(html, options, result);
    writeBlindRates(html, result.score);
    writeBlindSizes(html, result.score);
    writeBlindConfusion(html, result.score.confusion);
    writeBlindEffects(html, result.score);
    writeBlindShrink(html, result.score);
    writeBlindMethod(html, options.unloaded);
  }
  return html.bytes();
}

namespace {

std::string counted(const numerics::Rate& rate) {
  return rate.trials > 0 ? fmt::format("{} / {}", rate.hits, rate.trials) : "–";
}

std::string share(const numerics::Rate& rate) { return rate.trials > 0 ? reports::percent(rate.value(), 0) : "–"; }

std::string interval(const numerics::Rate& rate) {
  return rate.trials > 0 ? fmt::format("{} to {}", reports::percent(rate.low, 0), reports::percent(rate.high, 0)) : "–";
}

reports::Row rateRow(const std::string& words, const numerics::Rate& rate) {
  return {words, counted(rate), share(rate), interval(rate)};
}

reports::Table effectTable(const char* caption, const std::vector<validation::EffectScore>& effects) {
  reports::Table table{caption,
                       {"effect", "right", "size 2 and more", "size 5 and more", "said none", "members of the class"},
                       {{"", {}}}};
  for (const validation::EffectScore& one : effects) {
    if (one.all.trials == 0) continue;
    table.groups[0].rows.push_back({one.id, counted(one.all), counted(one.from_2), counted(one.from_5),
                                    std::to_string(one.answered_none),
                                    one.mean_class_size > 0.0 ? reports::fixed(one.mean_class_size, 1) : "–"});
  }
  return table;
}

}  // namespace

void writeBlindRates(Html& html, const validation::Score& score) {
  html.leaf("h2", "Rates");
  reports::Table table{
      "With exact 95 % intervals (Clopper and Pearson)", {"", "cases", "share", "interval"}, {{"", {}}}};
  for (const validation::NamedRate& one : score.rates)
    table.groups[0].rows.push_back(rateRow(reports::words(one.meaning), one.rate));
  writeTable(html, table);
}

void writeBlindSizes(Html& html, const validation::Score& score) {
  html.leaf("h2", "Accuracy against size");
  html.paragraph("One effect on the machine, named with nothing else beside it.");
  reports::Table table{"By size in noises", {"size", "right", "share", "interval"}, {{"", {}}}};
  for (const validation::SizeClass& one : score.by_size)
    table.groups[0].rows.push_back(rateRow(reports::sizeWords(one), one.rate));
  writeTable(html, table);
}

void writeBlindEffects(Html& html, const validation::Score& score) {
  html.leaf("h2", "Effect by effect");
  writeTable(html, effectTable("Singles answered right", score.effects));
  writeTable(html, effectTable("Outside the vocabulary: unknown, and nothing else, was said", score.outside));
  if (!score.as_is.empty()) writeTable(html, effectTable("Machines as they are: the effect was named", score.as_is));
}

void writeBlindShrink(Html& html, const validation::Score& score) {
  html.leaf("h2", "The promised shrink against the true one");
  if (score.shrinks.empty()) {
    html.paragraph("No single effect whose shrink is promised was answered right with a promise.");
    return;
  }
  html.paragraph(
      "Singles answered right whose effect shows where a shrink is promised: in the deflection, on days without a load "
      "in "
      "the positions. The true shrink is known from the machine without the effect: once without noise, once with the "
      "tracker's noise before and after, as a campaign can see "
      "it.");
  reports::Table table{
      "", {"case", "effect", "promised", "interval", "true, seen", "true, noise-free", "held"}, {{"", {}}}};
  for (const validation::ShrinkPair& one : score.shrinks) {
    const bool held = one.low <= one.truth_seen && one.truth_seen <= one.high;
    table.groups[0].rows.push_back(
        {one.name, one.effect, reports::percent(one.promised, 0),
         fmt::format("{} to {}", reports::percent(one.low, 0), reports::percent(one.high, 0)),
         reports::percent(one.truth_seen, 0), reports::percent(one.truth, 0), held ? "yes" : "no"});
  }
  writeTable(html, table);
}

namespace {

void writeUnloadedMethod(Html& html) {
  html.list(
      {"Every machine is one of four catalogue sizes with link lengths changed by up to 10 %, axes some tenths of a mm "
       "and "
       "hundredths of a degree from its URDF, and a day of 60 to 200 postures: one or three reflectors, two or three "
       "repeats, mostly floor nests, nothing hung.",
       "The simulator seeks an equilibrium of springs, gaps and weights; it shares no formula with the calibration or "
       "the "
       "diagnosis.",
       "Size: the difference that the effect makes to the positions at the joint angles as reported, less what a "
       "calibration of the rigid arm takes in (24 numbers of the axes, the robot's place, the reflectors'), rms per "
       "coordinate, in units of the declared noise of one position. Of a kinematic error, which a calibration takes in "
       "whole: what the URDF misses the more, in units of what it misses of every machine.",
       "A gravity compensator shows through the compliance of its joint: naming that as well counts neither for nor "
       "against.",
       "A class of effects that cannot be told apart counts as right when the true one is a member; how many members "
       "it "
       "had is in the tables."});
}

}  // namespace

void writeBlindMethod(Html& html, bool unloaded) {
  html.leaf("h2", "How it was done");
  if (unloaded) return writeUnloadedMethod(html);
  html.list(
      {"Every machine is one of four catalogue sizes with link lengths changed by up to 10 %, measured "
       "through a day: "
       "circle sweeps, a wrist sweep, 24 postures with three loads and a return to zero, three reflectors, "
       "three "
       "repeats, floor nests.",
       "The simulator seeks an equilibrium of springs, gaps, sliders and weights; it shares no formula with "
       "the "
       "diagnosis.",
       "Size of what shows in the deflection: the difference that the effect makes to the displacements, "
       "less a refit of "
       "the six joint compliances, in units of the declared noise of one state's displacement.",
       "Size of what shows in absolute positions (frames, kinematics, gravity compensator): the difference "
       "of unloaded "
       "positions, less a rigid motion and the reflectors' places, in units of the noise of one state's "
       "position and, "
       "where the nests do not see it, of the machine's own departures from nominal.",
       "Machines as they are have bearings and links that give, every second one also a base and friction, each at "
       "half its usual size. An answer is right when it names at least one of these effects and none that is not "
       "there; unknown beside it says that more is left.",
       "A class of effects that cannot be told apart counts as right when the true one is a member; how many "
       "members "
       "it had is in the tables."});
}

}  // namespace stiffscope::page
