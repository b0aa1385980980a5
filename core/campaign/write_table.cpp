#include "core/campaign/write_table.h"

#include <fmt/format.h>

#include <stdexcept>

namespace stiffscope {

namespace {

[[noreturn]] void fail(const std::string& column, const std::string& why) {
  throw std::runtime_error(fmt::format("the campaign cannot be written: {}: {}", column, why));
}

}  // namespace

std::string writtenNumber(CellKind kind, double si_value, const std::string& column) {
  if (!std::isfinite(si_value)) fail(column, "a value is not finite");
  const NumberKind& info = numberKind(kind);
  std::string text = fmt::format("{:.{}f}", si_value / info.si_per_unit, info.decimals);
  if (text.find_first_not_of("-0.") == std::string::npos && text[0] == '-') text.erase(0, 1);
  return text;
}

std::string writtenName(const std::string& name, const std::string& column) {
  if (name.empty()) fail(column, "a name is empty");
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::any_of(name.begin(), name.end(), is_control)) fail(column, "a name has a control character");
  const bool plain =
      name.find_first_of(",\";") == std::string::npos && name.front() != ' ' && name.back() != ' ';
  if (plain) return name;
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string writtenIndex(CellKind kind, int index, const CampaignNames& names, const std::string& column) {
  if (kind == CellKind::axis) return fmt::format("{}", index + 1);
  if (kind == CellKind::step) return fmt::format("{}", index);
  const std::vector<std::string>& known = kind == CellKind::target ? names.targets.names()
                                          : kind == CellKind::pose ? names.poses.names()
                                                                   : names.nests.names();
  if (index < 0 || static_cast<std::size_t>(index) >= known.size()) {
    fail(column, fmt::format("index {} has no name", index));
  }
  return writtenName(known[static_cast<std::size_t>(index)], column);
}

}  // namespace stiffscope
