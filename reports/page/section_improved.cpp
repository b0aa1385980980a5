#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/improved/effect_nature.h"
#include "core/input/units.h"
#include "reports/improved_words.h"
#include "reports/page/coverage.h"
#include "reports/page/effect_words.h"
#include "reports/page/html_table.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"
#include "reports/page/sections.h"

namespace stiffscope::page {

namespace {

/// The power of ten, a multiple of three, that brings a size near one; 0 where it is near enough.
int powerFor(double size) {
  constexpr double kLargest = 1e6, kSmallest = 1e-3;
  if (!(size > 0.0) || !std::isfinite(size) || (size < kLargest && size >= kSmallest)) return 0;
  return 3 * static_cast<int>(std::floor(std::log10(size) / 3.0));
}

/// "10⁻⁶".
std::string powerOfTen(int power) {
  static constexpr std::array<const char*, 10> kDigits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = power < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(power))) text += kDigits[static_cast<std::size_t>(digit - '0')];
  return text;
}

/// Of all parameters of one unit, so that they can be compared.
int powerFor(const std::vector<EffectParameter>& parameters, const std::string& unit) {
  double largest = 0.0;
  for (const EffectParameter& one : parameters) {
    if (one.unit == unit) largest = std::max({largest, std::abs(one.value), one.sd});
  }
  return powerFor(largest);
}

Row parameterRow(const EffectParameter& parameter, int power) {
  const double unit = std::pow(10.0, power);
  return {asIs(parameter.name.empty() ? "size" : parameter.name),
          withUncertainty(parameter.value / unit, parameter.sd / unit),
          power == 0 ? parameter.unit : fmt::format("{}\u00a0{}", powerOfTen(power), parameter.unit)};
}

Table parametersTable(const EffectFit& effects) {
  Table table{"Effects in the model, fitted jointly with the stiffnesses", {"Effect", "Parameter", "Value ± u", "Unit"}, {}};
  table.id = "effects";
  for (const AddedEffect& one : effects.added) {
    RowGroup group{effectName(one.effect), {}};
    for (const EffectParameter& parameter : one.parameters) {
      group.rows.push_back(parameterRow(parameter, powerFor(one.parameters, parameter.unit)));
    }
    table.groups.push_back(std::move(group));
  }
  return table;
}

bool seen(const MethodResult& method, int joint) {
  return method.available && method.estimate.identifiable[static_cast<std::size_t>(joint)];
}

Cell stiffnessOf(const MethodResult& method, int joint) {
  if (!seen(method, joint)) return "–";
  const double expanded = coverageOf(method.estimate, joint).factor * method.estimate.stiffnessSd(joint);
  return withUncertainty(1e-6 * method.estimate.stiffness(joint), 1e-6 * expanded);
}

Table stiffnessWithEffectsTable(const ImprovedModel& model) {
  Table table{"Stiffness k ± U without and with the effects, 10⁶\u00a0Nm/rad", {"Joint", "Method", "Without", "With"}, {}};
  table.id = "effects-stiffness";
  for (int joint = 0; joint < 6; ++joint) {
    RowGroup group{jointName(joint), {}};
    for (const Method method : kMethods) {
      const MethodResult &without = model.without.of(method), &with = model.with.of(method);
      if (seen(without, joint) || seen(with, joint))
        group.rows.push_back({shortName(method), stiffnessOf(without, joint), stiffnessOf(with, joint)});
    }
    if (!group.rows.empty()) table.groups.push_back(std::move(group));
  }
  return table;
}

Table residualTable(const ImprovedModel& model) {
  Table table{"What is left without and with the effects",
              {"Method", "rms without (µm)", "rms with (µm)", "Compensated without, held out", "with, held out"},
              {{}}};
  table.id = "effects-residuals";
  const auto share = [](const MethodResult& method) {
    const auto held_out = heldOut(method, false);
    return held_out ? percent(*held_out) : std::string("–");
  };
  for (const Method method : kMethods) {
    const MethodResult &without = model.without.of(method), &with = model.with.of(method);
    if (!without.available || !with.available) continue;
    table.groups.front().rows.push_back({longName(method), fixed(without.estimate.rms_residual / kMicrometre, 1),
                                         fixed(with.estimate.rms_residual / kMicrometre, 1), share(without), share(with)});
  }
  return table;
}

void writeModel(Html& html, const ImprovedModel& model) {
  html.paragraph(asIs(gainWords(model)));
  std::vector<std::string> uses;
  for (const AddedEffect& one : model.effects.added) {
    const std::string doubt = doubtOf(one);
    uses.push_back(asIs(fmt::format("{}: {}{}.", effectName(one.effect), useOf(one.effect), doubt.empty() ? "" : "; " + doubt)));
  }
  for (const Effect effect : model.effects.geometry)
    uses.push_back(asIs(fmt::format("{}: {}.", effectName(effect), useOf(effect))));
  if (!model.effects.added.empty()) {
    for (const std::string& note : model.effects.notes) uses.push_back(asIs(note + "."));
  }
  html.list(uses);
  if (model.effects.added.empty()) return;
  writeTable(html, parametersTable(model.effects));
  html.paragraph(asIs(explainedWords(model.effects)), "faint");
  writeTable(html, stiffnessWithEffectsTable(model));
  writeTable(html, residualTable(model));
  html.paragraph(
      "Every other number and picture of this page, the diagnosis aside, is of the model with the effects: what they do is taken off the readings, "
      "and stiffnesses are those of the joint springs beside them. Their own uncertainty is in every ±. Shares are of the "
      "machine's deflection, effects of the machine in it; the effects were fitted anew on the postures of every subset.",
      "faint");
}

}  // namespace

void writeImproved(Html& html, const ReportContent& content) {
  const bool any = std::any_of(content.campaigns.begin(), content.campaigns.end(),
                               [](const ReportCampaign& one) { return one.improved != nullptr; });
  if (!any) return;
  writeForEach(html, content, "effects", "Effects in the model", [&](const ReportCampaign& one) {
    if (one.improved != nullptr) writeModel(html, *one.improved);
  });
}

}  // namespace stiffscope::page
