#include "app/figures/figures.h"

#include <fmt/format.h>
#include <algorithm>

#include "core/io/units.h"
#include "core/preparation/subsample.h"
#include "reports/page/html.h"
#include "reports/words/effect_words.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

namespace {

bool present(const diagnosis::Verdict& verdict, effects::Effect effect) {
  return std::any_of(verdict.entries.begin(), verdict.entries.end(), [effect](const diagnosis::VerdictEntry& entry) {
    return std::find(entry.effects.begin(), entry.effects.end(), effect) != entry.effects.end();
  });
}

/// Why an effect has no size.
std::string withoutSize(const diagnosis::Diagnosis& diagnosis, effects::Effect effect) {
  const auto missing = std::find_if(diagnosis.not_testable.begin(), diagnosis.not_testable.end(),
                                    [effect](const diagnosis::NotTestable& one) { return one.effect == effect; });
  // What would make it testable is said in full beside the picture.
  if (missing != diagnosis.not_testable.end()) {
    const std::string in_full = reports::words(missing->missing);
    return "not testable: " + reports::asIs(in_full.substr(0, in_full.find(':')));
  }
  return effect == effects::Effect::tracker_drift ? "judged by the floor nests themselves"
                                                  : "hidden behind joint springs and geometry in these postures";
}

/// Classes of two or more, each once.
std::vector<std::vector<std::size_t>> groupsOf(const diagnosis::Diagnosis& diagnosis) {
  std::vector<std::vector<std::size_t>> groups;
  for (const std::vector<effects::Effect>& alias : diagnosis.aliases) {
    std::vector<std::size_t> rows;
    for (const effects::Effect effect : alias) {
      for (std::size_t i = 0; i < diagnosis.detectable.size(); ++i) {
        if (diagnosis.detectable[i].effect == effect) rows.push_back(i);
      }
    }
    if (rows.size() > 1) groups.push_back(std::move(rows));
  }
  return groups;
}

}  // namespace

std::optional<render::DotRowChart> effectClasses(const reports::ReportCampaign& one) {
  if (one.diagnosis == nullptr || !one.diagnosis->usable || one.diagnosis->detectable.empty()) return std::nullopt;
  const diagnosis::Diagnosis& diagnosis = *one.diagnosis;
  render::DotRowChart chart;
  chart.title = "Which effects this data can tell apart, and from what size on";
  chart.subtitle =
      fmt::format("{}; {} postures, {} states", reports::asIs(one.campaign.name), diagnosis.postures, diagnosis.states);
  chart.x_title = "Smallest size that would have been seen, rms per coordinate (µm)";
  for (const diagnosis::DetectableSize& size : diagnosis.detectable) {
    render::DotRow row{reports::effectName(size.effect), NAN, {}, present(diagnosis.verdict, size.effect)};
    if (size.size)
      row.size = *size.size / io::kMicrometre;
    else
      row.words = withoutSize(diagnosis, size.effect);
    chart.rows.push_back(std::move(row));
  }
  chart.groups = groupsOf(diagnosis);
  chart.group_title = "not told apart";
  chart.dot_name = "smallest size seen";
  chart.marked_name = "of what the verdict names";
  chart.reference = diagnosis.size_limit / io::kMicrometre;
  chart.reference_name = "too small to matter, left of it";
  return chart;
}

reports::Figure describeEffectClasses(const reports::ReportCampaign& one) {
  const diagnosis::Diagnosis& diagnosis = *one.diagnosis;
  reports::Figure figure;
  figure.id = "effect-classes";
  figure.title = "Which effects this data can tell apart";
  std::vector<std::string> classes;
  for (const auto& alias : diagnosis.aliases) {
    if (alias.size() > 1) classes.push_back(reports::effectNames(alias));
  }
  figure.caption = "Found from the postures and loads alone, before any residual was looked at. ";
  figure.caption += classes.empty() ? "No two effects look alike here: whatever is large enough is named alone."
                                    : fmt::format(
                                          "A line joins effects that can look alike here, at twice the noise of one "
                                          "state: {}. The others are told apart.",
                                          fmt::join(classes, "; "));
  figure.caption += fmt::format(
      " An effect smaller than its dot would have passed unseen; one below {}\u00a0µm (dashed) is too small "
      "to matter.",
      reports::fixed(diagnosis.size_limit / io::kMicrometre, 1));
  const bool geometry = std::any_of(diagnosis.detectable.begin(), diagnosis.detectable.end(), [](const auto& size) {
    return size.effect == effects::Effect::kinematic_error && size.size;
  });
  if (geometry) figure.caption += " That of the kinematic error is a tolerance of unloaded positions.";
  if (!diagnosis.not_testable.empty())
    figure.caption += fmt::format(" Not testable with this data: {} of {} effects.", diagnosis.not_testable.size(),
                                  diagnosis.detectable.size());
  figure.alt = "A row an effect: the smallest size that would have been seen, and which effects look alike.";
  return figure;
}

namespace {

const diagnosis::WhereTable* byPosture(const std::vector<diagnosis::WhereTable>& tables) {
  const auto found =
      std::find_if(tables.begin(), tables.end(), [](const diagnosis::WhereTable& one) { return one.by == "posture"; });
  return found == tables.end() ? nullptr : &*found;
}

/// Whether the verdict names something that can be in a model.
bool named(const reports::ReportCampaign& one) { return !reports::namedWords(one.diagnosis->verdict).empty(); }

std::vector<double> rmsOf(const diagnosis::WhereTable& table) {
  std::vector<double> values;
  for (const diagnosis::WhereRow& row : table.rows) values.push_back(row.rms / io::kMicrometre);
  return values;
}

}  // namespace

std::optional<render::GroupedBarChart> gapBars(const reports::ReportCampaign& one) {
  if (one.diagnosis == nullptr || !one.diagnosis->usable) return std::nullopt;
  const diagnosis::WhereTable* before = byPosture(one.diagnosis->where);
  const diagnosis::WhereTable* after = byPosture(one.diagnosis->where_after);
  if (before == nullptr || before->rows.empty()) return std::nullopt;
  render::GroupedBarChart chart;
  chart.title = "Gap between model and machine";
  chart.subtitle = fmt::format("{}; in the verdict: {}", reports::asIs(one.campaign.name),
                               reports::asIs(reports::presentWords(one.diagnosis->verdict)));
  chart.y_title = "Left of the deflection, rms per coordinate (µm)";
  chart.category_title = "Posture";
  for (const diagnosis::WhereRow& row : before->rows) chart.categories.push_back(reports::asIs(row.name));
  const diagnosis::WhereTable& as_measured = one.diagnosis->as_measured;
  const bool raw = as_measured.rows.size() == before->rows.size();  // the station's motion is part of the gap
  chart.series.push_back({"joint stiffnesses alone", render::colours::kNone, rmsOf(raw ? as_measured : *before), {}});
  if (after != nullptr && after->rows.size() == before->rows.size() && named(one)) {
    chart.series.push_back({"with the verdict's effects", render::colours::kSeries[1], rmsOf(*after), {}});
  }
  render::BarSeries noise{"noise alone", render::colours::kSeries[2], {}, {}};
  for (const diagnosis::WhereRow& row : before->rows) noise.values.push_back(row.noise / io::kMicrometre);
  chart.series.push_back(std::move(noise));
  return chart;
}

reports::Figure describeGapBars(const reports::ReportCampaign& one) {
  const diagnosis::Gap& gap = one.diagnosis->gap;
  const bool found = named(one);
  reports::Figure figure;
  figure.id = "gap-by-posture";
  figure.title = found ? "Gap between model and machine, before and after" : "Gap between model and machine";
  figure.caption = fmt::format(
      "Over {} postures, rms per coordinate: {}\u00a0µm by joint stiffnesses alone, {}{}\u00a0µm by noise "
      "alone.",
      one.campaign.pose_ids.size() > preparation::kMostDiagnosed
          ? fmt::format("{} of {}", one.diagnosis->postures, one.campaign.pose_ids.size())
          : "all",
      reports::fixed(gap.before / io::kMicrometre, 1),
      found ? fmt::format("{}\u00a0µm with the verdict's effects in the model, ",
                          reports::fixed(gap.after / io::kMicrometre, 1))
            : "",
      reports::fixed(gap.noise / io::kMicrometre, 1));
  figure.caption += found ? " A posture that stays high is one where the verdict does not hold."
                          : " Postures that stand out of the noise show what joint stiffnesses do not explain.";
  if (!one.diagnosis->as_measured.rows.empty())
    figure.caption += " Grey bars are of the readings as they were, the station's motion in them.";
  figure.alt = "Bars by posture: what the model leaves of the deflection before and after, and noise.";
  return figure;
}

}  // namespace stiffscope::app
