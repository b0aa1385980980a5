#include "core/conformity/decide.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <string_view>

#include "core/io/csv.h"
#include "core/io/input_error.h"
#include "core/io/numbers.h"
#include "core/io/read_file.h"
#include "core/io/units.h"

namespace stiffscope::conformity {

const std::vector<QuantityName>& quantityNames() {
  constexpr double kPercent = 0.01, kNewtonsPerMicrometre = 1.0 / io::kMicrometre;
  static const std::vector<QuantityName> names{
      {Quantity::k1, "k1_nm_per_rad", 1.0},
      {Quantity::k2, "k2_nm_per_rad", 1.0},
      {Quantity::k3, "k3_nm_per_rad", 1.0},
      {Quantity::k4, "k4_nm_per_rad", 1.0},
      {Quantity::k5, "k5_nm_per_rad", 1.0},
      {Quantity::k6, "k6_nm_per_rad", 1.0},
      {Quantity::k7, "k7_nm_per_rad", 1.0},
      {Quantity::k8, "k8_nm_per_rad", 1.0},
      {Quantity::compensated_at_reflectors, "compensated_at_reflectors_percent", kPercent},
      {Quantity::compensated_at_wrist, "compensated_at_wrist_percent", kPercent},
      {Quantity::softest, "softest_at_tcp_n_per_um", kNewtonsPerMicrometre},
      {Quantity::avoided, "avoided_by_encoders_percent", kPercent},
      {Quantity::nominal_rms, "nominal_error_rms_mm", io::kMillimetre},
      {Quantity::nominal_largest, "nominal_error_largest_mm", io::kMillimetre},
      {Quantity::calibrated_rms, "calibrated_error_rms_mm", io::kMillimetre},
      {Quantity::calibrated_largest, "calibrated_error_largest_mm", io::kMillimetre},
      {Quantity::link_difference, "link_difference_largest_mm", io::kMillimetre}};
  return names;
}

const QuantityName& nameOf(Quantity quantity) { return quantityNames()[static_cast<std::size_t>(quantity)]; }

namespace {

constexpr std::array<const char*, 4> kColumns{"name", "least", "most", "reason"};

/// Where the columns stand in the header; a limit's columns may be left out, but for name and reason.
struct LimitColumns {
  std::array<std::optional<std::size_t>, kColumns.size()> at;

  std::string_view cell(const std::vector<std::string_view>& cells, std::size_t column) const {
    return at[column] && *at[column] < cells.size() ? cells[*at[column]] : std::string_view();
  }
};

LimitColumns columnsOf(const std::string& file, std::size_t line, const std::vector<std::string_view>& header) {
  const std::vector<std::string> known(kColumns.begin(), kColumns.end());
  LimitColumns columns;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string name(header[i]);
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end())
      throw io::InputError(
          {file, line, name}, "",
          "not a column of a file of limits; expected name, least, most, reason" + io::nearestNameHint(name, known));
    auto& place = columns.at[static_cast<std::size_t>(found - known.begin())];
    if (place) throw io::InputError({file, line, name}, "", "this column stands there twice");
    place = i;
  }
  for (const std::size_t needed : {std::size_t{0}, std::size_t{3}}) {
    if (!columns.at[needed])
      throw io::InputError({file, line, kColumns[needed]}, "", "this column is missing from the first line");
  }
  return columns;
}

Quantity quantityNamed(const std::string& file, std::size_t line, const std::string& name) {
  std::vector<std::string> known;
  for (const QuantityName& one : quantityNames()) {
    if (name == one.name) return one.quantity;
    known.emplace_back(one.name);
  }
  std::string all;
  for (const std::string& one : known) all += (all.empty() ? "" : ", ") + one;
  const std::string hint = io::nearestNameHint(name, known);
  throw io::InputError({file, line, "name"}, name,
                       "no limit can be on this" + (hint.empty() ? "; expected one of " + all : hint));
}

std::optional<double> numberIn(const std::string& file, std::size_t line, const char* column, std::string_view cell) {
  if (cell.empty()) return std::nullopt;
  const io::ParsedNumber number = io::parseNumber(cell);
  if (!number.expectation.empty()) throw io::InputError({file, line, column}, std::string(cell), number.expectation);
  return number.value;
}

Limit limitOf(const std::string& file, std::size_t line, const LimitColumns& columns,
              const std::vector<std::string_view>& cells) {
  Limit limit;
  limit.line = line;
  limit.quantity = quantityNamed(file, line, std::string(columns.cell(cells, 0)));
  const double unit = nameOf(limit.quantity).unit;
  if (const auto least = numberIn(file, line, "least", columns.cell(cells, 1))) limit.least = *least * unit;
  if (const auto most = numberIn(file, line, "most", columns.cell(cells, 2))) limit.most = *most * unit;
  if (!limit.least && !limit.most)
    throw io::InputError({file, line, "least"}, "", "expected a number here or in the column most");
  if (limit.least && limit.most && *limit.least > *limit.most)
    throw io::InputError({file, line, "least"}, std::string(columns.cell(cells, 1)),
                         fmt::format("expected no more than most, {}", columns.cell(cells, 2)));
  limit.reason = std::string(columns.cell(cells, 3));
  if (limit.reason.empty())
    throw io::InputError({file, line, "reason"}, "", "expected who asks for this limit, and why");
  return limit;
}

}  // namespace

Limits readLimits(const std::filesystem::path& path) {
  constexpr std::size_t kLargestLimits = std::size_t{1} << 20;  // a row takes a hundred bytes
  const std::string file = path.string();
  const std::string bytes = io::readTextFile(path, kLargestLimits);
  Limits limits{path.filename().string(), io::sha256Hex(bytes), {}};
  io::CsvLines lines(file, bytes);
  std::vector<std::string_view> cells;
  if (!lines.next(cells))
    throw io::InputError({file}, "", "expected a first line with the columns name, least, most, reason");
  const LimitColumns columns = columnsOf(file, lines.line(), cells);
  while (lines.next(cells)) {
    const std::size_t width =
        std::count_if(columns.at.begin(), columns.at.end(), [](const auto& at) { return at.has_value(); });
    if (lines.cellCount() != width)
      throw io::InputError(
          {file, lines.line()}, "",
          fmt::format("{} cells, expected {} as in the first line; a reason with a comma stands in double quotes",
                      lines.cellCount(), width));
    Limit limit = limitOf(file, lines.line(), columns, cells);
    for (const Limit& other : limits.limits) {
      if (other.quantity == limit.quantity)
        throw io::InputError(
            {file, lines.line(), "name"}, nameOf(limit.quantity).name,
            fmt::format("line {} has a limit on this already; least and most may stand in one row", other.line));
    }
    limits.limits.push_back(std::move(limit));
  }
  if (limits.limits.empty()) throw io::InputError({file}, "", "expected a row below the first line: there is no limit");
  return limits;
}

}  // namespace stiffscope::conformity
