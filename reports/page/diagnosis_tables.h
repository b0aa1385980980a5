#pragma once

#include <string>
#include <vector>

#include "core/diagnosis/diagnosis.h"
#include "core/extended_model/extended_model.h"
#include "core/io/units.h"
#include "reports/page/html.h"
#include "reports/words/effect_words.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/unloaded_effect_words.h"

// Tables that diagnoses of loaded and of unloaded days have in common.

namespace stiffscope::page {

std::string inUm(double metres);
std::string lengthIn(double metres, const reports::LengthUnit& unit);  ///< without the unit's name
std::string shareOf(double shrink,
                    int decimals);              ///< in percent; a gap that more than doubles has no size worth reading
int placesOf(const diagnosis::Shrink& shrink);  ///< decimals of its percents, by which the interval's ends differ
std::string interval(const diagnosis::Shrink& shrink);

/// By what the verdict names a class whose shrink held out may be nothing; empty where the shrink shows it.
std::string whyNamed(const diagnosis::EffectClass& one);
std::string whyNamed(const accuracy::AccuracyClass& one);

/// The verdict's classes first, then the other candidates. `fall_of` a class: the cell for its fall of BIC.
template <class Class>
reports::Table classesTable(const std::vector<Class>& classes, std::string (*fall_of)(const Class&)) {
  reports::Table table{"Which effect: the verdict's first, then the other candidates, best first",
                       {"Effect", "In the verdict", "Fall of BIC", "Shrink held out (%)", "95 % (%)", "Explained (%)"},
                       {{}},
                       false,
                       "diagnosis"};
  reports::DataTable& data = table.data.emplace();
  data.columns = {"effects",
                  "detail",
                  "in_verdict",
                  "score",
                  "shrink_percent",
                  "shrink_low_percent",
                  "shrink_high_percent",
                  "explained_percent"};
  for (const Class& one : classes) {
    data.rows.push_back({reports::effectNames(one.effects), reports::shortDetail(one.detail),
                         one.in_verdict ? 1.0 : 0.0, one.score, 100.0 * one.shrink.value, 100.0 * one.shrink.low,
                         100.0 * one.shrink.high, 100.0 * one.explained});
    table.groups.front().rows.push_back(
        {reports::Cell(reports::effectNames(one.effects), reports::asIs(reports::shortDetail(one.detail))),
         reports::Cell(one.in_verdict ? "yes" : "no", whyNamed(one)), fall_of(one), shareOf(one.shrink.value, 1),
         interval(one.shrink), shareOf(one.explained, 0)});
  }
  return table;
}

/// The same parts of another quantity, or after a change.
struct WhereBeside {
  const std::vector<diagnosis::WhereTable>& tables;
  std::string heading;
  bool noise = true;  ///< has a noise of its own
};

/// By joint, reflector, part of the day and so on; postures have a figure.
reports::Table whereTable(const std::string& caption, const std::string& heading,
                          const std::vector<diagnosis::WhereTable>& where, const WhereBeside& beside);

/// What tables whose parts overlap add up to.
void writeOverlaps(Html& html, const std::vector<diagnosis::WhereTable>& where);

template <class Detectable>
reports::Table detectableTable(const std::vector<Detectable>& detectable) {
  reports::Table table{"Smallest size that would have been seen, rms per coordinate",
                       {"Effect", "Size (µm)"},
                       {{}},
                       false,
                       "diagnosis-detectable"};
  for (const Detectable& one : detectable) {
    if (one.size) table.groups.front().rows.push_back({reports::effectName(one.effect), inUm(*one.size)});
  }
  return table;
}

/// Folded, since a figure has these numbers, too; nothing where there is none.
template <class Detectable>
void writeDetectable(Html& html, const std::vector<Detectable>& detectable) {
  const reports::Table table = detectableTable(detectable);
  if (table.groups.front().rows.empty()) return;
  const auto fold = html.element("details");
  html.leaf("summary", "The smallest sizes as a table");
  writeTable(html, table);
}

template <class Untestable>
void writeNotTestable(Html& html, const std::vector<Untestable>& not_testable) {
  if (not_testable.empty()) return;
  html.paragraph("Not testable with this data:");
  std::vector<std::string> missing;
  for (const Untestable& one : not_testable)
    missing.push_back(
        fmt::format("{}: {}.", reports::effectName(one.effect), reports::withMicro(reports::words(one.missing))));
  html.list(missing);
}

/// Effect, parameter, value ± U, unit: a group an effect. Sizes of one unit have one power of ten; of its file none.
reports::Table effectParametersTable(const std::string& caption);
/// Adds the parameters of an effect to it.
void addParameters(const std::string& effect, const std::vector<extended_model::EffectParameter>& parameters,
                   reports::Table& table);

}  // namespace stiffscope::page
