#include "core/interchange/point_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <functional>
#include <iterator>
#include <unordered_map>
#include <utility>

#include "core/interchange/point_formats.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"

namespace stiffscope::interchange {

PointFormat pointFormatNamed(const std::string& name, const std::string& option) {
  for (std::size_t i = 0; i < kPointFormatNames.size(); ++i) {
    if (name == kPointFormatNames[i]) return static_cast<PointFormat>(i);
  }
  const std::vector<std::string> known(kPointFormatNames.begin(), kPointFormatNames.end());
  throw io::InputError({option}, name,
                       fmt::format("expected {}{}", fmt::join(known, ", "), io::nearestNameHint(name, known)));
}

namespace {

/// Formats that a text can be of. A certain likeness leaves no other.
std::vector<PointFormat> candidatesFor(const FileText& text) {
  if (looksLikeOpenIndy(text.text)) return {PointFormat::openindy};
  if (!text.options.columns.empty()) return {PointFormat::columns};
  if (looksLikeLeica(text)) return {PointFormat::leica};
  if (hasColumnHeader(text)) return {PointFormat::columns};
  if (looksLikeSemicolonXyz(text)) return {PointFormat::xyz};
  const SaLikeness sa = looksLikeSpatialAnalyzer(text);
  if (sa == SaLikeness::certain) return {PointFormat::sa};
  if (sa == SaLikeness::possible) return {PointFormat::sa, PointFormat::columns};
  return {};
}

std::string firstLineOf(const FileText& text) {
  for (const TextLine& line : linesOf(text.text)) {
    if (!trimmed(line.text).empty()) return std::string(trimmed(line.text));
  }
  return {};
}

PointFile readAs(PointFormat format, const FileText& text) {
  switch (format) {
    case PointFormat::sa:
      return readSpatialAnalyzer(text);
    case PointFormat::leica:
      return readLeica(text);
    case PointFormat::openindy:
      return readOpenIndy(text);
    case PointFormat::xyz:
      return readSemicolonXyz(text);
    case PointFormat::columns:
      break;
  }
  return readPointColumns(text);
}

/// The format wanted must be one the file can be of: read as another its numbers would be others.
PointFormat formatOf(const FileText& text) {
  const std::optional<PointFormat>& wanted = text.options.format;
  if (wanted == PointFormat::columns && !text.options.columns.empty()) return *wanted;
  const std::vector<PointFormat> candidates = candidatesFor(text);
  std::vector<std::string> names;
  for (const PointFormat one : candidates) names.emplace_back(nameOf(one));
  if (wanted) {
    const bool other = candidates.size() == 1 && candidates.front() != *wanted;
    if (other)
      throw io::InputError({text.file, 0, "format"}, nameOf(*wanted),
                           fmt::format("expected {}, as this file is built; its first line is \"{}\"", names.front(),
                                       io::oneLine(firstLineOf(text), 60)));
    return *wanted;
  }
  if (candidates.size() == 1) return candidates.front();
  if (candidates.empty())
    throw io::InputError(
        {text.file, 1, ""}, firstLineOf(text),
        fmt::format("expected a file of points: {}; it is built like none of them (option columns reads any table)",
                    fmt::join(kPointFormatNames, ", ")));
  throw io::InputError(
      {text.file, 1, ""}, firstLineOf(text),
      fmt::format("expected a file of one format; it may be {} (option format)", fmt::join(names, " or ")));
}

void countOccurrences(PointFile& points) {
  using Name = std::pair<const PointGroup*, std::string_view>;
  const auto hash = [](const Name& name) {
    return std::hash<std::string_view>()(name.second) ^ std::hash<const PointGroup*>()(name.first);
  };
  std::unordered_map<Name, int, decltype(hash)> seen(points.points.size(), hash);
  for (PointReading& point : points.points) point.occurrence = ++seen[{point.of.get(), point.name}];
}

/// Rows of exactly 0 0 0: there the tracker itself stands. They count as occurrences, so that the next reading of that
/// name keeps its own. SpatialAnalyzer writes no lost beams; there 0 0 0 is a constructed point, the origin.
void takeLostBeamsOut(PointFile& points) {
  if (points.format == PointFormat::sa) return;
  const auto lost = std::stable_partition(points.points.begin(), points.points.end(),
                                          [](const PointReading& point) { return !point.point.isZero(0.0); });
  points.lost.assign(std::make_move_iterator(lost), std::make_move_iterator(points.points.end()));
  points.points.erase(lost, points.points.end());
  for (const PointReading& point : points.lost) points.skipped.push_back({point.line, Skip::lost_beam});
  std::stable_sort(points.skipped.begin(), points.skipped.end(),
                   [](const SkippedRow& a, const SkippedRow& b) { return a.line < b.line; });
}

/// What the user says of a file must be of use in its format: another unit would make other numbers.
void requireOptionsOf(PointFormat format, const FileText& text) {
  const FileOptions& options = text.options;
  const bool own_units =
      format == PointFormat::leica || format == PointFormat::openindy || format == PointFormat::columns;
  if (!options.unit.empty() && own_units)
    throw io::InputError({text.file, 0, "unit"}, options.unit,
                         fmt::format("expected no unit: files of format {} state their own", nameOf(format)));
  if (!options.separator.empty() && format != PointFormat::columns)
    throw io::InputError({text.file, 0, "separator"}, options.separator,
                         fmt::format("expected no separator: that of format {} is known", nameOf(format)));
  const bool project = format == PointFormat::openindy;
  if (options.skip > 0 && (project || format == PointFormat::leica))
    throw io::InputError({text.file, 0, "skip"}, std::to_string(options.skip),
                         fmt::format("expected no lines to skip: where rows of format {} start is known{}",
                                     nameOf(format), project ? "" : " (format columns skips)"));
  if (options.decimal_comma && project)
    throw io::InputError({text.file, 0, "decimal_comma"}, "yes",
                         fmt::format("expected no decimal commas: numbers of format {} have points", nameOf(format)));
  if (!options.columns.empty() && project)
    throw io::InputError({text.file, 0, "columns"}, options.columns,
                         fmt::format("expected no columns: files of format {} are no tables", nameOf(format)));
}

/// Names in quotes as they are meant; most files have none.
void readQuotedNames(PointFile& points) {
  PointGroups groups;
  for (PointReading& point : points.points) {
    point.name = cellText(point.name);
    const std::string collection = cellText(point.collection()), group = cellText(point.group());
    if (collection != point.collection() || group != point.group()) point.of = groups.of(collection, group);
    if (!point.columns) continue;
    PointReading::Columns columns;
    for (const auto& [name, cell] : *point.columns) columns[name] = cellText(cell);
    if (columns != *point.columns) point.columns = std::make_shared<const PointReading::Columns>(std::move(columns));
  }
}

/// A name that a table could not hold again is no name.
void requireNames(const std::string& file, const PointFile& points) {
  constexpr std::size_t kLongest = 200;
  for (const PointReading& point : points.points) {
    for (const std::string* name : {&point.collection(), &point.group(), &point.name}) {
      const bool control = std::any_of(name->begin(), name->end(),
                                       [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
      if (control || name->size() > kLongest)
        throw io::InputError({file, point.line, "name"}, *name,
                             "expected a name without control characters, of at most 200 bytes");
    }
  }
}

/// The campaign's own limit: farther no tracker reads.
void requireNear(const std::string& file, const PointFile& points) {
  constexpr double kFarthest = 200.0;
  for (const PointReading& point : points.points) {
    if (point.point.cwiseAbs().maxCoeff() <= kFarthest) continue;
    throw io::InputError({file, point.line, "x y z"},
                         fmt::format("{:.6g} {:.6g} {:.6g} m", point.point.x(), point.point.y(), point.point.z()),
                         "expected coordinates within 200 m: another unit, or another decimal sign?");
  }
}

}  // namespace

PointFile parsePointFile(const std::string& file, std::string_view bytes, const FileOptions& options) {
  const DecodedText decoded = decodeText(file, bytes, options.encoding);
  const FileText text{file, decoded.text(), options};
  if (!looksLikeOpenIndy(text.text)) requireLines(file, text.text);
  const PointFormat format = formatOf(text);
  requireOptionsOf(format, text);
  PointFile points = readAs(format, text);
  points.encoding = decoded.encoding;
  // In XML two quotes are a value that is empty.
  if (format != PointFormat::openindy && text.text.find("\"\"") != std::string_view::npos) readQuotedNames(points);
  if (points.points.empty() && points.skipped.empty())
    throw io::InputError({file, 0, ""}, "", "expected points; there are none");
  if (!options.target.empty()) {
    for (PointReading& point : points.points) point.name = options.target;
  }
  requireNames(file, points);
  requireNear(file, points);
  countOccurrences(points);
  takeLostBeamsOut(points);
  return points;
}

PointFile readPointFile(const std::filesystem::path& path, const FileOptions& options) {
  return parsePointFile(path.string(), io::readBytesWithStamp(path).text(), options);
}

}  // namespace stiffscope::interchange
