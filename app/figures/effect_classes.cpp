#include "app/figures/effect_classes.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/input/units.h"
#include "reports/page/effect_words.h"
#include "reports/page/html.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

bool present(const Verdict& verdict, Effect effect) {
  return std::any_of(verdict.entries.begin(), verdict.entries.end(), [effect](const VerdictEntry& entry) {
    return std::find(entry.effects.begin(), entry.effects.end(), effect) != entry.effects.end();
  });
}

/// Why an effect has no size.
std::string withoutSize(const Diagnosis& diagnosis, Effect effect) {
  const auto missing = std::find_if(diagnosis.not_testable.begin(), diagnosis.not_testable.end(),
                                    [effect](const NotTestable& one) { return one.effect == effect; });
  // What would make it testable is said in full beside the picture.
  if (missing != diagnosis.not_testable.end())
    return "not testable: " + page::asIs(missing->missing.substr(0, missing->missing.find(':')));
  return effect == Effect::tracker_drift ? "judged by the floor nests themselves"
                                         : "hidden behind joint springs and geometry in these postures";
}

/// Classes of two or more, each once.
std::vector<std::vector<std::size_t>> groupsOf(const Diagnosis& diagnosis) {
  std::vector<std::vector<std::size_t>> groups;
  for (const std::vector<Effect>& alias : diagnosis.aliases) {
    std::vector<std::size_t> rows;
    for (const Effect effect : alias) {
      for (std::size_t i = 0; i < diagnosis.detectable.size(); ++i) {
        if (diagnosis.detectable[i].effect == effect) rows.push_back(i);
      }
    }
    if (rows.size() > 1) groups.push_back(std::move(rows));
  }
  return groups;
}

}  // namespace

std::optional<DotRowChart> effectClasses(const ReportCampaign& one) {
  if (one.diagnosis == nullptr || !one.diagnosis->usable || one.diagnosis->detectable.empty())
    return std::nullopt;
  const Diagnosis& diagnosis = *one.diagnosis;
  DotRowChart chart;
  chart.title = "Which effects this data can tell apart, and from what size on";
  chart.subtitle = fmt::format("{}; {} postures, {} states", page::asIs(one.campaign.name),
                               diagnosis.postures, diagnosis.states);
  chart.x_title = "Smallest size that would have been seen, rms per coordinate (µm)";
  for (const DetectableSize& size : diagnosis.detectable) {
    DotRow row{page::effectName(size.effect), NAN, {}, present(diagnosis.verdict, size.effect)};
    if (size.size)
      row.size = *size.size / kMicrometre;
    else
      row.words = withoutSize(diagnosis, size.effect);
    chart.rows.push_back(std::move(row));
  }
  chart.groups = groupsOf(diagnosis);
  chart.group_title = "not told apart";
  chart.dot_name = "smallest size seen";
  chart.marked_name = "of what the verdict names";
  chart.reference = diagnosis.size_limit / kMicrometre;
  chart.reference_name = "too small to matter, left of it";
  return chart;
}

Figure describeEffectClasses(const ReportCampaign& one) {
  const Diagnosis& diagnosis = *one.diagnosis;
  Figure figure;
  figure.id = "effect-classes";
  figure.title = "Which effects this data can tell apart";
  std::vector<std::string> classes;
  for (const auto& alias : diagnosis.aliases) {
    if (alias.size() > 1) classes.push_back(page::effectNames(alias));
  }
  figure.caption = "Found from the postures and loads alone, before any residual was looked at. ";
  figure.caption += classes.empty()
                        ? "No two effects look alike here: whatever is large enough is named alone."
                        : fmt::format(
                              "A line joins effects that can look alike here, at twice the noise of one "
                              "state: {}. The others are told apart.",
                              fmt::join(classes, "; "));
  figure.caption += fmt::format(
      " An effect smaller than its dot would have passed unseen; one below {}\u00a0µm (dashed) is too small "
      "to matter.",
      page::fixed(diagnosis.size_limit / kMicrometre, 1));
  const bool geometry =
      std::any_of(diagnosis.detectable.begin(), diagnosis.detectable.end(),
                  [](const auto& size) { return size.effect == Effect::kinematic_error && size.size; });
  if (geometry) figure.caption += " That of the kinematic error is a tolerance of unloaded positions.";
  if (!diagnosis.not_testable.empty())
    figure.caption += fmt::format(" Not testable with this data: {} of {} effects.",
                                  diagnosis.not_testable.size(), diagnosis.detectable.size());
  figure.alt = "A row an effect: the smallest size that would have been seen, and which effects look alike.";
  return figure;
}

}  // namespace stiffscope
