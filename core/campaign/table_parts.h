#pragma once

#include <algorithm>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "core/campaign/key_columns.h"
#include "core/campaign/read_row.h"
#include "core/input/input_error.h"
#include "core/input/large_pages.h"
#include "core/parallel/on_all_cores.h"

namespace stiffscope {

/// Some milliseconds of reading: much more than starting a thread takes.
inline constexpr std::size_t kPartBytes = std::size_t{1} << 20;

/// A part of a table's lines, and what they gave. Parts are read at the same time: each writes its own.
template <class Row>
struct TablePart {
  TableLines lines;
  CampaignNames names;    ///< poses and nests by their first appearance in this part
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
  explicit RowsInMaking(std::size_t rows) {
    rows_.reserve(rows);
    askForLargePages(rows_.data(), rows * sizeof(Row));
  }

  /// The first of all rows, of which there are `count` then at least. None moves: there is room for all.
  Row* made(std::size_t count) {
    const std::lock_guard lock(making_);
    if (rows_.size() < count) rows_.resize(count);
    return rows_.data();
  }

  std::vector<Row> take() { return std::move(rows_); }

 private:
  std::mutex making_;
  std::vector<Row> rows_;
};

/// The parts of the lines behind the header.
template <class Row>
std::vector<TablePart<Row>> partsOf(const TableLines& header, const CampaignNames& names, std::size_t part_bytes) {
  const std::vector<std::string_view> texts = partsOfLines(header.rest(), part_bytes);
  std::vector<std::size_t> lines(texts.size());
  onAllCores(texts.size(), [&](std::size_t i) { lines[i] = linesIn(texts[i]); });
  std::vector<TablePart<Row>> parts;
  parts.reserve(texts.size());
  std::size_t before = header.line(), from = 0;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::size_t room = header.mostRows(texts[i].size(), lines[i]);
    parts.push_back({TableLines(header, texts[i], before), {names.targets, {}, {}}, from, room});
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
} catch (const InputError&) {
  // The reading in one go says which error of the file is the first.
}

/// Refers the rows of a part to the names of all tables; `poses` and `nests`: the index there of each name of the part.
template <class Row>
void renumber(const TableLayout<Row>& layout, const std::vector<int>& poses, const std::vector<int>& nests,
              TablePart<Row>& part) {
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const Column<Row>& column = layout.columns[i];
    if ((column.kind != CellKind::pose && column.kind != CellKind::nest) || !part.lines.has(i)) continue;
    const std::vector<int>& indices = column.kind == CellKind::pose ? poses : nests;
    const auto member = std::get<typename Column<Row>::Index>(column.member);
    for (Row& row : part.rows) member(row) = indices[static_cast<std::size_t>(member(row))];
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
  rows.resize(end);
}

/// readTable of a large text: its lines in parts of some `part_bytes`, shared among the cores. The parts depend on the text
/// alone, and each numbers poses and nests by itself; put together in their order they are numbered as they first appear
/// in the whole. nullopt where the table has an error; `names` and `warnings` may then have grown.
template <class Row>
std::optional<std::vector<Row>> readTableInParts(const TableSource& source, const TableLayout<Row>& layout,
                                                 CampaignNames& names, std::vector<std::string>& warnings,
                                                 std::size_t part_bytes) {
  const KeyColumns<Row> key(layout);
  const TableLines header(source, wantedColumns(layout), warnings);
  std::vector<TablePart<Row>> parts = partsOf<Row>(header, names, part_bytes);
  if (parts.empty()) return std::nullopt;
  RowsInMaking<Row> making(parts.back().from + parts.back().room);
  const RowReader<Row> reader(source.file, layout, header);
  onAllCores(parts.size(), [&](std::size_t i) { readPart(reader, key, making, parts[i]); });
  if (!std::all_of(parts.begin(), parts.end(), [](const auto& part) { return part.done; })) return std::nullopt;

  std::vector<std::vector<int>> poses, nests;
  for (const TablePart<Row>& part : parts) {
    poses.push_back(names.poses.addAll(part.names.poses));
    nests.push_back(names.nests.addAll(part.names.nests));
  }
  onAllCores(parts.size(), [&](std::size_t i) { renumber(layout, poses[i], nests[i], parts[i]); });
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

}  // namespace stiffscope
