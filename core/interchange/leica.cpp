#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <optional>

#include "core/interchange/length_unit.h"
#include "core/interchange/point_formats.h"
#include "core/io/input_error.h"

namespace stiffscope::interchange {

namespace {

/// A column by its name: what it holds, of which axis, in which unit.
struct LeicaColumn {
  enum class Kind { other, coordinate, expanded, standard, quaternion, name, target, group, time };
  Kind kind = Kind::other;
  int axis = -1;
  std::optional<double> unit;
  std::string title;  ///< as the header has it
};

/// What stands in the last pair of brackets; the name without it.
std::string unitOf(std::string& name) {
  if (name.empty() || (name.back() != ']' && name.back() != ')')) return {};
  const std::size_t open = name.rfind(name.back() == ']' ? '[' : '(');
  if (open == std::string::npos) return {};
  const std::string unit(trimmed(std::string_view(name).substr(open + 1, name.size() - open - 2)));
  name.erase(open);
  return unit;
}

/// Cuts U(95), U95 or U 95 % out of a name.
bool cutExpanded(std::string& name) {
  for (const char* mark : {"u(95%)", "u(95 %)", "u(95)", "u95", "u 95", "u_95"}) {
    const std::size_t at = name.find(mark);
    if (at == std::string::npos) continue;
    name.replace(at, std::string_view(mark).size(), " ");
    return true;
  }
  return false;
}

std::vector<std::string> partsOfName(const std::string& name) {
  std::vector<std::string> parts(1);
  for (const char c : name) {
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || (c & 0x80) != 0) {
      parts.back() += c;
    } else if (!parts.back().empty()) {
      parts.emplace_back();
    }
  }
  return parts;
}

bool hasPart(const std::vector<std::string>& parts, std::initializer_list<std::string_view> wanted) {
  return std::any_of(parts.begin(), parts.end(), [&](const std::string& part) {
    return std::find(wanted.begin(), wanted.end(), part) != wanted.end();
  });
}

/// Whether a column of a coordinate has what the coordinate should be, or how far from there it is.
bool isNotMeasured(const std::vector<std::string>& parts) {
  return hasPart(parts,
                 {"nominal", "nominals", "nom",        "soll",        "sollwert",   "ref",   "reference",  "referenz",
                  "design",  "cad",      "theo",       "theoretical", "expected",   "delta", "\xCE\x94",   "\xCE\xB4",
                  "d",       "dev",      "deviation",  "abw",         "abweichung", "diff",  "difference", "differenz",
                  "error",   "err",      "fehler",     "residual",    "residuum",   "tol",   "tolerance",  "toleranz",
                  "offset",  "corr",     "correction", "korrektur",   "min",        "max",   "range"});
}

LeicaColumn columnNamed(std::string_view header) {
  using Kind = LeicaColumn::Kind;
  LeicaColumn column;
  column.title = cellText(header);
  std::string name = lowered(column.title);
  const bool expanded = cutExpanded(name);
  name = std::string(trimmed(name));
  column.unit = metresIn(unitOf(name));
  const std::vector<std::string> parts = partsOfName(name);
  for (int axis = 0; axis < 3; ++axis) {
    const std::string letter(1, static_cast<char>('x' + axis));
    if (hasPart(parts, {letter, "pos" + letter, "coord" + letter})) column.axis = axis;
  }
  const bool quaternion = std::any_of(parts.begin(), parts.end(), [](const std::string& part) {
    return part.starts_with("quat") || (part.size() == 2 && part[0] == 'q');
  });
  const bool turned =
      quaternion || hasPart(parts, {"rot", "rotation", "angle", "rx", "ry", "rz", "roll", "pitch", "yaw"});
  const bool standard = hasPart(parts, {"std", "sd", "sigma", "stddev", "stdev", "standard", "standardabweichung"});
  const bool length = column.axis >= 0 && column.unit && !turned && (standard || !isNotMeasured(parts));
  if (quaternion)
    column.kind = Kind::quaternion;
  else if (length && expanded)
    column.kind = Kind::expanded;
  else if (length && standard)
    column.kind = Kind::standard;
  else if (length)
    column.kind = Kind::coordinate;
  else if (hasPart(parts, {"time", "timestamp", "datetime", "date", "zeit", "zeitstempel"}))
    column.kind = Kind::time;
  else if (hasPart(parts, {"name", "point", "punkt", "pointname", "pointid"}))
    column.kind = Kind::name;
  else if (hasPart(parts, {"target", "reflector", "reflektor", "ziel"}))
    column.kind = Kind::target;
  else if (hasPart(parts, {"group", "gruppe", "job", "set"}))
    column.kind = Kind::group;
  return column;
}

struct LeicaHeader {
  std::size_t line = 0;  ///< 0: there is none
  char separator = ',';
  std::vector<LeicaColumn> columns;
  std::array<int, 3> coordinates{-1, -1, -1}, expanded{-1, -1, -1}, standard{-1, -1, -1};
  int name = -1, target = -1, group = -1, time = -1;
  bool quaternion = false;
  std::optional<std::array<std::size_t, 2>> doubled;  ///< columns that may be the same

  bool whole(const std::array<int, 3>& places) const { return places[0] >= 0 && places[1] >= 0 && places[2] >= 0; }
};

void placeColumns(LeicaHeader& header) {
  using Kind = LeicaColumn::Kind;
  for (std::size_t i = 0; i < header.columns.size(); ++i) {
    const LeicaColumn& column = header.columns[i];
    const auto place = static_cast<int>(i);
    const auto axis = static_cast<std::size_t>(std::max(column.axis, 0));
    const auto first = [place](int& into) { into = into < 0 ? place : into; };
    const auto only = [&](int& into) {
      if (into >= 0 && !header.doubled) header.doubled = {static_cast<std::size_t>(into), i};
      first(into);
    };
    switch (column.kind) {
      case Kind::coordinate:
        only(header.coordinates[axis]);
        break;
      case Kind::expanded:
        only(header.expanded[axis]);
        break;
      case Kind::standard:
        only(header.standard[axis]);
        break;
      case Kind::quaternion:
        header.quaternion = true;
        break;
      case Kind::name:
        first(header.name);
        break;
      case Kind::target:
        first(header.target);
        break;
      case Kind::group:
        first(header.group);
        break;
      case Kind::time:
        first(header.time);
        break;
      case Kind::other:
        break;
    }
  }
}

/// The first line, of those a program may write above it, that names x, y and z with units.
LeicaHeader leicaHeaderOf(const FileText& text) {
  constexpr std::size_t kMostAbove = 30;
  for (const TextLine& line : linesOf(text.text)) {
    if (line.number > kMostAbove + text.options.skip) break;
    for (const char separator : {';', '\t', ','}) {
      LeicaHeader header;
      header.line = line.number;
      header.separator = separator;
      for (const std::string_view cell : cellsBetween(line.text, separator))
        header.columns.push_back(columnNamed(cell));
      placeColumns(header);
      if (header.whole(header.coordinates)) return header;
    }
  }
  return {};
}

/// Throws InputError where two columns may be one coordinate: which of them was measured the file does not say.
void requireOneOfEach(const FileText& text, const LeicaHeader& header) {
  if (!header.doubled) return;
  const auto& [one, other] = *header.doubled;
  throw io::InputError({text.file, header.line, fmt::format("column {}", other + 1)}, header.columns[other].title,
                       fmt::format("expected one column of this axis; '{}' is of it, too: name the columns (format "
                                   "columns)",
                                   header.columns[one].title));
}

/// What the header names and is not read; nothing where all is.
std::vector<std::string> unreadColumns(const FileText& text, const LeicaHeader& header) {
  const bool expanded = header.whole(header.expanded), standard = !expanded && header.whole(header.standard);
  std::vector<std::string> unread;
  for (std::size_t i = 0; i < header.columns.size(); ++i) {
    const auto place = static_cast<int>(i);
    const auto among = [place](const std::array<int, 3>& places) {
      return std::find(places.begin(), places.end(), place) != places.end();
    };
    const bool read = among(header.coordinates) || (expanded && among(header.expanded)) ||
                      (standard && among(header.standard)) || place == header.group || place == header.time ||
                      place == (header.name >= 0 ? header.name : header.target);
    if (!read && !header.columns[i].title.empty()) unread.push_back(header.columns[i].title);
  }
  if (unread.empty()) return {};
  return {io::inputMessage({text.file, header.line, ""}, "",
                           fmt::format("columns that are not read: {}", fmt::join(unread, ", ")))};
}

std::optional<Eigen::Vector3d> leicaSigma(const FileText& text, const LeicaHeader& header,
                                          const std::vector<std::string_view>& cells, std::size_t line) {
  const bool expanded = header.whole(header.expanded);
  if (!expanded && !header.whole(header.standard)) return std::nullopt;
  constexpr double kCoverage = 2.0;  // U(95)
  Eigen::Vector3d sigma;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto place = static_cast<std::size_t>(expanded ? header.expanded[k] : header.standard[k]);
    if (cells[place].empty()) return std::nullopt;
    const double value =
        decimal(cells[place], text.decimalSign(), text.file, line, fmt::format("column {}", place + 1));
    if (value < 0.0)
      throw io::InputError({text.file, line, fmt::format("column {}", place + 1)}, std::string(cells[place]),
                           "expected an uncertainty, not below zero");
    sigma[static_cast<Eigen::Index>(k)] = value * *header.columns[place].unit / (expanded ? kCoverage : 1.0);
  }
  if (sigma.isZero(0.0)) return std::nullopt;
  return sigma;
}

PointReading leicaPoint(const FileText& text, const LeicaHeader& header, const std::vector<std::string_view>& cells,
                        std::size_t line, PointGroups& groups) {
  PointReading point;
  point.line = line;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto place = static_cast<std::size_t>(header.coordinates[k]);
    point.point[static_cast<Eigen::Index>(k)] =
        decimal(cells[place], text.decimalSign(), text.file, line, fmt::format("column {}", place + 1)) *
        *header.columns[place].unit;
  }
  const auto cell = [&](int place) {
    return place < 0 ? std::string() : std::string(cells[static_cast<std::size_t>(place)]);
  };
  point.name = cell(header.name >= 0 ? header.name : header.target);
  point.of = groups.of("", cell(header.group));
  point.sigma = leicaSigma(text, header, cells, line);
  const std::string time = cell(header.time);
  if (time.empty()) return point;
  point.time = parseTimestamp(time);
  if (!point.time)
    throw io::InputError({text.file, line, fmt::format("column {}", header.time + 1)}, time,
                         "expected a date and a time, as 11.10.2022 15:06:48.043");
  return point;
}

}  // namespace

bool looksLikeLeica(const FileText& text) {
  const LeicaHeader header = leicaHeaderOf(text);
  return header.line > 0 && (header.whole(header.expanded) || header.quaternion);
}

PointFile readLeica(const FileText& text) {
  const LeicaHeader header = leicaHeaderOf(text);
  if (header.line == 0)
    throw io::InputError({text.file, 1, ""}, std::string(text.text.substr(0, text.text.find_first_of("\r\n"))),
                         "expected a header line that names X, Y and Z with their units, as X [mm]");
  PointFile points;
  points.format = PointFormat::leica;
  requireOneOfEach(text, header);
  points.warnings = unreadColumns(text, header);
  PointGroups groups;
  for (const TextLine& line : linesOf(text.text)) {
    if (line.number <= header.line || trimmed(line.text).empty()) continue;
    std::vector<std::string_view> cells = cellsBetween(line.text, header.separator);
    // A separator may stand behind the last cell, in rows or in the header alone.
    if (cells.size() == header.columns.size() + 1 && cells.back().empty()) cells.pop_back();
    if (cells.size() + 1 == header.columns.size() && header.columns.back().kind == LeicaColumn::Kind::other)
      cells.emplace_back();
    if (cells.size() != header.columns.size()) {
      const std::string why = !line.ended ? "; the file ends in the middle of this line"
                              : cells.size() > header.columns.size() && header.separator == ','
                                  ? "; a decimal comma splits a number in two"
                                  : "";
      throw io::InputError({text.file, line.number, ""}, fmt::format("{} cells", cells.size()),
                           fmt::format("expected {} cells, as the header has{}", header.columns.size(), why));
    }
    points.points.push_back(leicaPoint(text, header, cells, line.number, groups));
  }
  return points;
}

}  // namespace stiffscope::interchange
