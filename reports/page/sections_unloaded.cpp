#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "reports/page/diagnosis_tables.h"
#include "reports/page/html.h"
#include "reports/page/sections.h"
#include "reports/words/accuracy_words.h"
#include "reports/words/calibration_words.h"
#include "reports/words/numbers.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::page {

namespace {

/// Angles and lengths in millionths, as the page has them elsewhere.
extended_model::EffectParameter inMillionths(const calibration::EffectTerm& term, double value, double sd) {
  constexpr double kMillionth = 1e-6;
  for (const char* unit : {"rad", "m", "rad/rad", "m/m"}) {
    if (term.unit == unit) return {term.name, "µ" + term.unit, value / kMillionth, sd / kMillionth};
  }
  return {term.name, term.unit, value, sd};
}

constexpr std::size_t kMostParts = 12;  // of a gear's orders there can be dozens

reports::Table effectsTable(const calibration::ArmFit& fit) {
  reports::Table table = effectParametersTable("Effects beside the geometry, in the order in which they were found");
  std::size_t k = 0;
  for (const calibration::EffectPart& part : fit.parts) {
    std::vector<extended_model::EffectParameter> parameters;
    for (const calibration::EffectTerm& term : part.terms) {
      const int at = static_cast<int>(fit.steps.size()) + static_cast<int>(k);
      if (!fit.refused[k])
        parameters.push_back(inMillionths(term, fit.sizes[static_cast<Eigen::Index>(k)], fit.sd(at)));
      ++k;
    }
    if (!parameters.empty() && table.groups.size() < kMostParts)
      addParameters(reports::partName(part), parameters, table);
  }
  return table;
}

/// Of the own selection nothing is weighed: score and shrink are then not known.
std::string fallOf(const accuracy::AccuracyClass& one) {
  return one.score == 0.0 ? "–" : reports::significant(one.score, 3);
}

void writeCause(Html& html, const accuracy::AccuracyDiagnosis& accuracy) {
  if (!accuracy.usable) {
    html.paragraph(fmt::format("No diagnosis: {}.", reports::asIs(reports::words(accuracy.unusable_reason))));
    return;
  }
  html.paragraph(reports::asIs(reports::accuracyFinding(accuracy)), "finding");
  html.list(reports::accuracyMeanings(accuracy));
  if (accuracy.as_read) html.paragraph(reports::asReadWords());
  if (const std::string figures = reports::accuracyFigures(accuracy); !figures.empty()) html.paragraph(figures);
  const std::vector<std::string> reasons = reports::words(accuracy.reasons);
  if (!reasons.empty()) html.paragraph(reports::withMicro(fmt::format("{}", fmt::join(reasons, " "))), "faint");
  // Without shrinks the classes say no more than the effects' own table.
  const bool weighed = std::any_of(accuracy.classes.begin(), accuracy.classes.end(),
                                   [](const auto& one) { return one.score != 0.0 || one.shrink.value != 0.0; });
  if (weighed) writeTable(html, classesTable(accuracy.classes, &fallOf));
  const calibration::ArmFit& fit = accuracy.ofCause().best().fit;
  writeTable(html, effectsTable(fit));
  if (fit.parts.size() > kMostParts) html.paragraph(reports::morePartsWords(fit.parts.size() - kMostParts), "faint");
  writeTable(html, whereTable("Where the gap lies that the calibrated geometry leaves, rms per coordinate", "Position",
                              accuracy.where, {accuracy.where_after, "With the verdict", false}));
  writeOverlaps(html, accuracy.where);
  writeNotTestable(html, accuracy.not_testable);
  writeDetectable(html, accuracy.detectable);
}

}  // namespace

bool hasStation(const reports::ReportCampaign& one) { return one.accuracy != nullptr && one.preparation != nullptr; }

void writeStation(Html& html, const reports::ReportContent& content) {
  const auto write = [&](const reports::ReportCampaign& one) {
    html.paragraph(fmt::format("Readings: {}.", reports::withMicro(reports::preparationWords(*one.preparation))));
  };
  writeForEach(html, content, "station", "The station over the day", hasStation, write);
}

void writeAccuracyGap(Html& html, const reports::ReportContent& content) {
  const auto write = [&](const reports::ReportCampaign& one) { writeCause(html, *one.accuracy); };
  writeForEach(html, content, "accuracy-gap", "What the geometry misses", isCalibrated, write);
}

void writeNextSteps(Html& html, const reports::ReportContent& content) {
  const auto write = [&](const reports::ReportCampaign& one) { html.list(reports::accuracyActions(*one.accuracy)); };
  writeForEach(html, content, "next", "What to do next", hasActions, write);
}

bool hasActions(const reports::ReportCampaign& one) {
  return isCalibrated(one) && !reports::accuracyActions(*one.accuracy).empty();
}

}  // namespace stiffscope::page
