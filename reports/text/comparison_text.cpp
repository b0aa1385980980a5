#include "core/comparison/compare.h"
#include "reports/text/text.h"

#include <fmt/format.h>
#include <cmath>
#include <iterator>

#include "core/io/units.h"
#include "reports/words/listed.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

using Out = std::back_insert_iterator<std::string>;

/// A value and its expanded uncertainty.
std::string withU(const comparison::Uncertain& number, double times, int decimals) {
  if (!std::isfinite(number.value)) return "-";
  const double expanded = times * number.expanded();
  return fmt::format("{:.{}f} +-{}", unsignedZero(times * number.value, decimals), decimals,
                     std::isfinite(expanded) ? fmt::format("{:.{}f}", expanded, decimals) : "?");
}

std::string pText(double p) {
  if (!std::isfinite(p)) return "-";
  return p < 1e-4 ? "< 0.0001" : fmt::format("{:.4f}", p);
}

constexpr double kMicroradian = 1e-6;

void writeDifferences(const comparison::StiffnessChange& change, Out out) {
  fmt::format_to(out, "  {:<4}{:>26}{:>11}{:>11}{:>20}{:>20}\n", "", "difference (µrad/Nm)", "p", "Holm",
                 "taken away, %", "of deflection, %");
  for (std::size_t j = 0; j < change.joints.size(); ++j) {
    const comparison::JointChange& joint = change.joints[j];
    if (!joint.comparable) {
      fmt::format_to(out, "  {}\n", wrapped(fmt::format("c{}  {}", j + 1, words(joint.reason)), 6));
      continue;
    }
    fmt::format_to(out, "  c{:<3}{:>26}{:>11}{:>11}{:>20}{:>20}\n", j + 1,
                   withU(joint.difference, 1.0 / kMicroradian, 4), pText(joint.p_value), pText(joint.p_holm),
                   withU(joint.taken, 100.0, 2), withU(joint.avoided, 100.0, 2));
    if (!joint.gear) continue;
    fmt::format_to(out, "      gear by its encoders {}: {} the difference, p {}\n",
                   withU(joint.gear->compliance, 1.0 / kMicroradian, 4),
                   joint.gear->p_value < 0.05 ? "disagrees with" : "agrees with", pText(joint.gear->p_value));
  }
}

void writeStiffnesses(const comparison::StiffnessChange& change, bool ratios_hold, Out out) {
  std::vector<double> stiffnesses;
  for (const comparison::JointChange& joint : change.joints) {
    if (joint.comparable) stiffnesses.insert(stiffnesses.end(), {joint.before.value, joint.after.value});
  }
  const StiffnessUnit unit = stiffnessUnit(stiffnesses);
  fmt::format_to(out, "  {:<4}{:>22}{:>22}{:>24}{:>8}\n", "", fmt::format("before ({})", unit.text),
                 fmt::format("after ({})", unit.text), "ratio", "corr.");
  for (std::size_t j = 0; j < change.joints.size(); ++j) {
    const comparison::JointChange& joint = change.joints[j];
    if (!joint.comparable) continue;
    const std::string ratio = withU(joint.ratio, 1.0, 4);
    fmt::format_to(out, "  k{:<3}{:>22}{:>22}{:>24}{:>8.2f}{}\n", j + 1, withU(joint.before, 1.0 / unit.size, 4),
                   withU(joint.after, 1.0 / unit.size, 4), ratios_hold ? ratio : "(" + ratio + ")", joint.correlation,
                   joint.mark.empty() ? "" : "  " + words(joint.mark));
  }
}

void writeMethod(const comparison::StiffnessChange& change, identification::Method method, bool ratios_hold, Out out) {
  if (!change.available) {
    fmt::format_to(out, "\n{}\n",
                   wrapped(fmt::format("{}: not comparable: {}", namesOf(method).full, words(change.reason)), 2));
    return;
  }
  const std::string from = change.same_postures ? fmt::format("the {} postures of both", change.postures)
                           : change.by_models   ? std::string("each day's own model")
                                                : std::string("all postures of each");
  fmt::format_to(out, "\n{}: compliance after - before from {}, +- U (95 %)\n", namesOf(method).full, from);
  writeDifferences(change, out);
  writeStiffnesses(change, ratios_hold, out);
}

/// What the columns mean, once for all methods.
void writeLegend(const comparison::Comparison& comparison, Out out) {
  const comparison::CommonResidual& left = comparison.residual;
  std::string text =
      "p: probability of a difference as large without any change; Holm: the same corrected for the joints tested. "
      "Taken "
      "away: share of the compliance before that is gone. Of deflection: share of the deflection at the reflectors "
      "that "
      "this avoids. corr.: of the scatter errors of before and after, by the postures measured in both; a difference "
      "counts it.";
  fmt::format_to(out, "\n  {}\n", wrapped(text, 2));
  if (!left.available) return;
  const auto micrometres = [](double value) { return value / io::kMicrometre; };
  text = fmt::format("Joint springs leave {:.1f} µm per coordinate before and {:.1f} µm after",
                     micrometres(left.before), micrometres(left.after));
  if (left.noise_before && left.noise_after) {
    text += fmt::format(" (noise of the tracker: {:.1f} and {:.1f} µm)", micrometres(*left.noise_before),
                        micrometres(*left.noise_after));
  }
  if (std::isfinite(left.of_difference)) {
    text += fmt::format(", {:.1f} µm of the difference", micrometres(left.of_difference));
  }
  text += left.isNoise() ? ". It is noise, as far as it shows: ratios of stiffnesses hold."
          : comparison.models_hold
              ? ". It is more than noise: differences of compliances on the same postures are by springs alone, where "
                "what both states miss cancels; stiffnesses and ratios are of each day's own model, with the effects "
                "that it shows."
              : ". It is more than noise, or not known to be noise: the stiffnesses are apparent ones, and "
                "ratios (in brackets) and shares of the compliance before keep the bias of both. The "
                "difference of compliances does not, as far as both states miss the same.";
  fmt::format_to(out, "  {}\n", wrapped(text, 2));
}

void writeShare(const comparison::DeflectionAvoided& avoided, const char* place, Out out) {
  if (!avoided.available) {
    fmt::format_to(out, "\n{}\n",
                   wrapped(fmt::format("Deflection avoided at {}: {}", place, words(avoided.reason)), 2));
    return;
  }
  fmt::format_to(out, "\nDeflection avoided at {}: {:.1f} %", place, 100.0 * avoided.share);
  if (std::isfinite(avoided.low)) {
    fmt::format_to(out, " (95 % interval over postures {:.1f} to {:.1f} %)", 100.0 * avoided.low, 100.0 * avoided.high);
  }
  fmt::format_to(out, ", {} postures\n", avoided.postures.size());
}

void writePostures(const comparison::DeflectionAvoided& avoided, const char* place, Out out) {
  fmt::format_to(out, "\nThe deflection at {}, posture by posture\n  {:<12}{:>14}{:>14}{:>12}\n", place, "pose",
                 "before (µm)", "after (µm)", "avoided, %");
  const auto row = [](const comparison::PostureDeflection& one) {
    return fmt::format("{:<12}{:>14.1f}{:>14.1f}{:>12.1f}", one.pose, one.before / io::kMicrometre,
                       one.after / io::kMicrometre, 100.0 * one.share());
  };
  for (const std::string& line : listed(avoided.postures, row, kListedInJson, kMostRows))
    fmt::format_to(out, "  {}\n", line);
}

}  // namespace

std::string comparisonText(const campaign::Campaign& before, const campaign::Campaign& after,
                           const comparison::Comparison& comparison) {
  std::string text;
  Out out(text);
  fmt::format_to(out, "before: {}\nafter:  {}\n", before.name, after.name);
  if (!comparison.comparable) {
    fmt::format_to(out, "\n{}\n", wrapped("Nothing is comparable: " + words(comparison.reason), 2));
  }
  for (const std::string& caution : words(comparison.cautions))
    fmt::format_to(out, "  {}\n", wrapped("caution: " + caution, 4));
  if (comparison.comparable) {
    if (comparison.shown_first)
      fmt::format_to(out, "\n{}\n",
                     wrapped(fmt::format("Shown first: {}, by joint springs alone, as both days are compared.",
                                         words(comparison.shown_first->reason)),
                             2));
    const identification::Method first = comparison.best();
    writeMethod(comparison.of(first), first, comparison.ratiosHold(), out);
    for (const identification::Method method : identification::kMethods) {
      if (method != first) writeMethod(comparison.of(method), method, comparison.ratiosHold(), out);
    }
    writeLegend(comparison, out);
    if (comparison.judgedAtWrist()) writeShare(comparison.at_wrist, "P_wrist", out);
    writeShare(comparison.at_targets, "the reflectors", out);
    if (comparison.avoided().available)
      writePostures(comparison.avoided(), comparison.judgedAtWrist() ? "P_wrist" : "the reflectors", out);
  }
  const auto line = [](const comparison::UnmatchedPosture& one) {
    return fmt::format("not compared: pose {}: {}", one.pose, words(one.reason));
  };
  for (const std::string& entry : listed(comparison.matched.unmatched, line, kListedInJson))
    fmt::format_to(out, "  {}\n", wrapped(entry, 4));
  return text;
}

}  // namespace stiffscope::reports
