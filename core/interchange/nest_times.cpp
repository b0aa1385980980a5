#include "core/interchange/nest_times.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace stiffscope::interchange {

namespace {

constexpr double kWritten = 1e-4;  // s, the last decimal of the table

using Moment = std::pair<std::int64_t, int>;  ///< time as it is written, nest

Moment momentOf(double time_s, int nest) { return {std::llround(time_s / kWritten), nest}; }

/// Readings of one nest that state one time.
struct Sharing {
  std::size_t count = 0;
  double ticks = 0.0;  ///< that the next of them is moved by
};

}  // namespace

MovedNests keepTimesApart(std::vector<campaign::NestReading>& rows, const std::vector<double>& resolutions) {
  std::map<Moment, Sharing> shared;
  for (const campaign::NestReading& row : rows) ++shared[momentOf(row.time_s, row.nest)].count;
  MovedNests moved;
  std::set<Moment> taken;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double stated = rows[i].time_s;
    Sharing& sharing = shared.at(momentOf(stated, rows[i].nest));
    // Whole decimals of the table, so that no two are rounded into one.
    constexpr double kUsual = 0.1, kRounding = 1e-9;
    const double between = std::min(kUsual, resolutions[i] / static_cast<double>(sharing.count));
    const double tick = kWritten * std::max(1.0, std::floor(between / kWritten + kRounding));
    do {
      rows[i].time_s = stated + tick * sharing.ticks++;
    } while (!taken.insert(momentOf(rows[i].time_s, rows[i].nest)).second);
    if (rows[i].time_s == stated) continue;
    if (moved.count++ == 0) moved.first = i;
    moved.farthest_s = std::max(moved.farthest_s, rows[i].time_s - stated);
  }
  return moved;
}

}  // namespace stiffscope::interchange
