#include "app/figures/figures.h"

#include <fmt/format.h>
#include <algorithm>
#include <set>

#include "core/io/units.h"
#include "core/preparation/subsample.h"
#include "reports/page/html.h"
#include "reports/words/effect_words.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/unloaded_effect_words.h"

namespace stiffscope::app {

namespace {

const std::vector<diagnosis::VerdictEntry>& entriesOf(const diagnosis::Diagnosis& diagnosis) {
  return diagnosis.verdict.entries;
}
const std::vector<accuracy::AccuracyEntry>& entriesOf(const accuracy::AccuracyDiagnosis& accuracy) {
  return accuracy.verdict;
}

/// Why an effect that can be tested has no size.
const char* hiddenWords(effects::Effect effect) {
  return effect == effects::Effect::tracker_drift ? "judged by the floor nests themselves"
                                                  : "hidden behind joint springs and geometry in these postures";
}
const char* hiddenWords(calibration::UnloadedEffect) { return "hidden behind the geometry in these postures"; }

template <class Answer, class Effect>
bool present(const Answer& answer, Effect effect) {
  const auto& entries = entriesOf(answer);
  return std::any_of(entries.begin(), entries.end(), [effect](const auto& entry) {
    return std::find(entry.effects.begin(), entry.effects.end(), effect) != entry.effects.end();
  });
}

/// Why an effect has no size.
template <class Answer, class Effect>
std::string withoutSize(const Answer& answer, Effect effect) {
  const auto missing = std::find_if(answer.not_testable.begin(), answer.not_testable.end(),
                                    [effect](const auto& one) { return one.effect == effect; });
  if (missing == answer.not_testable.end()) return hiddenWords(effect);
  // What would make it testable is said in full beside the picture.
  const std::string in_full = reports::words(missing->missing);
  return "not testable: " + reports::asIs(in_full.substr(0, in_full.find(':')));
}

/// Classes of two or more, each once.
template <class Answer>
std::vector<std::vector<std::size_t>> groupsOf(const Answer& answer) {
  std::vector<std::vector<std::size_t>> groups;
  for (const auto& alias : answer.aliases) {
    std::vector<std::size_t> rows;
    for (const auto effect : alias) {
      for (std::size_t i = 0; i < answer.detectable.size(); ++i) {
        if (answer.detectable[i].effect == effect) rows.push_back(i);
      }
    }
    if (rows.size() > 1) groups.push_back(std::move(rows));
  }
  return groups;
}

template <class Answer>
render::DotRowChart classesChart(const Answer& answer) {
  render::DotRowChart chart;
  chart.title = "Which effects this data can tell apart, and from what size on";
  chart.x_title = "Smallest size seen, rms per coordinate (µm)";  // beside the groups there is no room for more
  for (const auto& size : answer.detectable) {
    render::DotRow row{reports::effectName(size.effect), NAN, {}, present(answer, size.effect)};
    if (size.size)
      row.size = *size.size / io::kMicrometre;
    else
      row.words = withoutSize(answer, size.effect);
    chart.rows.push_back(std::move(row));
  }
  chart.groups = groupsOf(answer);
  chart.group_title = "not told apart";
  chart.dot_name = "smallest size seen";
  chart.marked_name = "of what the verdict names";
  if (answer.size_limit > 0.0) {
    chart.reference = answer.size_limit / io::kMicrometre;
    chart.reference_name = "too small to matter, left of it";
  }
  return chart;
}

}  // namespace

std::optional<render::DotRowChart> effectClasses(const reports::ReportCampaign& one) {
  render::DotRowChart chart;
  if (one.diagnosis != nullptr && one.diagnosis->usable && !one.diagnosis->detectable.empty()) {
    chart = classesChart(*one.diagnosis);
    chart.subtitle = fmt::format("{}; {} postures, {} states", reports::asIs(one.campaign.name),
                                 one.diagnosis->postures, one.diagnosis->states);
  } else if (one.accuracy != nullptr && one.accuracy->usable && !one.accuracy->detectable.empty()) {
    chart = classesChart(*one.accuracy);
    chart.subtitle = fmt::format("{}; {} postures, {} readings", reports::asIs(one.campaign.name),
                                 one.accuracy->postures, one.accuracy->readings);
  } else {
    return std::nullopt;
  }
  return chart;
}

namespace {

/// What is said as one, in the verdict and, where the classes beside it are candidates of these readings, among them.
const std::vector<diagnosis::VerdictEntry>& saidAsOne(const diagnosis::Diagnosis& diagnosis) {
  return diagnosis.verdict.entries;
}
const std::vector<accuracy::AccuracyClass>& saidAsOne(const accuracy::AccuracyDiagnosis& accuracy) {
  return accuracy.classes;
}

/// Effects that are said as one although the postures would part them: the readings, with their noise, do not.
template <class Answer>
std::vector<std::string> notParted(const Answer& answer) {
  std::vector<std::string> names;
  for (const auto& entry : saidAsOne(answer)) {
    const bool joined = std::any_of(answer.aliases.begin(), answer.aliases.end(), [&entry](const auto& alias) {
      return std::all_of(entry.effects.begin(), entry.effects.end(), [&alias](const auto effect) {
        return std::find(alias.begin(), alias.end(), effect) != alias.end();
      });
    });
    if (entry.effects.size() > 1 && !joined) names.push_back(reports::effectNames(entry.effects));
  }
  return names;
}

/// "A line joins effects that can look alike here, ..."; each class of aliases of two or more.
template <class Answer>
std::string aliasWords(const Answer& answer, const char* how_large) {
  std::vector<std::string> classes;
  for (const auto& alias : answer.aliases) {
    if (alias.size() > 1) classes.push_back(reports::effectNames(alias));
  }
  const std::vector<std::string> together = notParted(answer);
  if (classes.empty() && !together.empty()) {
    return fmt::format("By the postures alone no two effects look alike; these readings do not part {}.",
                       fmt::join(together, "; "));
  }
  if (classes.empty()) return "No two effects look alike here: whatever is large enough is named alone.";
  return fmt::format("A line joins effects that can look alike here{}: {}. {}.", how_large, fmt::join(classes, "; "),
                     together.empty() ? "The others are told apart"
                                      : fmt::format("These readings do not part {} either", fmt::join(together, "; ")));
}

/// The size in its words that all testable effects have; empty where they differ, or where there is one alone.
template <class Answer>
std::string commonSize(const Answer& answer) {
  std::set<std::string> sizes;
  std::size_t tested = 0;
  for (const auto& effect : answer.detectable) {
    if (!effect.size) continue;
    ++tested;
    sizes.insert(reports::fixed(*effect.size / io::kMicrometre, 1));
  }
  return tested > 1 && sizes.size() == 1 ? *sizes.begin() : std::string();
}

template <class Answer>
std::string sizeWords(const Answer& answer) {
  const std::string common = commonSize(answer);
  if (!common.empty()) {
    const bool limit = common == reports::fixed(answer.size_limit / io::kMicrometre, 1);
    return fmt::format(" All would have been seen from one size on, {}\u00a0µm{}: the dots do not tell them apart.",
                       common, limit ? ", below which one is too small to matter (dashed)" : "");
  }
  std::string text = " An effect smaller than its dot would have passed unseen";
  if (answer.size_limit > 0.0) {
    text += fmt::format("; one below {}\u00a0µm (dashed) is too small to matter",
                        reports::fixed(answer.size_limit / io::kMicrometre, 1));
  }
  return text + ".";
}

template <class Answer>
std::string untestedWords(const Answer& answer) {
  if (answer.not_testable.empty()) return {};
  return fmt::format(" Not testable with this data: {} of {} effects.", answer.not_testable.size(),
                     answer.detectable.size());
}

std::string captionOf(const diagnosis::Diagnosis& diagnosis) {
  std::string caption = "Found from the postures and loads alone, before any residual was looked at. ";
  caption += aliasWords(diagnosis, ", at twice the noise of one state") + sizeWords(diagnosis);
  const bool geometry = std::any_of(diagnosis.detectable.begin(), diagnosis.detectable.end(), [](const auto& size) {
    return size.effect == effects::Effect::kinematic_error && size.size;
  });
  if (geometry) caption += " That of the kinematic error is a tolerance of unloaded positions.";
  return caption + untestedWords(diagnosis);
}

std::string captionOf(const accuracy::AccuracyDiagnosis& accuracy) {
  return "Found from the postures alone, before any residual was looked at. " + aliasWords(accuracy, "") +
         sizeWords(accuracy) + untestedWords(accuracy);
}

}  // namespace

reports::Figure describeEffectClasses(const reports::ReportCampaign& one) {
  reports::Figure figure;
  figure.id = "effect-classes";
  figure.title = "Which effects this data can tell apart";
  figure.caption = one.diagnosis != nullptr ? captionOf(*one.diagnosis) : captionOf(*one.accuracy);
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
  const auto shown = [](double metres) { return reports::withMicro(reports::lengthWords(metres, 1)); };
  reports::Figure figure;
  figure.id = "gap-by-posture";
  figure.title = found ? "Gap between model and machine, before and after" : "Gap between model and machine";
  figure.caption = fmt::format(
      "Over {} postures, rms per coordinate: {} by joint stiffnesses alone, {}{} by noise "
      "alone.",
      one.campaign.pose_ids.size() > preparation::kMostDiagnosed
          ? fmt::format("{} of {}", one.diagnosis->postures, one.campaign.pose_ids.size())
          : "all",
      shown(gap.before), found ? fmt::format("{} with the verdict's effects in the model, ", shown(gap.after)) : "",
      shown(gap.noise));
  figure.caption += found ? " A posture that stays high is one where the verdict does not hold."
                          : " Postures that stand out of the noise show what joint stiffnesses do not explain.";
  if (!one.diagnosis->as_measured.rows.empty())
    figure.caption += " Grey bars are of the readings as they were, the station's motion in them.";
  figure.alt = "Bars by posture: what the model leaves of the deflection before and after, and noise.";
  return figure;
}

}  // namespace stiffscope::app
