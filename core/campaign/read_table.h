#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/columns.h"
#include "core/campaign/repeated_keys.h"
#include "core/io/csv.h"
#include "core/io/input_error.h"
#include "core/io/numbers.h"
#include "core/io/read_file.h"
#include "core/numerics/parallel.h"

namespace stiffscope::campaign {

/// A column as the header line is matched against it.
struct WantedColumn {
  std::string name;
  bool required = true;
  std::string together = {};  ///< optional columns of one such name are there all or none
};

inline constexpr std::size_t kAbsentColumn = static_cast<std::size_t>(-1);

/// For each wanted column its place among `cells`, the header line's, or kAbsentColumn where an optional one
/// is absent. Columns that nobody wants go into one warning that names them all. Throws InputError, naming
/// `file` and `line`, for a required column that is missing, one that is there twice, and a file whose
/// columns are not separated by commas.
std::vector<std::size_t> matchHeader(const std::string& file, std::size_t line,
                                     const std::vector<std::string_view>& cells,
                                     const std::vector<WantedColumn>& wanted, std::vector<std::string>& warnings);

/// A table's bytes and its name for messages.
struct TableSource {
  std::string file;
  std::string_view bytes;
};

/// The data lines of a table: reads the header and hands out line after line, each with as many cells as the
/// header has. Throws InputError where a line has more or fewer, where there is no header or no data line, where the
/// header has more than a thousand columns, and where something stands in a column without a name (columns without a
/// name are what a spreadsheet leaves behind the last one). A last line without a line end, but with all its cells,
/// gives a warning: its last number may be cut short.
class TableLines {
 public:
  TableLines(const TableSource& source, const std::vector<WantedColumn>& wanted, std::vector<std::string>& warnings);

  /// A part of the lines behind `table`'s header, `lines_before` of the file before it: read as the whole is, but one
  /// without a row is no error. Only the last part can have a last line without a line end, so that no two of them
  /// read in different threads give a warning.
  TableLines(const TableLines& table, std::string_view part, std::size_t lines_before);

  bool next();

  /// What stands behind the line last given.
  std::string_view rest() const { return lines_.rest(); }

  /// As many rows as there can be in `lines` lines of so many bytes.
  std::size_t mostRows(std::size_t bytes, std::size_t lines) const;

  std::size_t line() const { return lines_.line(); }
  bool has(std::size_t column) const { return placeOf(column) != kAbsentColumn; }

  /// Where the column that is the `column`-th of those wanted stands in the table; kAbsentColumn where it does not.
  std::size_t placeOf(std::size_t column) const { return places_[column]; }

  /// Cell of the current line in the `place`-th column of the table.
  std::string_view cellAt(std::size_t place) const { return cells_[place]; }

  /// Cell of the current line in the column that is the `column`-th of those wanted.
  std::string_view cell(std::size_t column) const { return cellAt(placeOf(column)); }

 private:
  void requireCellCount() const;
  void requireNothingWithoutName() const;

  const TableSource& source_;
  io::CsvLines lines_;
  std::vector<std::string_view> cells_;
  std::vector<std::size_t> places_, nameless_;
  std::size_t cells_in_header_ = 0;
  std::size_t shortest_row_ = 0;  ///< bytes, its line end among them
  std::size_t rows_ = 0;
  bool row_required_ = true;
  std::vector<std::string>& warnings_;
};

template <class Row>
std::vector<WantedColumn> wantedColumns(const TableLayout<Row>& layout) {
  std::vector<WantedColumn> wanted;
  for (const Column<Row>& column : layout.columns) wanted.push_back({column.name, column.required, column.together});
  return wanted;
}

/// Reads the lines of a table into rows, in SI and radians. What its columns are is settled once for all lines, of
/// which there may be millions.
template <class Row>
class RowReader {
 public:
  /// `lines`: of that table. The file's name and the layout must outlive this object.
  RowReader(const std::string& file, const TableLayout<Row>& layout, const TableLines& lines) : file_(file) {
    for (std::size_t i = 0; i < layout.columns.size(); ++i) {
      const Column<Row>& column = layout.columns[i];
      if (!lines.has(i)) continue;
      Present present{&column, lines.placeOf(i), Quick::none, 0, {}};
      const auto* number = std::get_if<typename Column<Row>::Number>(&column.member);
      if (number != nullptr && isWithin(*number, layout.blank)) {
        present.quick = Quick::number;
        present.offset = offsetOf(*number, layout.blank);
        present.written = numberKind(column.kind);
      } else if (column.kind == CellKind::step) {
        present.quick = Quick::whole;
        present.offset = offsetOf(std::get<typename Column<Row>::Index>(column.member), layout.blank);
      }
      columns_.push_back(present);
    }
  }

  /// The cells of the line that `lines` gave last, and its number. Throws InputError for a cell that its column cannot
  /// hold.
  void read(const TableLines& lines, CampaignNames& names, Row& row) const {
    row.line = lines.line();
    for (const Present& present : columns_) {
      const std::string_view cell = lines.cellAt(present.place);
      if (present.quick == Quick::number) {
        const double value = io::numberOrNan(cell);
        if (std::abs(value) <= present.written.limit) {  // not where it is NaN
          memberAt<double>(present, row) = value * present.written.si_per_unit;
          continue;
        }
      } else if (present.quick == Quick::whole) {
        const std::optional<int> value = io::parseInteger(cell);
        if (value && *value >= 0) {
          memberAt<int>(present, row) = *value;
          continue;
        }
      }
      if (cell.empty() && present.column->may_be_blank) continue;
      readAny(*present.column, cell, {file_, row.line, present.column->name}, names, row);
    }
  }

 private:
  /// What most cells of a column hold, which is read without a call.
  enum class Quick { none, number, whole };

  /// A column that the table has.
  struct Present {
    const Column<Row>* column;
    std::size_t place;  ///< in the table
    Quick quick;
    std::ptrdiff_t offset;  ///< of its member in a row, bytes; of those read quickly
    NumberKind written;     ///< of a number
  };

  /// Whether the column's member stands in the row itself, not in what the row keeps elsewhere.
  template <class Member>
  static bool isWithin(Member& (*member)(Row&), Row row) {
    const auto* const at = reinterpret_cast<const std::byte*>(&member(row));
    const auto* const begin = reinterpret_cast<const std::byte*>(&row);
    return !std::less<>()(at, begin) && std::less<>()(at, begin + sizeof(Row));
  }

  /// Where in a row a column's member stands.
  template <class Member>
  static std::ptrdiff_t offsetOf(Member& (*member)(Row&), Row row) {
    return reinterpret_cast<std::byte*>(&member(row)) - reinterpret_cast<std::byte*>(&row);
  }

  template <class Member>
  static Member& memberAt(const Present& present, Row& row) {
    return *reinterpret_cast<Member*>(reinterpret_cast<std::byte*>(&row) + present.offset);
  }

  static void readAny(const Column<Row>& column, std::string_view cell, const CellPlace& place, CampaignNames& names,
                      Row& row) {
    if (const auto* number = std::get_if<typename Column<Row>::Number>(&column.member)) {
      (*number)(row) = readNumberCell(column.kind, cell, place);
    } else if (const auto* index = std::get_if<typename Column<Row>::Index>(&column.member)) {
      (*index)(row) = readIndexCell(column.kind, cell, place, names);
    } else {
      std::get<typename Column<Row>::Text>(column.member)(row) = readTextCell(cell, place);
    }
  }

  const std::string& file_;
  std::vector<Present> columns_;
};

/// Some milliseconds of reading: much more than starting a thread takes.
inline constexpr std::size_t kPartBytes = std::size_t{1} << 20;

/// A part of a table's lines, and what they gave. Parts are read at the same time: each writes its own.
template <class Row>
struct TablePart {
  TableLines lines;
  CampaignNames names;    ///< poses, nests, stations and repeats by their first appearance in this part
  std::size_t from = 0;   ///< place among the rows of all parts where its own belong
  std::size_t room = 0;   ///< as many as there can be
  std::span<Row> rows{};  ///< those read
  bool done = false;      ///< to its end, without an error
  bool ascending = true;  ///< its keys
};

/// The rows of all parts. They are made part by part, by the thread that is about to read one.
template <class Row>
class RowsInMaking {
 public:
  RowsInMaking(std::size_t rows, const Row& blank) : blank_(blank) {
    rows_.reserve(rows);
    io::askForLargePages(rows_.data(), rows * sizeof(Row));
  }

  /// The first of all rows, of which there are `count` then at least. None moves: there is room for all.
  Row* made(std::size_t count) {
    const std::lock_guard lock(making_);
    if (rows_.size() < count) rows_.resize(count, blank_);
    return rows_.data();
  }

  std::vector<Row> take() { return std::move(rows_); }

 private:
  std::mutex making_;
  Row blank_;
  std::vector<Row> rows_;
};

/// The parts of the lines behind the header.
template <class Row>
std::vector<TablePart<Row>> partsOf(const TableLines& header, const CampaignNames& names, std::size_t part_bytes) {
  const std::vector<std::string_view> texts = io::partsOfLines(header.rest(), part_bytes);
  std::vector<std::size_t> lines(texts.size());
  numerics::onAllCores(texts.size(), [&](std::size_t i) { lines[i] = io::linesIn(texts[i]); });
  std::vector<TablePart<Row>> parts;
  parts.reserve(texts.size());
  std::size_t before = header.line(), from = 0;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::size_t room = header.mostRows(texts[i].size(), lines[i]);
    parts.push_back({TableLines(header, texts[i], before), {names.targets, {}, {}, names.axes}, from, room});
    before += lines[i];
    from += room;
  }
  return parts;
}

template <class Row>
void readPart(const RowReader<Row>& reader, const KeyColumns<Row>& key, RowsInMaking<Row>& rows,
              TablePart<Row>& part) try {
  Row* const first = rows.made(part.from + part.room) + part.from;
  while (part.lines.next()) {
    const std::size_t read = part.rows.size();
    if (read == part.room) return;
    reader.read(part.lines, part.names, first[read]);
    if (read > 0 && !key.less(first[read - 1], first[read])) part.ascending = false;
    part.rows = {first, read + 1};
  }
  part.done = true;
} catch (const io::InputError&) {
  // The reading in one go says which error of the file is the first.
}

/// The index in the names of all tables of each name of a part.
struct PartIndices {
  std::vector<int> poses, nests, stations, repeats;

  const std::vector<int>* of(CellKind kind) const {
    if (kind == CellKind::pose) return &poses;
    if (kind == CellKind::nest) return &nests;
    if (kind == CellKind::repeat) return &repeats;
    return kind == CellKind::station ? &stations : nullptr;
  }
};

/// Refers the rows of a part to the names of all tables.
template <class Row>
void renumber(const TableLayout<Row>& layout, const PartIndices& names, TablePart<Row>& part) {
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const Column<Row>& column = layout.columns[i];
    if (names.of(column.kind) == nullptr || !part.lines.has(i)) continue;
    const std::vector<int>& indices = *names.of(column.kind);
    const auto member = std::get<typename Column<Row>::Index>(column.member);
    if (indices.empty()) continue;  // repeats that are all numbers
    const bool repeats = column.kind == CellKind::repeat;
    for (Row& row : part.rows) {
      int& own = member(row);
      if (repeats && own >= kNoRepeat) continue;
      const int among = indices[static_cast<std::size_t>(repeats ? repeatByName(own) : own)];
      own = repeats ? repeatByName(among) : among;
    }
    // An order of keys by the part's own indices is one by all only if the two go up together.
    if (!std::is_sorted(indices.begin(), indices.end())) part.ascending = false;
  }
}

/// Whether keys ascend in all parts and from each to the next.
template <class Row>
bool keysAscend(const std::vector<TablePart<Row>>& parts, const KeyColumns<Row>& key) {
  Row* last = nullptr;
  for (const TablePart<Row>& part : parts) {
    if (part.rows.empty()) continue;
    if (!part.ascending || (last != nullptr && !key.less(*last, part.rows.front()))) return false;
    last = &part.rows.back();
  }
  return true;
}

/// Moves the rows of all parts together, where lines were blank.
template <class Row>
void closeUp(const std::vector<TablePart<Row>>& parts, std::vector<Row>& rows) {
  std::size_t end = 0;
  for (const TablePart<Row>& part : parts) {
    const auto from = rows.begin() + static_cast<std::ptrdiff_t>(part.from);
    const auto count = static_cast<std::ptrdiff_t>(part.rows.size());
    if (end != part.from) std::move(from, from + count, rows.begin() + static_cast<std::ptrdiff_t>(end));
    end += part.rows.size();
  }
  rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(end), rows.end());
}

/// readTable of a large text: its lines in parts of some `part_bytes`, shared among the cores. The parts depend on the
/// text alone, and each numbers poses and nests by itself; put together in their order they are numbered as they first
/// appear in the whole. nullopt where the table has an error; `names` and `warnings` may then have grown.
template <class Row>
std::optional<std::vector<Row>> readTableInParts(const TableSource& source, const TableLayout<Row>& layout,
                                                 CampaignNames& names, std::vector<std::string>& warnings,
                                                 std::size_t part_bytes) {
  const KeyColumns<Row> key(layout);
  const TableLines header(source, wantedColumns(layout), warnings);
  std::vector<TablePart<Row>> parts = partsOf<Row>(header, names, part_bytes);
  if (parts.empty()) return std::nullopt;
  RowsInMaking<Row> making(parts.back().from + parts.back().room, layout.blank);
  const RowReader<Row> reader(source.file, layout, header);
  numerics::onAllCores(parts.size(), [&](std::size_t i) { readPart(reader, key, making, parts[i]); });
  if (!std::all_of(parts.begin(), parts.end(), [](const auto& part) { return part.done; })) return std::nullopt;

  std::vector<PartIndices> indices;
  for (const TablePart<Row>& part : parts) {
    indices.push_back({names.poses.addAll(part.names.poses), names.nests.addAll(part.names.nests),
                       names.stations.addAll(part.names.stations), names.repeats.addAll(part.names.repeats)});
  }
  numerics::onAllCores(parts.size(), [&](std::size_t i) { renumber(layout, indices[i], parts[i]); });
  const bool ascending = keysAscend(parts, key);
  std::vector<Row> rows = making.take();
  closeUp(parts, rows);
  if (rows.empty()) return std::nullopt;
  RowRepeats<Row> repeats(key, rows);
  for (std::size_t row = 0; !ascending && row < rows.size(); ++row) {
    if (repeats.of(row) != RepeatCheck::kNew) return std::nullopt;
  }
  return rows;
}

template <class Row>
[[noreturn]] void refuseRepeat(const TableSource& source, const TableLayout<Row>& layout, const KeyColumns<Row>& key,
                               const TableLines& lines, std::size_t first_line) {
  std::vector<std::string_view> cells;
  for (const std::size_t i : key.places) {
    if (lines.has(i)) cells.push_back(lines.cell(i));
  }
  throw io::InputError({source.file, lines.line(), fmt::format("{}", fmt::join(layout.key, ", "))},
                       fmt::format("{}", fmt::join(cells, ", ")),
                       fmt::format("expected a key that does not repeat; line {} has it first", first_line));
}

/// readTable line after line; the error it throws is the first of the file.
template <class Row>
std::vector<Row> readTableInOneGo(const TableSource& source, const TableLayout<Row>& layout, CampaignNames& names,
                                  std::vector<std::string>& warnings) {
  const KeyColumns<Row> key(layout);
  TableLines lines(source, wantedColumns(layout), warnings);
  std::vector<Row> rows;
  rows.reserve(lines.mostRows(lines.rest().size(), io::linesIn(lines.rest())));
  RowRepeats<Row> repeats(key, rows);
  const RowReader<Row> reader(source.file, layout, lines);
  while (lines.next()) {
    reader.read(lines, names, rows.emplace_back(layout.blank));
    const std::size_t first = repeats.of(rows.size() - 1);
    if (first != RepeatCheck::kNew) refuseRepeat(source, layout, key, lines, rows[first].line);
  }
  return rows;
}

/// Rows of a table that `layout` describes, in the order of the file. Throws InputError with file, line,
/// column and value for anything the format does not allow, keys that repeat among it. A text larger than `part_bytes`
/// is read in parts of that size on all cores; rows, names, warnings and errors are those of the
/// reading in one go.
template <class Row>
std::vector<Row> readTable(const TableSource& source, const TableLayout<Row>& layout, CampaignNames& names,
                           std::vector<std::string>& warnings, std::size_t part_bytes = kPartBytes) {
  const std::size_t warned = warnings.size();
  if (source.bytes.size() > part_bytes) {
    if (auto rows = readTableInParts(source, layout, names, warnings, part_bytes)) return *std::move(rows);
    warnings.resize(warned);
  }
  return readTableInOneGo(source, layout, names, warnings);
}

}  // namespace stiffscope::campaign
