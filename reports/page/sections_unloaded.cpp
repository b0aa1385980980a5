#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "core/calibration/position_errors.h"
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

using calibration::CalibratedModel;

/// What the models leave in each quarter of the day, rms per coordinate.
reports::Table quartersTable(const calibration::Calibration& calibration) {
  const std::vector<calibration::ReadingError> errors = calibration::readingErrors(calibration);
  const bool effects = !calibration.best().fit.parts.empty();
  reports::Table table{fmt::format("Left over the day, by {}, rms per coordinate",
                                   calibration.day.times_known ? "time" : "the order of the postures"),
                       {"Quarter of the day", "Readings", "Calibrated (µm)"},
                       {{}},
                       false,
                       "over-the-day"};
  if (effects) table.columns.emplace_back("With effects (µm)");
  constexpr int kQuarters = 4;
  for (int quarter = 0; quarter < kQuarters; ++quarter) {
    double geometry = 0.0, best = 0.0;
    int readings = 0;
    for (const calibration::ReadingError& error : errors) {
      const double time = calibration.day.postures[error.posture].time;
      if (std::min(kQuarters - 1, static_cast<int>(kQuarters * time)) != quarter) continue;
      geometry += error.of(CalibratedModel::geometry).squaredNorm();
      best += error.of(CalibratedModel::effects).squaredNorm();
      ++readings;
    }
    if (readings == 0) continue;
    const auto rms = [readings](double sum) { return inUm(std::sqrt(sum / (3.0 * readings))); };
    reports::Row row{fmt::format("{}", quarter + 1), fmt::format("{}", readings), rms(geometry)};
    if (effects) row.emplace_back(rms(best));
    table.groups.front().rows.push_back(std::move(row));
  }
  return table;
}

/// Angles and lengths in millionths, as the page has them elsewhere.
extended_model::EffectParameter inMillionths(const calibration::EffectTerm& term, double value, double sd) {
  constexpr double kMillionth = 1e-6;
  for (const char* unit : {"rad", "m", "rad/rad", "m/m"}) {
    if (term.unit == unit) return {term.name, "µ" + term.unit, value / kMillionth, sd / kMillionth};
  }
  return {term.name, term.unit, value, sd};
}

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
    if (!parameters.empty()) table.groups.push_back(parameterGroup(reports::partName(part), parameters));
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
  if (const std::string figures = reports::accuracyFigures(accuracy); !figures.empty()) html.paragraph(figures);
  const std::vector<std::string> reasons = reports::words(accuracy.reasons);
  if (!reasons.empty()) html.paragraph(reports::withMicro(fmt::format("{}", fmt::join(reasons, " "))), "faint");
  // Without shrinks the classes say no more than the effects' own table.
  const bool weighed = std::any_of(accuracy.classes.begin(), accuracy.classes.end(),
                                   [](const auto& one) { return one.score != 0.0 || one.shrink.value != 0.0; });
  if (weighed) writeTable(html, classesTable(accuracy.classes, &fallOf));
  writeTable(html, effectsTable(accuracy.calibration.best().fit));
  writeTable(html, whereTable("Where the gap lies that the calibrated geometry leaves, rms per coordinate",
                              "Position (µm)", accuracy.where, accuracy.where_after, "With the verdict (µm)"));
  writeOverlaps(html, accuracy.where);
  writeNotTestable(html, accuracy.not_testable);
  writeDetectable(html, accuracy.detectable);
}

}  // namespace

bool hasStation(const reports::ReportCampaign& one) {
  return one.accuracy != nullptr && (one.preparation != nullptr || isCalibrated(one));
}

void writeStation(Html& html, const reports::ReportContent& content) {
  const auto write = [&](const reports::ReportCampaign& one) {
    if (one.preparation != nullptr) {
      html.paragraph(fmt::format("Readings: {}.", reports::withMicro(reports::preparationWords(*one.preparation))));
    }
    if (isCalibrated(one)) writeTable(html, quartersTable(one.accuracy->calibration));
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
