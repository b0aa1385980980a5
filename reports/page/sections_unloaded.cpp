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

constexpr std::size_t kMostParts = 12;  // of an effect: of a gear's orders there can be dozens

/// A part of the fit with the sizes of its terms; refused ones are left out.
struct FittedPart {
  const calibration::EffectPart* part = nullptr;
  std::vector<extended_model::EffectParameter> parameters;
  double size = 0.0;          ///< of its terms together: parts of one effect are compared by it
  bool beyond_doubt = false;  ///< one of its terms at least is larger than its U
};

std::vector<FittedPart> partsOf(const calibration::ArmFit& fit) {
  std::vector<FittedPart> parts;
  std::size_t k = 0;
  for (const calibration::EffectPart& part : fit.parts) {
    FittedPart one{&part, {}};
    for (const calibration::EffectTerm& term : part.terms) {
      const double value = fit.sizes[static_cast<Eigen::Index>(k)];
      const double sd = fit.sd(static_cast<int>(fit.steps.size()) + static_cast<int>(k));
      if (!fit.refused[k++]) {
        one.parameters.push_back(inMillionths(term, value, sd));
        one.size = std::hypot(one.size, value);
        one.beyond_doubt = one.beyond_doubt || std::abs(value) > reports::expanded(sd);
      }
    }
    if (!one.parameters.empty()) parts.push_back(std::move(one));
  }
  return parts;
}

/// Its file has all parts as they were found; the page of each effect those that stand out of their uncertainty, the
/// largest first. `left_out`: how many it has not.
reports::Table effectsTable(const calibration::ArmFit& fit, std::size_t& left_out) {
  const std::vector<FittedPart> parts = partsOf(fit);
  const char* caption =
      "Effects beside the geometry in the order in which they were found, of each what is larger than "
      "its U, the largest first";
  reports::Table all = effectParametersTable(caption), shown = effectParametersTable(caption);
  left_out = parts.size();
  std::vector<calibration::UnloadedEffect> done;
  for (const FittedPart& one : parts) {
    addParameters(reports::partName(*one.part), one.parameters, all);
    const calibration::UnloadedEffect effect = one.part->effect;
    if (std::find(done.begin(), done.end(), effect) != done.end()) continue;
    done.push_back(effect);
    std::vector<const FittedPart*> own;
    for (const FittedPart& other : parts)
      if (other.part->effect == effect) own.push_back(&other);
    std::stable_sort(own.begin(), own.end(),
                     [](const FittedPart* a, const FittedPart* b) { return a->size > b->size; });
    // Of an effect that is found by all of its parts together the largest stands for it.
    const FittedPart* largest = own.front();
    std::erase_if(own, [](const FittedPart* part) { return !part->beyond_doubt; });
    if (own.empty()) own.push_back(largest);
    own.resize(std::min(own.size(), kMostParts));
    for (const FittedPart* part : own) addParameters(reports::partName(*part->part), part->parameters, shown);
    left_out -= own.size();
  }
  shown.data = std::move(all.data);
  return shown;
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
  std::size_t left_out = 0;
  writeTable(html, effectsTable(fit, left_out));
  if (left_out > 0) html.paragraph(reports::morePartsWords(left_out), "faint");
  writeTable(
      html, whereTable("Where the gap lies that the calibrated geometry leaves, rms per coordinate", "Position",
                       accuracy.where,
                       {accuracy.where_after,
                        reports::onlyVerdictFitted(accuracy) ? "With the verdict" : "With all effects fitted", false}));
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
