#include "reports/text/gap_text.h"

#include <fmt/format.h>
#include <iterator>

#include "core/io/units.h"
#include "reports/text/text.h"
#include "reports/words/effect_words.h"
#include "reports/words/numbers.h"

namespace stiffscope::reports {

std::string shrinkInterval(const diagnosis::Shrink& shrink) {
  if (!shrink.judged()) return "-";
  return fmt::format("{:.3f} to {:.3f}", unsignedZero(shrink.low, 3), unsignedZero(shrink.high, 3));
}

std::string whereText(const std::vector<diagnosis::WhereTable>& tables, const char* title) {
  if (tables.empty()) return {};
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "\n{}\n", title);
  constexpr std::size_t kMostRows = 8;
  for (const diagnosis::WhereTable& table : tables) {
    if (table.rows.size() > kMostRows) continue;  // postures: in the JSON
    fmt::format_to(out, "  {:<24}{:>10}{:>10}{:>9}{:>14}\n", "by " + table.by, "rms, µm", "noise", "share", "sd above");
    for (const diagnosis::WhereRow& row : table.rows) {
      fmt::format_to(out, "    {:<22}{:>10.1f}{:>10.1f}{:>8.0f}%{:>14}\n", row.name, row.rms / io::kMicrometre,
                     row.noise / io::kMicrometre, 100.0 * row.share, deviateWords(row.significance));
    }
    if (table.overlaps) fmt::format_to(out, "    {}\n", wrapped(overlapWords(table), 4));
  }
  return text;
}

}  // namespace stiffscope::reports
