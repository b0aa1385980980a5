#include "core/accuracy/accuracy_diagnosis.h"

#include <fmt/format.h>
#include <algorithm>
#include <iterator>
#include <string>

#include "core/campaign/campaign.h"
#include "core/io/units.h"
#include "reports/text/gap_text.h"
#include "reports/text/text.h"
#include "reports/words/accuracy_words.h"
#include "reports/words/calibration_words.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/unloaded_effect_words.h"

namespace stiffscope::reports {

namespace {

using accuracy::AccuracyDiagnosis;
using Out = std::back_insert_iterator<std::string>;

std::string verdictLine(const AccuracyDiagnosis& accuracy) {
  const std::string not_asked = accuracy.effects_asked
                                    ? std::string()
                                    : fmt::format(" (effects were not asked for: {} postures, which takes {})",
                                                  accuracy.postures, calibration::kFewestForEffects);
  if (accuracy.verdict.empty()) return "none" + not_asked;
  std::string line;
  for (const accuracy::AccuracyEntry& entry : accuracy.verdict) {
    line += line.empty() ? "" : ", and ";
    line += entry.effects.empty() ? "unknown" + not_asked : effectNames(entry.effects);
    if (!entry.detail.empty()) line += " (" + entry.detail + ")";
  }
  return line;
}

void writeTerms(const accuracy::AccuracyClass& one, Out out) {
  constexpr std::size_t kMostTerms = 8;
  std::size_t k = 0, all = one.sizes.size();
  for (const calibration::EffectPart& part : one.parts) {
    for (const calibration::EffectTerm& term : part.terms) {
      if (k < kMostTerms)
        fmt::format_to(out, "      {:<40}{:>12.4g} +- {:.2g} {}\n", term.name, one.sizes[k], expanded(one.sds[k]),
                       term.unit);
      ++k;
    }
  }
  if (all > kMostTerms) fmt::format_to(out, "      and {} more in the JSON\n", all - kMostTerms);
}

void writeClasses(const AccuracyDiagnosis& accuracy, Out out) {
  if (accuracy.classes.empty()) return;
  fmt::format_to(
      out, "\nWhich: candidates (* in the verdict), what each takes off the gap on postures held out; +- U, 95 %\n");
  fmt::format_to(out, "  {:<2}{:<44}{:>12}{:>9}  {:<17}{:>10}\n", "", "effect", "score", "shrink", "95 %", "explained");
  for (const accuracy::AccuracyClass& one : accuracy.classes) {
    fmt::format_to(out, "  {:<2}{:<44}{:>12.0f}{:>9.3f}  {:<17}{:>10.3f}\n", one.in_verdict ? "*" : "",
                   effectNames(one.effects), unsignedZero(one.score, 0), unsignedZero(one.shrink.value, 3),
                   shrinkInterval(one.shrink), unsignedZero(one.explained, 3));
    if (!one.detail.empty()) fmt::format_to(out, "    {}\n", wrapped(one.detail, 4));
    writeTerms(one, out);
  }
}

void writeLimits(const AccuracyDiagnosis& accuracy, Out out) {
  if (!accuracy.effects_asked) {
    fmt::format_to(out, "\nSmallest size that would have been seen: none, no effect was asked for\n");
    return;
  }
  fmt::format_to(out, "\nSmallest size that would have been seen, µm rms per coordinate:\n");
  std::string sizes;
  for (const accuracy::DetectableEffect& one : accuracy.detectable) {
    if (one.size) sizes += fmt::format("{}{} {:.1f}", sizes.empty() ? "" : ", ", effectName(one.effect), um(*one.size));
  }
  fmt::format_to(out, "  {}\n", wrapped(sizes, 2));
  for (const accuracy::UntestableEffect& one : accuracy.not_testable)
    fmt::format_to(out, "  {}\n",
                   wrapped(fmt::format("{} not testable here: {}", effectName(one.effect), words(one.missing)), 4));
}

}  // namespace

std::string accuracyText(const campaign::Campaign& campaign, const AccuracyDiagnosis& accuracy) {
  std::string text;
  Out out(text);
  if (!accuracy.usable) {
    fmt::format_to(out, "{}: no diagnosis: {}\n", campaign.name, words(accuracy.unusable_reason));
    return text;
  }
  fmt::format_to(out, "{}: unloaded positions of {} postures, {} readings\n\nVerdict: {}\n", campaign.name,
                 accuracy.postures, accuracy.readings, wrapped(verdictLine(accuracy), 9));
  for (const std::string& sentence : words(accuracy.reasons)) fmt::format_to(out, "  {}\n", wrapped(sentence, 2));
  if (accuracy.as_read) fmt::format_to(out, "  {}\n", wrapped(asReadWords(), 2));
  if (std::isnan(accuracy.gap.before)) {
    fmt::format_to(out, "\nHow far: too few postures to hold any out; noise of the readings {:.1f} µm\n",
                   um(accuracy.gap.noise));
  } else {
    fmt::format_to(
        out,
        "\nHow far: gap of the positions, µm rms per coordinate, held out\n  as the URDF has the arm{:>13.1f}\n"
        "  geometry calibrated{:>18.1f}\n  with effects{:>25.1f}  (shrinks by {:.3f}, 95 %: {})\n"
        "  noise of the readings{:>16.1f}\n",
        um(accuracy.gap.nominal), um(accuracy.gap.before), um(accuracy.gap.after),
        unsignedZero(accuracy.shrink_together.value, 3), shrinkInterval(accuracy.shrink_together),
        um(accuracy.gap.noise));
  }
  if (!onlyVerdictFitted(accuracy)) {
    fmt::format_to(out, "  {}\n",
                   wrapped(fmt::format("effects in the model, also those that the verdict does not name: {}",
                                       fittedNames(accuracy)),
                           4));
  }
  if (accuracy.calibration.angles)
    fmt::format_to(out, "  {}\n",
                   wrapped(angleWords(*accuracy.calibration.angles, accuracy.calibration.day.angles), 4));
  writeClasses(accuracy, out);
  text += whereText(accuracy.where, "Where the gap lies that the calibrated geometry leaves");
  writeLimits(accuracy, out);
  if (!accuracy.next.empty()) fmt::format_to(out, "\nNext:\n");
  for (const std::string& sentence : words(accuracy.next)) fmt::format_to(out, "  {}\n", wrapped(sentence, 2));
  return text;
}

}  // namespace stiffscope::reports
