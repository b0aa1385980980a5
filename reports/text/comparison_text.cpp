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

std::string withSd(double value, double sd) {
  return fmt::format("{:.4f} +-{}", value, std::isfinite(sd) ? fmt::format("{:.4f}", sd) : "?");
}

std::string pText(double p) {
  if (!std::isfinite(p)) return "-";
  return p < 1e-4 ? "< 0.0001" : fmt::format("{:.4f}", p);
}

void writeMethod(const comparison::StiffnessChange& change, identification::Method method, Out out) {
  if (!change.available) {
    fmt::format_to(out, "\n{}\n",
                   wrapped(fmt::format("{}: not comparable: {}", namesOf(method).full, words(change.reason)), 2));
    return;
  }
  fmt::format_to(out, "\n{}, 1e6 Nm/rad, +- one standard uncertainty\n  {:<4}{:>20}{:>20}{:>18}{:>10}{:>8}\n",
                 namesOf(method).full, "", "before", "after", "ratio", "p", "corr.");
  for (std::size_t j = 0; j < 6; ++j) {
    const comparison::JointChange& joint = change.joints[j];
    if (!joint.comparable) {
      fmt::format_to(out, "  {}\n", wrapped(fmt::format("k{}  {}", j + 1, words(joint.reason)), 6));
      continue;
    }
    fmt::format_to(out, "  k{:<3}{:>20}{:>20}{:>18}{:>10}{:>8.2f}{}\n", j + 1,
                   withSd(joint.before * 1e-6, joint.before_sd * 1e-6),
                   withSd(joint.after * 1e-6, joint.after_sd * 1e-6), withSd(joint.ratio, joint.ratio_sd),
                   pText(joint.p_value), joint.correlation, joint.mark.empty() ? "" : "  " + words(joint.mark));
  }
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
                 "before (um)", "after (um)", "avoided, %");
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
    for (const identification::Method method : identification::kMethods)
      writeMethod(comparison.of(method), method, out);
    fmt::format_to(out,
                   "  p: probability of a difference as large without any change; the errors' correlation (corr.), by\n"
                   "  the postures measured in both campaigns, is counted\n");
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
