#include "reports/page/diagnosis_tables.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

namespace stiffscope::page {

std::string inUm(double metres) { return lengthIn(metres, {}); }

std::string lengthIn(double metres, const reports::LengthUnit& unit) {
  // To a tenth of a micrometre, or three places of a millimetre.
  return reports::fixed(metres / unit.size, unit.size < io::kMillimetre ? 1 : 3);
}

std::string shareOf(double shrink, int decimals) {
  if (std::isnan(shrink)) return "–";
  return shrink < -1.0 ? "below −100" : reports::fixed(100.0 * shrink, decimals);
}

int placesOf(const diagnosis::Shrink& shrink) {
  return reports::placesThatTell(100.0 * shrink.low, 100.0 * shrink.high);
}

std::string interval(const diagnosis::Shrink& shrink) {
  if (!shrink.judged() || shrink.high < -1.0) return "–";
  const int places = placesOf(shrink);
  return fmt::format("{} to {}", shareOf(shrink.low, places), shareOf(shrink.high, places));
}

namespace {

/// In the verdict although its shrink may be nothing.
bool namedOtherwise(bool in_verdict, const diagnosis::Shrink& shrink) {
  return in_verdict && shrink.low <= 0.0 && shrink.high > shrink.low;
}

}  // namespace

std::string whyNamed(const diagnosis::EffectClass& one) {
  if (!namedOtherwise(one.in_verdict, one.shrink)) return {};
  switch (one.effects.front()) {
    case effects::Effect::kinematic_error:
      return "by sweeps and unloaded positions; deflections hardly feel it";
    case effects::Effect::tracker_drift:
    case effects::Effect::frame_error:
      return "by floor nests or the fall of BIC, not by this shrink";
    default:
      return "by the fall of BIC, not by this shrink";
  }
}

std::string whyNamed(const accuracy::AccuracyClass& one) {
  if (!namedOtherwise(one.in_verdict, one.shrink)) return {};
  if (one.effects.front() == calibration::UnloadedEffect::kinematic_error)
    return "the nominal geometry misses by more than is allowed";
  return "by the fall of BIC and its size; this shrink may be chance";
}

namespace {

const diagnosis::WhereRow* rowOf(const std::vector<diagnosis::WhereTable>& tables, const std::string& by,
                                 const std::string& name) {
  for (const diagnosis::WhereTable& table : tables) {
    if (table.by != by) continue;
    for (const diagnosis::WhereRow& row : table.rows) {
      if (row.name == name) return &row;
    }
  }
  return nullptr;
}

reports::LengthUnit unitOf(const std::vector<diagnosis::WhereTable>& tables) {
  double largest = 0.0;
  for (const diagnosis::WhereTable& table : tables) {
    for (const diagnosis::WhereRow& row : table.rows) largest = std::max(largest, row.rms);
  }
  return reports::lengthUnit(largest);
}

}  // namespace

reports::Table whereTable(const std::string& caption, const std::string& heading,
                          const std::vector<diagnosis::WhereTable>& where, const WhereBeside& beside) {
  const reports::LengthUnit unit = unitOf(where), unit_beside = unitOf(beside.tables);
  const auto headed = [](const std::string& name, const reports::LengthUnit& of) {
    return fmt::format("{} ({})", name, of.name);
  };
  reports::Table table{caption,
                       {"By", "Part", headed(heading, unit), headed("Noise", unit), "Share (%)", "Above noise (sd)"},
                       {},
                       false,
                       "gap"};
  const bool more = !beside.tables.empty();
  if (more) table.columns.push_back(headed(beside.heading, unit_beside));
  if (more && beside.noise) table.columns.push_back(headed("Noise", unit_beside));
  reports::DataTable& data = table.data.emplace();
  data.columns = {"by", "part", "rms_um", "noise_um", "share_percent", "above_noise_sd"};
  if (more) data.columns.emplace_back("beside_rms_um");
  if (more && beside.noise) data.columns.emplace_back("beside_noise_um");
  for (const diagnosis::WhereTable& one : where) {
    for (const diagnosis::WhereRow& row : one.rows) {
      std::vector<reports::DataCell> cells{
          one.by,          row.name, row.rms / io::kMicrometre, row.noise / io::kMicrometre, 100.0 * row.share,
          row.significance};
      const diagnosis::WhereRow* other = more ? rowOf(beside.tables, one.by, row.name) : nullptr;
      const auto beside_cell = [&](double diagnosis::WhereRow::*member) {
        return other ? reports::DataCell(other->*member / io::kMicrometre) : reports::DataCell();
      };
      if (more) cells.push_back(beside_cell(&diagnosis::WhereRow::rms));
      if (more && beside.noise) cells.push_back(beside_cell(&diagnosis::WhereRow::noise));
      data.rows.push_back(std::move(cells));
    }
  }
  for (const diagnosis::WhereTable& one : where) {
    if (one.by == "posture") continue;  // a figure, and results.json
    reports::RowGroup group{one.by, {}};
    for (const diagnosis::WhereRow& row : one.rows) {
      reports::Row cells{reports::asIs(row.name), lengthIn(row.rms, unit), lengthIn(row.noise, unit),
                         reports::fixed(100.0 * row.share, 0), reports::asIs(reports::deviateWords(row.significance))};
      const diagnosis::WhereRow* other = more ? rowOf(beside.tables, one.by, row.name) : nullptr;
      if (more) cells.emplace_back(other ? lengthIn(other->rms, unit_beside) : "–");
      if (more && beside.noise) cells.emplace_back(other ? lengthIn(other->noise, unit_beside) : "–");
      group.rows.push_back(std::move(cells));
    }
    table.groups.push_back(std::move(group));
  }
  return table;
}

void writeOverlaps(Html& html, const std::vector<diagnosis::WhereTable>& where) {
  for (const diagnosis::WhereTable& table : where) {
    if (table.overlaps) html.paragraph("By " + table.by + ": " + reports::overlapWords(table), "faint");
  }
}

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
int powerFor(const std::vector<extended_model::EffectParameter>& parameters, const std::string& unit) {
  double largest = 0.0;
  for (const extended_model::EffectParameter& one : parameters) {
    if (one.unit == unit) largest = std::max({largest, std::abs(one.value), one.sd});
  }
  return powerFor(largest);
}

reports::Row parameterRow(const extended_model::EffectParameter& parameter, int power) {
  const double unit = std::pow(10.0, power);
  return {reports::asIs(parameter.name.empty() ? "size" : parameter.name),
          reports::withUncertainty(parameter.value / unit, reports::expanded(parameter.sd) / unit),
          power == 0 ? parameter.unit : fmt::format("{}\u00a0{}", powerOfTen(power), parameter.unit)};
}

}  // namespace

reports::Table effectParametersTable(const std::string& caption) {
  reports::Table table{caption, {"Effect", "Parameter", "Value ± U", "Unit"}, {}};
  table.id = "effects";
  table.data = reports::DataTable{{"effect", "parameter", "value", "u", "unit"}, {}};
  return table;
}

void addParameters(const std::string& effect, const std::vector<extended_model::EffectParameter>& parameters,
                   reports::Table& table) {
  reports::RowGroup group{effect, {}};
  for (const extended_model::EffectParameter& parameter : parameters) {
    group.rows.push_back(parameterRow(parameter, powerFor(parameters, parameter.unit)));
    table.data->rows.push_back({effect, parameter.name.empty() ? std::string("size") : parameter.name, parameter.value,
                                reports::expanded(parameter.sd), parameter.unit});
  }
  table.groups.push_back(std::move(group));
}

}  // namespace stiffscope::page
