#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/interchange/delimited_text.h"
#include "core/interchange/point_reading.h"

namespace stiffscope::interchange {

/// How the cells of the rows of SpatialAnalyzer's export are kept apart.
struct SaSeparator {
  bool comma = false;
  std::size_t blanks = 1;  ///< at least so many between two cells; of commas without meaning
};

/// A row with its time, if any, cut out.
struct SaRow {
  std::size_t line = 0;
  bool ended = true;
  std::vector<std::string_view> cells;
  std::optional<Timestamp> time;
  bool lone_time = false;   ///< a time of day without its date, which is not read
  std::string unread_time;  ///< what looks like a time and is none that can be read; it stays in the cells
};

/// A line as a row.
SaRow saRowOf(const TextLine& line, const SaSeparator& separator);

}  // namespace stiffscope::interchange
