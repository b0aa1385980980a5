#include "reports/page/blind_sections.h"

#include <fmt/format.h>

#include "reports/page/html_table.h"
#include "reports/page/numbers.h"

namespace stiffscope::page {

namespace {

using namespace blind;

std::string counted(const Rate& rate) {
  return rate.trials > 0 ? fmt::format("{} / {}", rate.hits, rate.trials) : "–";
}

std::string share(const Rate& rate) { return rate.trials > 0 ? percent(rate.value(), 0) : "–"; }

std::string interval(const Rate& rate) {
  return rate.trials > 0 ? fmt::format("{} to {}", percent(rate.low, 0), percent(rate.high, 0)) : "–";
}

Row rateRow(const std::string& words, const Rate& rate) {
  return {words, counted(rate), share(rate), interval(rate)};
}

Table effectTable(const char* caption, const std::vector<EffectScore>& effects) {
  Table table{caption,
              {"effect", "right", "size 2 and more", "size 5 and more", "said none", "members of the class"},
              {{"", {}}}};
  for (const EffectScore& one : effects) {
    if (one.all.trials == 0) continue;
    table.groups[0].rows.push_back({one.id, counted(one.all), counted(one.from_2), counted(one.from_5),
                                    std::to_string(one.answered_none),
                                    one.mean_class_size > 0.0 ? fixed(one.mean_class_size, 1) : "–"});
  }
  return table;
}

}  // namespace

void writeBlindRates(Html& html, const Score& score) {
  html.leaf("h2", "Rates");
  Table table{
      "With exact 95 % intervals (Clopper and Pearson)", {"", "cases", "share", "interval"}, {{"", {}}}};
  for (const NamedRate& one : score.rates) table.groups[0].rows.push_back(rateRow(one.meaning, one.rate));
  writeTable(html, table);
}

void writeBlindSizes(Html& html, const Score& score) {
  html.leaf("h2", "Accuracy against size");
  html.paragraph("One effect on the machine, named with nothing else beside it.");
  Table table{"By size in noises", {"size", "right", "share", "interval"}, {{"", {}}}};
  for (const auto& [name, rate] : score.by_size) table.groups[0].rows.push_back(rateRow(name, rate));
  writeTable(html, table);
}

void writeBlindEffects(Html& html, const Score& score) {
  html.leaf("h2", "Effect by effect");
  writeTable(html, effectTable("Singles answered right", score.effects));
  writeTable(html, effectTable("Outside the vocabulary: unknown, and nothing else, was said", score.outside));
}

void writeBlindShrink(Html& html, const Score& score) {
  html.leaf("h2", "The promised shrink against the true one");
  if (score.shrinks.empty()) {
    html.paragraph("No single effect that shows in the deflection was answered right with a promise.");
    return;
  }
  html.paragraph(
      "Singles answered right whose effect shows in the deflection. The true shrink is known from the "
      "machine without the "
      "effect: once without noise, once with the tracker's noise before and after, as a campaign can see "
      "it.");
  Table table{
      "", {"case", "effect", "promised", "interval", "true, seen", "true, noise-free", "held"}, {{"", {}}}};
  for (const ShrinkPair& one : score.shrinks) {
    const bool held = one.low <= one.truth_seen && one.truth_seen <= one.high;
    table.groups[0].rows.push_back({one.name, one.effect, percent(one.promised, 0),
                                    fmt::format("{} to {}", percent(one.low, 0), percent(one.high, 0)),
                                    percent(one.truth_seen, 0), percent(one.truth, 0), held ? "yes" : "no"});
  }
  writeTable(html, table);
}

void writeBlindMethod(Html& html) {
  html.leaf("h2", "How it was done");
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
       "A class of effects that cannot be told apart counts as right when the true one is a member; how many "
       "members "
       "it had is in the tables."});
}

}  // namespace stiffscope::page
