#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/campaign/campaign_names.h"
#include "core/campaign/table_layout.h"

namespace stiffscope {

/// A number in the unit of its column, with the decimals of its kind; "-0.000" is written as "0.000". Throws
/// std::runtime_error, naming the column, for a value that is not finite.
std::string writtenNumber(CellKind kind, double si_value, const std::string& column);

/// A name as a cell, in quotes where it needs them. Throws std::runtime_error for an empty one and for one
/// with control characters, which no table can hold.
std::string writtenName(const std::string& name, const std::string& column);

/// An index as the file has it: axis and step as numbers, target, pose and nest as names. Throws
/// std::runtime_error for an index without a name.
std::string writtenIndex(CellKind kind, int index, const CampaignNames& names, const std::string& column);

/// One member of a row as a cell.
template <class Row>
std::string writtenCell(const Column<Row>& column, Row& row, const CampaignNames& names) {
  if (const auto* number = std::get_if<typename Column<Row>::Number>(&column.member)) {
    return writtenNumber(column.kind, (*number)(row), column.name);
  }
  if (const auto* index = std::get_if<typename Column<Row>::Index>(&column.member)) {
    return writtenIndex(column.kind, (*index)(row), names, column.name);
  }
  return writtenName(std::get<typename Column<Row>::Text>(column.member)(row), column.name);
}

/// Whether every row has a value for an optional column of numbers.
template <class Row>
bool isComplete(const Column<Row>& column, std::vector<Row>& rows) {
  const auto* number = std::get_if<typename Column<Row>::Number>(&column.member);
  return number == nullptr ||
         std::all_of(rows.begin(), rows.end(), [&](Row& row) { return !std::isnan((*number)(row)); });
}

/// The table as CSV, columns in the order of the layout. An optional column is left out unless every row has
/// a value for it. (The rows are a copy because a layout gives access to members of rows that may change.)
template <class Row>
std::string writtenTable(const TableLayout<Row>& layout, std::vector<Row> rows, const CampaignNames& names) {
  std::vector<const Column<Row>*> columns;
  std::string text;
  for (const Column<Row>& column : layout.columns) {
    if (!column.required && !isComplete(column, rows)) continue;
    if (!columns.empty()) text += ',';
    text += column.name;
    columns.push_back(&column);
  }
  text += '\n';
  for (Row& row : rows) {
    for (const Column<Row>* column : columns) {
      if (column != columns.front()) text += ',';
      text += writtenCell(*column, row, names);
    }
    text += '\n';
  }
  return text;
}

}  // namespace stiffscope
