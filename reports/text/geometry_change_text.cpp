#include <fmt/format.h>
#include <cmath>
#include <iterator>

#include "core/comparison/geometry_change.h"
#include "core/io/units.h"
#include "reports/text/text.h"
#include "reports/words/geometry_change_words.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

namespace {

using Out = std::back_insert_iterator<std::string>;

constexpr double kMilliradian = 1e-3;

std::string chance(double p) {
  if (!std::isfinite(p)) return "-";
  return p < 1e-4 ? "< 0.0001" : fmt::format("{:.4f}", p);
}

void writeNumbers(const comparison::GeometryChange& change, Out out) {
  fmt::format_to(out, "\nGeometry, after - before, +- U (95 %)\n  {:<28}{:>26}{:>11}{:>11}{:>16}\n", "", "difference",
                 "p", "Holm", "reflectors, mm");
  for (const comparison::NumberChange& one : change.numbers) {
    const double unit = one.number.isLength() ? io::kMillimetre : kMilliradian;
    if (!one.identified) {
      fmt::format_to(out, "  {:<28}{:>26}\n", numberName(one.number), "not seen by both days");
      continue;
    }
    fmt::format_to(out, "  {:<28}{:>26}{:>11}{:>11}{:>16.4f}\n", numberName(one.number),
                   fmt::format("{:.4f} +- {:.4f} {}", unsignedZero(one.difference.value / unit, 4),
                               one.difference.expanded() / unit, one.number.isLength() ? "mm  " : "mrad"),
                   chance(one.p_value), chance(one.p_holm), one.at_targets / io::kMillimetre);
  }
  fmt::format_to(out, "  {}\n",
                 wrapped("p: probability of a difference as large without any change; Holm: the same corrected for the "
                         "numbers tested. reflectors: rms of the 3-D position by this number alone, over the postures "
                         "of both days, base and reflectors fitted again.",
                         2));
}

void writeCauses(const comparison::GeometryChange& change, Out out) {
  if (change.causes.empty()) return;
  constexpr std::size_t kShown = 5;
  fmt::format_to(out, "\nSingle causes, best first\n  {:>10}{:>10}{:>10}{:>12}   cause\n", "unknowns", "chi2", "BIC",
                 "p of rest");
  for (std::size_t i = 0; i < std::min(kShown, change.causes.size()); ++i) {
    const comparison::CauseEvidence& one = change.causes[i];
    fmt::format_to(out, "  {:>10}{:>10.1f}{:>10.1f}{:>12}   {}\n", one.unknowns, one.chi2, one.bic, chance(one.left_p),
                   wrapped(causeWords(one), 47));
  }
}

void writeOthers(const comparison::GeometryChange& change, Out out) {
  if (!change.reflectors.empty())
    fmt::format_to(out, "\nReflectors on the flange, after - before, mm +- U (95 %), flange axes\n");
  for (const comparison::ReflectorChange& one : change.reflectors) {
    fmt::format_to(out, "  {:<10}", one.target);
    for (Eigen::Index k = 0; k < 3; ++k) {
      fmt::format_to(out, "{:>20}",
                     fmt::format("{:.4f} +- {:.4f}", unsignedZero(one.shift[k] / io::kMillimetre, 4),
                                 expanded(one.sd[k]) / io::kMillimetre));
    }
    fmt::format_to(out, "   Holm {}\n", chance(one.p_holm));
  }
  fmt::format_to(out,
                 "\nThe base against the tracker: moved by {:.3f} mm, turned by {:.4f} deg; no change of the machine\n",
                 change.base.shift.norm() / io::kMillimetre, change.base.turn.norm() / io::kDegree);
}

}  // namespace

std::string geometryChangeText(const campaign::Campaign& before, const campaign::Campaign& after,
                               const comparison::GeometryChange& change) {
  std::string text;
  const Out out(text);
  fmt::format_to(out, "before: {}\nafter:  {}\n", before.name, after.name);
  if (!change.reason.empty()) {
    fmt::format_to(out, "\n{}\n", wrapped("Nothing is comparable: " + words(change.reason), 2));
    return text;
  }
  for (const std::string& caution : words(change.cautions))
    fmt::format_to(out, "  {}\n", wrapped("caution: " + caution, 4));
  fmt::format_to(out, "\n");
  for (const std::string& sentence : changeWords(change)) fmt::format_to(out, "{}\n", wrapped(sentence, 0));
  std::string beside;
  for (const std::string& id : change.effects) beside += (beside.empty() ? ", with " : ", ") + id;
  fmt::format_to(
      out, "\n{}\n",
      wrapped(
          fmt::format(
              "{}{}; {} postures before, {} after, {} of both. The models leave {:.4f} mm (rms, 3-D) before "
              "and {:.4f} mm after.",
              change.same_postures ? "Fitted to the postures of both days alone" : "Fitted to all postures of each day",
              beside, change.postures_before, change.postures_after, change.postures_common,
              change.left_before / io::kMillimetre, change.left_after / io::kMillimetre),
          0));
  writeNumbers(change, out);
  writeCauses(change, out);
  writeOthers(change, out);
  return text;
}

}  // namespace stiffscope::reports
