#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/io/units.h"
#include "reports/page/diagnosis_tables.h"
#include "reports/page/html.h"
#include "reports/page/sections.h"
#include "reports/words/effect_words.h"
#include "reports/words/extended_model_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::page {

namespace {

/// What is present, with what it means.
std::string findingOf(const diagnosis::Diagnosis& diagnosis) {
  const auto& entries = diagnosis.verdict.entries;
  if (entries.empty()) {
    return fmt::format(
        "Joint springs are enough for this machine on this day: what they leave is noise, or too small to "
        "matter (below {} rms).",
        reports::withMicro(reports::lengthWords(diagnosis.size_limit, 1)));
  }
  const std::string present =
      fmt::format("Besides joint springs the readings show {}", reports::presentWords(diagnosis.verdict));
  std::vector<effects::Effect> effects;
  for (const diagnosis::VerdictEntry& entry : entries)
    effects.insert(effects.end(), entry.effects.begin(), entry.effects.end());
  if (effects.empty()) return present + ".";
  if (effects.size() == 1) return fmt::format("{}: {}.", present, reports::effectMeaning(effects.front()));
  std::vector<std::string> meanings;
  for (const effects::Effect effect : effects)
    meanings.push_back(fmt::format("{}: {}", reports::effectName(effect), reports::effectMeaning(effect)));
  return fmt::format("{}. That is, {}.", present, fmt::join(meanings, "; "));
}

std::string figuresOf(const diagnosis::Diagnosis& diagnosis) {
  const bool named = !reports::namedWords(diagnosis.verdict).empty();
  const auto shown = [](double metres) { return reports::withMicro(reports::lengthWords(metres, 1)); };
  const std::string noise = fmt::format("of which noise is {}", shown(diagnosis.gap.noise));
  if (!named) {
    return fmt::format("The gap is {} rms per coordinate, {}.", shown(diagnosis.gap.before), noise);
  }
  const auto entries = std::count_if(diagnosis.verdict.entries.begin(), diagnosis.verdict.entries.end(),
                                     [](const diagnosis::VerdictEntry& entry) { return !entry.effects.empty(); });
  const std::string falls =
      fmt::format("With {} in the model the gap falls from {} to {} rms per coordinate, {}",
                  entries > 1 ? "them" : "it", shown(diagnosis.gap.before), shown(diagnosis.gap.after), noise);
  if (!diagnosis.shrink_together.judged()) return falls + ". " + reports::notHeldOutWords();
  return falls +
         fmt::format("; on postures that took no part it shrinks by {}\u00a0% (95\u00a0%: {}\u00a0%).",
                     reports::fixed(100.0 * diagnosis.shrink_together.value, placesOf(diagnosis.shrink_together)),
                     interval(diagnosis.shrink_together));
}

}  // namespace

std::vector<std::string> diagnosisActions(const diagnosis::Diagnosis& diagnosis) {
  std::vector<std::string> actions;
  const bool several = diagnosis.verdict.entries.size() > 1;
  for (const diagnosis::VerdictEntry& entry : diagnosis.verdict.entries) {
    if (entry.effects.empty()) {
      actions.push_back(
          "Look for what is not in the list of effects (the figures below show where) before the "
          "stiffnesses are used for compensation.");
    }
    std::vector<std::string> of_class;
    for (const effects::Effect effect : entry.effects) {
      std::string remedy = reports::effectRemedy(effect);
      if (std::find(of_class.begin(), of_class.end(), remedy) == of_class.end()) of_class.push_back(std::move(remedy));
    }
    for (const std::string& remedy : of_class) {
      const std::string action =
          of_class.size() > 1
              ? fmt::format("If it is {}: {}.",
                            reports::effectName(entry.effects[static_cast<std::size_t>(&remedy - of_class.data())]),
                            remedy)
          : several ? reports::capitalised(reports::effectNames(entry.effects)) + ": " + remedy + "."
                    : reports::capitalised(remedy) + ".";
      if (std::find(actions.begin(), actions.end(), action) == actions.end()) actions.push_back(action);
    }
  }
  for (const diagnosis::NextMeasurement& one : diagnosis.next) {
    actions.push_back(fmt::format("To tell {} apart, measure {}.", reports::effectNames(one.separates, " and "),
                                  reports::withMicro(reports::words(one.what))));
  }
  return actions;
}

namespace {

/// The geometry is judged by a tolerance, not by BIC.
std::string fallOf(const diagnosis::EffectClass& one) {
  return one.effects.front() == effects::Effect::kinematic_error ? "–" : reports::significant(one.score, 3);
}

reports::Table gapTable(const diagnosis::Diagnosis& diagnosis) {
  std::string caption = "Where the gap lies that joint stiffnesses leave, rms per coordinate";
  if (!diagnosis.as_measured.rows.empty()) caption += ", the station's motion taken off";
  return whereTable(caption, "Deflection", diagnosis.where, {diagnosis.where_positions, "Unloaded"});
}

reports::Table stiffnessTable(const reports::ReportCampaign& one) {
  const diagnosis::Diagnosis& diagnosis = *one.diagnosis;
  const bool stated = diagnosis.stated.has_value();
  const reports::StiffnessUnit unit = reports::stiffnessUnit(diagnosis);
  reports::Table table{
      stated ? fmt::format("Joint stiffness by {}, by joint springs alone and with the effects in the model, k ± U, {}",
                           reports::namesOf(diagnosis.stated->method).full, unit.name)
             : fmt::format("Joint stiffness in the diagnosis, by joint springs alone and with the verdict's effects in "
                           "the model, k ± U, {}",
                           unit.name),
      {"Joint", "Alone", "With the effects"},
      {},
      false,
      "diagnosis-stiffness"};
  reports::DataTable& data = table.data.emplace();
  data.columns = {"joint", "alone_nm_per_rad", "with_effects_nm_per_rad",
                  stated ? "u_expanded_nm_per_rad" : "u_standard_nm_per_rad"};
  reports::RowGroup group;
  for (int j = 0; j < static_cast<int>(diagnosis.identifiable.size()); ++j) {
    if (!diagnosis.identifiable[static_cast<std::size_t>(j)]) continue;
    const double sd = diagnosis.stiffness_after_sd[j];
    const double u = stated ? diagnosis.stated->expanded[j] : reports::expanded(sd);
    // As the tables of stiffnesses have them, whose numbers these are.
    const auto stiffness = [&](const identification::Identification& result) {
      return reports::uncertainStiffness(result.of(diagnosis.stated->method).estimate, j, unit.size);
    };
    const bool as_elsewhere = stated && one.improved != nullptr;
    group.rows.push_back({reports::jointName(j),
                          as_elsewhere ? stiffness(one.improved->without)
                                       : reports::toPlaceOf(diagnosis.stiffness_before[j] / unit.size, u / unit.size),
                          as_elsewhere
                              ? stiffness(one.improved->with)
                              : reports::withUncertainty(diagnosis.stiffness_after[j] / unit.size, u / unit.size)});
    data.rows.push_back({j + 1.0, diagnosis.stiffness_before[j], diagnosis.stiffness_after[j], stated ? u : sd});
  }
  table.groups.push_back(std::move(group));
  return table;
}

void writeDiagnosis(Html& html, const reports::ReportCampaign& one) {
  const diagnosis::Diagnosis& diagnosis = *one.diagnosis;
  if (!diagnosis.usable) {
    html.paragraph(fmt::format("No diagnosis: {}.", reports::asIs(reports::words(diagnosis.unusable_reason))));
    return;
  }
  html.paragraph(reports::asIs(findingOf(diagnosis)), "finding");
  html.paragraph(figuresOf(diagnosis));
  const std::vector<std::string> actions = diagnosisActions(diagnosis);
  if (!actions.empty()) html.paragraph("What to do:");
  html.list(actions);
  writeTable(html, classesTable(diagnosis.classes, &fallOf));
  if (!reports::namedWords(diagnosis.verdict).empty()) {
    writeTable(html, stiffnessTable(one));
    if (!diagnosis.stated) {
      html.paragraph(
          "No method of identification gives stiffnesses here: these are of the diagnosis's own fit of all load steps, "
          "and U is 1.96 times the standard uncertainty by weights of the noise.",
          "faint");
    }
  }
  html.paragraph(reports::withMicro(reports::reasonWords(diagnosis.verdict)), "faint");
  writeTable(html, gapTable(diagnosis));
  writeOverlaps(html, diagnosis.where);
  writeNotTestable(html, diagnosis.not_testable);
  writeDetectable(html, diagnosis.detectable);
}

}  // namespace

void writeGap(Html& html, const reports::ReportContent& content) {
  const bool any = std::any_of(content.campaigns.begin(), content.campaigns.end(),
                               [](const reports::ReportCampaign& one) { return one.diagnosis != nullptr; });
  if (!any) return;
  writeForEach(html, content, "gap", "What the model misses", isLoaded, [&](const reports::ReportCampaign& one) {
    if (one.diagnosis != nullptr) writeDiagnosis(html, one);
  });
}

namespace {

reports::Table parametersTable(const extended_model::EffectFit& effects) {
  reports::Table table = effectParametersTable("Effects in the model, fitted jointly with the stiffnesses");
  for (const extended_model::AddedEffect& one : effects.added)
    addParameters(reports::effectName(one.effect), one.parameters, table);
  return table;
}

bool seen(const identification::MethodResult& method, int joint) {
  return method.available && method.estimate.identifiable[static_cast<std::size_t>(joint)];
}

reports::Cell stiffnessOf(const identification::MethodResult& method, int joint, const reports::StiffnessUnit& unit) {
  if (!seen(method, joint)) return "–";
  return reports::uncertainStiffness(method.estimate, joint, unit.size);
}

reports::Table stiffnessWithEffectsTable(const extended_model::ExtendedModel& model) {
  const reports::StiffnessUnit unit = reports::stiffnessUnit(model.with);
  reports::Table table{fmt::format("Stiffness k ± U without and with the effects, {}", unit.name), {"Joint"}, {{}}};
  for (const identification::Method method : identification::kMethods) {
    if (!model.without.of(method).available && !model.with.of(method).available) continue;
    table.columns.push_back(reports::shortName(method) + " without");
    table.columns.push_back("with");
  }
  table.id = "effects-stiffness";
  reports::DataTable& data = table.data.emplace();
  data.columns = {"joint",           "method",           "without_nm_per_rad", "u_without_nm_per_rad",
                  "with_nm_per_rad", "u_with_nm_per_rad"};
  for (int joint = 0; joint < static_cast<int>(model.with.identifiability.joints.size()); ++joint) {
    reports::Row shown{reports::jointName(joint)};
    bool any = false;
    for (const identification::Method method : identification::kMethods) {
      const identification::MethodResult &without = model.without.of(method), &with = model.with.of(method);
      if (!without.available && !with.available) continue;
      shown.insert(shown.end(), {stiffnessOf(without, joint, unit), stiffnessOf(with, joint, unit)});
      if (seen(without, joint) || seen(with, joint)) {
        any = true;
        std::vector<reports::DataCell>& row = data.rows.emplace_back();
        row = {joint + 1.0, std::string(reports::namesOf(method).key)};
        for (const identification::MethodResult* one : {&without, &with}) {
          const bool there = seen(*one, joint);
          row.push_back(there ? reports::DataCell(one->estimate.stiffness(joint)) : reports::DataCell());
          row.push_back(there ? reports::DataCell(identification::expandedUncertainty(one->estimate, joint))
                              : reports::DataCell());
        }
      }
    }
    if (any) table.groups.front().rows.push_back(std::move(shown));
  }
  return table;
}

reports::Table residualTable(const extended_model::ExtendedModel& model) {
  reports::Table table{"What is left without and with the effects",
                       {"Method", "rms without (µm)", "rms with (µm)", "Compensated without, held out",
                        "with, held out", "At P_{wrist} without, held out", "At P_{wrist} with, held out"},
                       {{}}};
  table.id = "effects-residuals";
  reports::DataTable& data = table.data.emplace();
  data.columns = {"method",
                  "rms_without_um",
                  "rms_with_um",
                  "held_out_at_reflectors_without_percent",
                  "held_out_at_reflectors_with_percent",
                  "held_out_at_wrist_without_percent",
                  "held_out_at_wrist_with_percent"};
  const auto cell = [](const identification::MethodResult& method, bool at_wrist) {
    const auto held_out = reports::heldOut(method, at_wrist);
    return held_out ? reports::DataCell(100.0 * *held_out) : reports::DataCell();
  };
  const auto share = [](const identification::MethodResult& method, bool at_wrist) {
    const auto held_out = reports::heldOut(method, at_wrist);
    return held_out ? reports::percent(*held_out) : std::string("–");
  };
  for (const identification::Method method : identification::kMethods) {
    const identification::MethodResult &without = model.without.of(method), &with = model.with.of(method);
    if (!without.available || !with.available) continue;
    table.groups.front().rows.push_back(
        {reports::longName(method), reports::fixed(without.estimate.rms_residual / io::kMicrometre, 1),
         reports::fixed(with.estimate.rms_residual / io::kMicrometre, 1), share(without, false), share(with, false),
         share(without, true), share(with, true)});
    data.rows.push_back({std::string(reports::namesOf(method).key), without.estimate.rms_residual / io::kMicrometre,
                         with.estimate.rms_residual / io::kMicrometre, cell(without, false), cell(with, false),
                         cell(without, true), cell(with, true)});
  }
  return table;
}

/// How the sum of the budget leads to the stated U: below it, and no part of it.
void addExpanded(const identification::StiffnessEstimate& estimate, reports::Table& table) {
  reports::Row factors{"U over u: coverage factor"}, stated{"U: farther end of the stated interval"};
  std::vector<reports::DataCell> cells(estimate.identifiable.size());
  for (int j = 0; j < estimate.joints(); ++j) {
    if (!estimate.identifiable[static_cast<std::size_t>(j)]) continue;
    const double k = std::abs(estimate.stiffness(j)), u = estimate.stiffnessSd(j) / k,
                 expanded = identification::expandedUncertainty(estimate, j) / k;
    // Where the interval itself stands instead of U there is none to be led to.
    const bool known = std::isfinite(expanded) && !reports::farFromSymmetric(estimate, j);
    factors.emplace_back(known ? reports::fixed(expanded / u, 2) : "–");
    stated.emplace_back(known ? reports::fixed(100.0 * expanded, 2) : "–");
    if (std::isfinite(expanded)) cells[static_cast<std::size_t>(j)] = 100.0 * expanded;
  }
  table.groups.push_back({"", {std::move(factors), std::move(stated)}});
  cells.insert(cells.begin(), {std::string("U"), 1.0});
  table.data->rows.push_back(std::move(cells));
}

/// Of the method that stands for the campaign: standard uncertainties of k in per cent, largest lines.
reports::Table budgetTable(const extended_model::ExtendedModel& model) {
  const identification::Method which = identification::bestMethod(model.with);
  const identification::StiffnessEstimate& estimate = model.with.of(which).estimate;
  reports::Table table{
      fmt::format("Where the uncertainty comes from, {}: standard uncertainty of k, %", reports::shortName(which)),
      {"Source"},
      {{}}};
  table.id = "budget";
  reports::DataTable& data = table.data.emplace();
  data.columns = {"source", "shown_on_page"};
  for (int j = 0; j < estimate.joints(); ++j) data.columns.push_back(fmt::format("u_k{}_percent", j + 1));
  for (int j = 0; j < estimate.joints(); ++j) {
    if (estimate.identifiable[static_cast<std::size_t>(j)]) table.columns.push_back(reports::jointName(j));
  }
  const auto add = [&](const std::string& name, const JointVector& variance, bool always) {
    reports::Row row{name};
    std::vector<reports::DataCell> cells(estimate.identifiable.size());
    constexpr double kShown = 0.05 * 0.05;  // a twentieth of the whole
    bool shown = always;
    for (int j = 0; j < estimate.joints(); ++j) {
      if (!estimate.identifiable[static_cast<std::size_t>(j)]) continue;
      shown = shown || std::abs(variance[j]) > kShown * estimate.covariance(j, j);
      const double share = 100.0 * std::sqrt(std::abs(variance[j])) / std::abs(estimate.compliance[j]);
      row.emplace_back(reports::fixed(variance[j] < 0.0 ? -share : share, 2));
      cells[static_cast<std::size_t>(j)] = variance[j] < 0.0 ? -share : share;
    }
    if (shown) table.groups.front().rows.push_back(std::move(row));
    cells.insert(cells.begin(), {name, shown ? 1.0 : 0.0});
    data.rows.push_back(std::move(cells));
  };
  for (const extended_model::BudgetLine& line : model.hidden->budget[static_cast<std::size_t>(which)])
    add(reports::budgetWords(line), line.variance, line.in_model);
  add("together", estimate.covariance.diagonal(), true);
  addExpanded(estimate, table);
  return table;
}

void writeHidden(Html& html, const extended_model::ExtendedModel& model) {
  if (!model.hidden) return;
  html.paragraph(reports::asIs(reports::residualWords(model)));
  writeTable(html, budgetTable(model));
  html.paragraph(
      "As fitted: of an effect's size in the model. Could hide: of all sizes that the data leave possible. Effects in "
      "common: negative where effects are known better together than one by one. U is taken from the interval that "
      "holds 95\u00a0% of what the data leave possible: what could hide has longer tails than a normal distribution, "
      "not alike on both sides, so that U over u need not be 1.96. Where the interval itself stands for U there is "
      "none here (–).",
      "faint");
  const identification::Method which = identification::bestMethod(model.with);
  std::vector<std::string> combinations;
  for (const extended_model::SeenCombination& one : model.hidden->combinations[static_cast<std::size_t>(which)]) {
    std::string words = reports::withMicro(reports::combinationWords(one));
    if (const std::size_t at = words.find("1e-9"); at != std::string::npos) words.replace(at, 4, "10⁻⁹");
    combinations.push_back(reports::asIs(words));
  }
  html.list(combinations);
}

/// Effects in the model that the diagnosis does not name, with why they are there; empty where it names all.
std::string keptWords(const extended_model::ExtendedModel& model, const diagnosis::Diagnosis* diagnosis) {
  if (diagnosis == nullptr || !diagnosis->usable) return {};
  std::vector<effects::Effect> kept;
  for (const extended_model::AddedEffect& one : model.effects.added) {
    const auto& entries = diagnosis->verdict.entries;
    const bool named = std::any_of(entries.begin(), entries.end(), [&one](const diagnosis::VerdictEntry& entry) {
      return std::find(entry.effects.begin(), entry.effects.end(), one.effect) != entry.effects.end();
    });
    if (!named) kept.push_back(one.effect);
  }
  if (kept.empty()) return {};
  const bool several = kept.size() > 1;
  const std::string begin = fmt::format("{} {} in the model although the diagnosis does not name {}",
                                        reports::capitalised(reports::effectNames(kept, " and ")),
                                        several ? "are" : "is", several ? "them" : "it");
  if (!model.hidden) return begin + ": the effects were asked for.";
  return begin +
         ": the model keeps what predicts postures left out better than joint springs alone; a name has also to "
         "leave little of the gap, and nothing that speaks against it.";
}

void writeModel(Html& html, const extended_model::ExtendedModel& model, const diagnosis::Diagnosis* diagnosis) {
  html.paragraph(reports::asIs(reports::gainWords(model)));
  std::vector<std::string> uses;
  for (const extended_model::AddedEffect& one : model.effects.added) {
    const std::string doubt = reports::doubtOf(one);
    uses.push_back(reports::asIs(fmt::format("{}: {}{}.", reports::effectName(one.effect),
                                             reports::effectUse(one.effect), doubt.empty() ? "" : "; " + doubt)));
  }
  for (const effects::Effect effect : model.effects.geometry)
    uses.push_back(reports::asIs(fmt::format("{}: {}.", reports::effectName(effect), reports::effectUse(effect))));
  if (!model.effects.added.empty()) {
    for (const std::string& note : reports::words(model.effects.notes)) uses.push_back(reports::asIs(note + "."));
  }
  html.list(uses);
  if (const std::string kept = keptWords(model, diagnosis); !kept.empty()) html.paragraph(kept);
  if (model.effects.added.empty()) {
    writeHidden(html, model);
    return;
  }
  writeTable(html, parametersTable(model.effects));
  html.paragraph(reports::asIs(reports::explainedWords(model.effects)), "faint");
  writeTable(html, stiffnessWithEffectsTable(model));
  writeTable(html, residualTable(model));
  html.paragraph(
      "Every other number and picture of this page, diagnosis and audit aside, is of the model with the effects: what "
      "they do is taken off the readings, and stiffnesses are those of the joint springs beside them. Their own "
      "uncertainty is in every ±. Shares are of the machine's deflection, effects of the machine in it; the effects "
      "were fitted anew on the postures of every subset.",
      "faint");
  writeHidden(html, model);
}

}  // namespace

void writeExtendedModel(Html& html, const reports::ReportContent& content) {
  const bool any = std::any_of(content.campaigns.begin(), content.campaigns.end(),
                               [](const reports::ReportCampaign& one) { return one.improved != nullptr; });
  if (!any) return;
  writeForEach(html, content, "effects", "Effects in the model", isLoaded, [&](const reports::ReportCampaign& one) {
    if (one.improved != nullptr) writeModel(html, *one.improved, one.diagnosis);
  });
}

}  // namespace stiffscope::page
