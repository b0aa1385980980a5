#include "core/campaign/campaign.h"
#include "core/diagnosis/diagnosis.h"
#include "reports/text/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/spike_study.h"
#include "core/io/units.h"
#include "reports/text/gap_text.h"
#include "reports/words/effect_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::reports {

/// What is present, in one line: "hysteresis (joint 2), and unknown"; "none" where nothing is.
std::string verdictWords(const diagnosis::Verdict& verdict);

std::string verdictWords(const diagnosis::Verdict& verdict) {
  if (verdict.entries.empty()) return "none";
  std::string line;
  for (const diagnosis::VerdictEntry& entry : verdict.entries) {
    line += line.empty() ? "" : ", and ";
    line += entry.effects.empty() ? "unknown" : effectNames(entry.effects);
    if (!entry.detail.empty()) line += " (" + entry.detail + ")";
  }
  return line;
}

namespace {

using Out = std::back_insert_iterator<std::string>;

void writeClasses(const diagnosis::Diagnosis& diagnosis, Out out) {
  if (diagnosis.classes.empty()) return;
  fmt::format_to(out, "\nWhich: candidates, and what each takes off the deflection's gap on postures held out\n");
  fmt::format_to(out, "  {:<2}{:<44}{:>12}{:>9}  {:<17}{:>10}\n", "", "effect", "score", "shrink", "95 %", "explained");
  const auto share = [](double value) {
    return std::isnan(value) ? std::string("-") : fmt::format("{:.3f}", unsignedZero(value, 3));
  };
  for (const diagnosis::EffectClass& one : diagnosis.classes) {
    fmt::format_to(out, "  {:<2}{:<44}{:>12.0f}{:>9}  {:<17}{:>10}\n", one.in_verdict ? "*" : "",
                   effectNames(one.effects), unsignedZero(one.score, 0), share(one.shrink.value),
                   shrinkInterval(one.shrink), share(one.explained));
    if (!one.in_verdict) continue;
    if (!one.detail.empty()) fmt::format_to(out, "    {}\n", wrapped(one.detail, 4));
    if (!one.parameters.empty()) fmt::format_to(out, "    {}\n", wrapped(words(one.parameters), 4));
    if (diagnosis.positions_tested)
      fmt::format_to(out, "    absolute positions: shrink {} ({})\n", share(one.shrink_of_positions.value),
                     shrinkInterval(one.shrink_of_positions));
  }
  if (!diagnosis.classes.front().shrink.judged()) fmt::format_to(out, "  {}\n", wrapped(notHeldOutWords(), 2));
}

/// "+-0.1234", "+-?" where the interval is open.
std::string expandedCell(double expanded, const StiffnessUnit& unit) {
  return std::isfinite(expanded) ? fmt::format("+-{:.4f}", expanded / unit.size) : "+-?";
}

/// As identification states them; where it has none, of the diagnosis's own fit.
void writeStiffnesses(const diagnosis::Diagnosis& diagnosis, Out out) {
  const StiffnessUnit unit = stiffnessUnit(diagnosis);
  if (diagnosis.stated) {
    fmt::format_to(out,
                   "\nStiffness, {}, by {}, with its expanded uncertainty U (coverage 95 %)\n  {:<18}{:>12}"
                   "{:>20}\n",
                   unit.text, namesOf(diagnosis.stated->method).brief, "", "springs only", "with the model");
  } else {
    fmt::format_to(out,
                   "\nStiffness, {}      before     after         u  (all load steps together; one standard "
                   "uncertainty)\n",
                   unit.text);
  }
  for (int j = 0; j < static_cast<int>(diagnosis.identifiable.size()); ++j) {
    if (!diagnosis.identifiable[static_cast<std::size_t>(j)]) {
      fmt::format_to(out, "  joint {}           not identifiable\n", j + 1);
    } else if (diagnosis.stated) {
      fmt::format_to(out, "  joint {}           {:>12.4f}{:>12.4f} {}\n", j + 1,
                     diagnosis.stiffness_before[j] / unit.size, diagnosis.stiffness_after[j] / unit.size,
                     expandedCell(diagnosis.stated->expanded[j], unit));
    } else {
      fmt::format_to(out, "  joint {}              {:>10.4f}{:>10.4f}{:>10.4f}\n", j + 1,
                     diagnosis.stiffness_before[j] / unit.size, diagnosis.stiffness_after[j] / unit.size,
                     diagnosis.stiffness_after_sd[j] / unit.size);
    }
  }
  fmt::format_to(out, "  K_c (no free parameter) changes the joint torques by {:.2f} %\n",
                 100.0 * diagnosis.geometric_stiffness_share);
}

void writeLimits(const diagnosis::Diagnosis& diagnosis, Out out) {
  fmt::format_to(out, "\nNoise: {} rms in one state's displacement; {}.\n",
                 withMicro(lengthWords(diagnosis.state_noise, 1)), words(diagnosis.noise_source));
  fmt::format_to(out, "Limits: a fall of BIC of {:.0f}, and {} rms after the stiffnesses.\n",
                 diagnosis.significance_limit, withMicro(lengthWords(diagnosis.size_limit, 1)));
  fmt::format_to(out, "Smallest size that would have been seen, µm rms per coordinate:\n");
  std::string sizes;
  for (const diagnosis::DetectableSize& one : diagnosis.detectable) {
    if (one.size) sizes += fmt::format("{}{} {:.0f}", sizes.empty() ? "" : ", ", effectName(one.effect), um(*one.size));
  }
  fmt::format_to(out, "  {}\n", wrapped(sizes, 2));
  for (const diagnosis::NotTestable& one : diagnosis.not_testable)
    fmt::format_to(out, "  {}\n",
                   wrapped(fmt::format("{} not testable here: {}", effectName(one.effect), words(one.missing)), 4));
}

}  // namespace

std::string diagnosisText(const campaign::Campaign& campaign, const diagnosis::Diagnosis& diagnosis) {
  std::string text;
  Out out(text);
  if (!diagnosis.usable) return fmt::format("{}: no diagnosis: {}\n", campaign.name, words(diagnosis.unusable_reason));
  fmt::format_to(out, "{}: {}\n\n", campaign.name, verdictWords(diagnosis.verdict));
  fmt::format_to(out, "{}\n", wrapped(reasonWords(diagnosis.verdict), 0));
  fmt::format_to(out, "\nGap of the deflection ({} rms): {} before, {} after, noise {}\n",
                 withMicro(lengthWords(diagnosis.gap.deflection, 0)), withMicro(lengthWords(diagnosis.gap.before, 1)),
                 withMicro(lengthWords(diagnosis.gap.after, 1)), withMicro(lengthWords(diagnosis.gap.noise, 1)));
  if (diagnosis.positions_tested) {
    fmt::format_to(out, "Gap of unloaded positions: {} before, {} after, noise {}\n",
                   withMicro(lengthWords(diagnosis.positions.before, 1)),
                   withMicro(lengthWords(diagnosis.positions.after, 1)),
                   withMicro(lengthWords(diagnosis.positions.noise, 1)));
  }
  writeClasses(diagnosis, out);
  for (const auto& group : diagnosis.aliases)
    fmt::format_to(out, "  These postures and loads cannot always separate: {}\n", wrapped(effectNames(group), 4));
  text += whereText(diagnosis.where, "Where the deflection's gap lies");
  text += whereText(diagnosis.where_positions, "Where the gap of unloaded positions lies");
  writeStiffnesses(diagnosis, out);
  writeLimits(diagnosis, out);
  return text + nextText(diagnosis.next);
}

std::string nextText(const std::vector<diagnosis::NextMeasurement>& next) {
  std::string text;
  for (const diagnosis::NextMeasurement& one : next) text += fmt::format("Next: {}\n", wrapped(words(one.what), 2));
  return text;
}

namespace {

/// "3/8", "-" without a draw.
std::string ofDraws(int count, const diagnosis::SpikeCounts& at) {
  return at.draws == 0 ? "-" : fmt::format("{}/{}", count, at.draws);
}

/// "base compliance 3, unknown 1": what was said besides, and how often over all sizes.
std::string saidBesides(const diagnosis::SpikedEffect& one) {
  std::string text;
  std::vector<std::pair<std::string, int>> sums;
  const auto add = [&](const std::string& name, int count) {
    if (count == 0) return;
    const auto found = std::find_if(sums.begin(), sums.end(), [&](const auto& sum) { return sum.first == name; });
    if (found != sums.end()) {
      found->second += count;
    } else {
      sums.emplace_back(name, count);
    }
  };
  for (const diagnosis::SpikeCounts& at : one.sizes) {
    for (const auto& [effect, count] : at.others) add(effectName(effect), count);
    add("unknown", at.unknown);
  }
  for (const auto& [name, count] : sums) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, count);
  return text;
}

void writeSpikedEffect(const diagnosis::SpikedEffect& one, Out out) {
  const std::string name = fmt::format("{}{}", effectName(one.effect), one.in_baseline ? " *" : "");
  if (!one.detectable) {
    fmt::format_to(out, "  {}\n", wrapped(fmt::format("{:<25} not added: {}", name, words(one.reason)), 4));
    return;
  }
  fmt::format_to(out, "  {:<25}{:>8.1f} ", name, um(*one.detectable));
  int draws = 0, other = 0, parts = 0, named = 0;
  for (const diagnosis::SpikeCounts& at : one.sizes) {
    fmt::format_to(out, "{:>7}", ofDraws(at.named, at));
    draws += at.draws, other += at.other_named, parts += at.part_named, named += at.named;
  }
  fmt::format_to(out, "{:>10}{:>9}\n", named > 0 ? fmt::format("{}/{}", parts, named) : "-",
                 draws > 0 ? fmt::format("{}/{}", other, draws) : "-");
  const std::string besides = saidBesides(one);
  if (!besides.empty()) fmt::format_to(out, "      besides: {}\n", wrapped(besides, 8));
}

}  // namespace

std::string spikeText(const diagnosis::Diagnosis& baseline, const diagnosis::SpikeStudy& study) {
  std::string text;
  Out out(text);
  fmt::format_to(
      out, "\n{}\n",
      wrapped(fmt::format("Proof by effects added to this day's own readings ({} draws a size, seed {}). Without "
                          "any: {}. That stays in the readings.",
                          study.draws, study.seed, verdictWords(baseline.verdict)),
              0));
  std::string sizes;
  for (const diagnosis::SpikedEffect& one : study.effects) {
    if (one.sizes.empty()) continue;
    for (const diagnosis::SpikeCounts& at : one.sizes) sizes += fmt::format("{:>7}", fmt::format("x {:g}", at.times));
    break;
  }
  fmt::format_to(out, "  {:<25}{:>8} {}{:>10}{:>9}\n", "named, of draws", "size, µm", sizes, "its part", "another");
  bool marked = false;
  for (const diagnosis::SpikedEffect& one : study.effects) {
    writeSpikedEffect(one, out);
    marked = marked || one.in_baseline;
  }
  if (marked) fmt::format_to(out, "  * named without being added: only its part says something\n");
  fmt::format_to(out, "{}\n",
                 wrapped("The size is the smallest that would have been seen, as above. What is added follows the "
                         "effect's own equation: whether the machine does is not shown.",
                         0));
  return text;
}

}  // namespace stiffscope::reports
