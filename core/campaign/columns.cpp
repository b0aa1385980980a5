#include "core/campaign/columns.h"

#include <fmt/format.h>
#include <cmath>

#include "core/campaign/campaign.h"
#include "core/io/input_error.h"
#include "core/io/numbers.h"

namespace stiffscope::campaign {

namespace {

[[noreturn]] void refuse(const CellPlace& place, std::string_view value, const std::string& expectation) {
  throw io::InputError({place.file, place.line, std::string(place.column)}, std::string(value), expectation);
}

int readTarget(std::string_view cell, const CellPlace& place, const CampaignNames& names) {
  const auto& known = names.targets.names();
  // Tools have a few reflectors: comparing with each is quicker than a hash.
  constexpr std::size_t kFew = 8;
  for (std::size_t k = 0; k < known.size() && known.size() <= kFew; ++k) {
    if (known[k] == cell) return static_cast<int>(k);
  }
  const int target = names.targets.find(cell);
  if (target >= 0) return target;
  const std::string list = fmt::format("{}", fmt::join(known, ", "));
  refuse(place, cell,
         "expected a target that campaign.xml declares: " + (known.empty() ? "there is none" : list) +
             io::nearestNameHint(cell, known));
}

}  // namespace

double readNumberCell(CellKind kind, std::string_view cell, const CellPlace& place) {
  const io::ParsedNumber number = io::parseNumber(cell);
  if (!number.expectation.empty()) refuse(place, cell, number.expectation);
  const NumberKind& info = numberKind(kind);
  if (std::abs(number.value) > info.limit) refuse(place, cell, info.expectation);
  return number.value * info.si_per_unit;
}

int readIndexCell(CellKind kind, std::string_view cell, const CellPlace& place, CampaignNames& names) {
  if (cell.empty()) refuse(place, cell, "expected a value; the cell is empty");
  if (kind == CellKind::target) return readTarget(cell, place, names);
  if (kind == CellKind::pose) return names.poses.add(cell);
  if (kind == CellKind::nest) return names.nests.add(cell);
  if (kind == CellKind::station) return names.stations.add(cell);
  if (kind == CellKind::repeat) return repeatOf(cell, names.repeats);
  const std::optional<int> number = io::parseInteger(cell);
  if (kind == CellKind::axis) {
    if (!number || *number < 1 || *number > names.axes)
      refuse(place, cell, fmt::format("expected an axis, 1 to {}", names.axes));
    return *number - 1;
  }
  if (!number || *number < 0) refuse(place, cell, "expected a whole number, 0 or more");
  return *number;
}

int repeatOf(std::string_view text, NameList& names) {
  const std::optional<int> number = io::parseInteger(text);
  const bool as_one_is_written = number && *number >= 0 && (text.front() != '0' || text.size() == 1);
  return as_one_is_written ? *number : repeatByName(names.add(text));
}

std::string readTextCell(std::string_view cell, const CellPlace& place) {
  if (cell.empty()) refuse(place, cell, "expected a value; the cell is empty");
  return std::string(cell);
}

}  // namespace stiffscope::campaign
