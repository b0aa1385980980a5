#pragma once

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "core/campaign/key_columns.h"
#include "core/campaign/read_row.h"
#include "core/input/input_error.h"
#include "core/parallel/on_all_cores.h"

namespace stiffscope {

/// Some milliseconds of reading: much more than starting a thread takes.
inline constexpr std::size_t kPartBytes = std::size_t{1} << 20;

/// A part of a table's lines, and what they gave. Parts are read at the same time: each writes its own.
template <class Row>
struct TablePart {
  TableLines lines;
  CampaignNames names;    ///< poses and nests by their first appearance in this part
  std::span<Row> room{};  ///< where its rows belong, one a line
  std::size_t rows = 0;
  bool done = false;      ///< to its end, without an error
  bool ascending = true;  ///< its keys

  std::span<Row> filled() const { return room.first(rows); }
};

template <class Row>
void readPart(const std::string& file, const TableLayout<Row>& layout, const KeyColumns<Row>& key,
              TablePart<Row>& part) try {
  while (part.lines.next()) {
    if (part.rows == part.room.size()) return;
    Row& row = part.room[part.rows];
    readRow(file, layout, part.lines, part.names, row);
    if (part.rows > 0 && !key.less(part.room[part.rows - 1], row)) part.ascending = false;
    ++part.rows;
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
    for (Row& row : part.filled()) member(row) = indices[static_cast<std::size_t>(member(row))];
    // An order of keys by the part's own indices is one by all only if the two go up together.
    if (!std::is_sorted(indices.begin(), indices.end())) part.ascending = false;
  }
}

/// The parts of the lines behind the header, each with room among `rows`.
template <class Row>
std::vector<TablePart<Row>> partsOf(const TableLines& header, const CampaignNames& names, std::size_t part_bytes,
                                    std::vector<Row>& rows) {
  const std::vector<std::string_view> texts = partsOfLines(header.rest(), part_bytes);
  std::vector<std::size_t> lines(texts.size()), rooms(texts.size());
  onAllCores(texts.size(), [&](std::size_t i) {
    lines[i] = linesIn(texts[i]);
    rooms[i] = header.mostRows(texts[i].size(), lines[i]);
  });
  rows.resize(std::accumulate(rooms.begin(), rooms.end(), std::size_t{0}));
  std::vector<TablePart<Row>> parts;
  parts.reserve(texts.size());
  std::size_t before = header.line(), from = 0;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    parts.push_back({TableLines(header, texts[i], before), {names.targets, {}, {}}, {rows.data() + from, rooms[i]}});
    before += lines[i];
    from += rooms[i];
  }
  return parts;
}

/// Moves the rows of all parts together, where lines were blank.
template <class Row>
void closeUp(const std::vector<TablePart<Row>>& parts, std::vector<Row>& rows) {
  auto end = rows.begin();
  for (const TablePart<Row>& part : parts) {
    const auto from = rows.begin() + (part.room.data() - rows.data());
    end = from == end ? end + static_cast<std::ptrdiff_t>(part.rows)
                      : std::move(from, from + static_cast<std::ptrdiff_t>(part.rows), end);
  }
  rows.erase(end, rows.end());
}

/// Whether keys ascend in all parts and from each to the next.
template <class Row>
bool keysAscend(const std::vector<TablePart<Row>>& parts, const KeyColumns<Row>& key) {
  Row* last = nullptr;
  for (const TablePart<Row>& part : parts) {
    if (part.rows == 0) continue;
    if (!part.ascending || (last != nullptr && !key.less(*last, part.room.front()))) return false;
    last = &part.filled().back();
  }
  return true;
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
  std::vector<Row> rows;
  std::vector<TablePart<Row>> parts = partsOf(header, names, part_bytes, rows);
  onAllCores(parts.size(), [&](std::size_t i) { readPart(source.file, layout, key, parts[i]); });
  if (!std::all_of(parts.begin(), parts.end(), [](const auto& part) { return part.done; })) return std::nullopt;

  std::vector<std::vector<int>> poses, nests;
  for (const TablePart<Row>& part : parts) {
    poses.push_back(names.poses.addAll(part.names.poses));
    nests.push_back(names.nests.addAll(part.names.nests));
  }
  onAllCores(parts.size(), [&](std::size_t i) { renumber(layout, poses[i], nests[i], parts[i]); });
  const bool ascending = keysAscend(parts, key);
  closeUp(parts, rows);
  if (rows.empty()) return std::nullopt;
  RowRepeats<Row> repeats(key, rows);
  for (std::size_t row = 0; !ascending && row < rows.size(); ++row) {
    if (repeats.of(row) != RepeatCheck::kNew) return std::nullopt;
  }
  return rows;
}

}  // namespace stiffscope
