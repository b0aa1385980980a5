#include <fmt/format.h>

#include <numeric>

#include "reports/page/blind_sections.h"

namespace stiffscope::page {

namespace {

std::string styleOf(int count, int row_total, bool right) {
  constexpr const char* kNarrow = "padding:.28rem .4rem;text-align:center";
  if (count == 0) return kNarrow;
  const double share = static_cast<double>(count) / row_total;
  return fmt::format("{};background:rgba({},{:.2f})", kNarrow, right ? "40,140,80" : "200,80,40",
                     0.12 + 0.6 * share);
}

}  // namespace

void writeBlindConfusion(Html& html, const blind::Confusion& confusion) {
  html.leaf("h2", "What was, and what was said");
  html.paragraph(
      "Rows: the truth, doubles aside. Columns: the answer; a class with the true effect in it counts as "
      "that effect.");
  const auto scroll = html.element("div", {{"class", "scroll"}});
  const auto table = html.element("table");
  {
    const auto head = html.element("thead");
    const auto row = html.element("tr");
    html.leaf("th", "", {{"scope", "col"}});
    for (const std::string& name : confusion.answers) {
      html.leaf("th", name, {{"scope", "col"}, {"style", "writing-mode:vertical-rl;padding:.3rem .2rem"}});
    }
  }
  const auto body = html.element("tbody");
  for (std::size_t r = 0; r < confusion.truths.size(); ++r) {
    const std::vector<int>& counts = confusion.counts[r];
    const int total = std::accumulate(counts.begin(), counts.end(), 0);
    if (total == 0) continue;
    const auto row = html.element("tr");
    html.leaf("th", confusion.truths[r], {{"scope", "row"}});
    for (std::size_t c = 0; c < counts.size(); ++c) {
      const bool right = confusion.answers[c] == confusion.truths[r] ||
                         (confusion.truths[r] == "outside" && confusion.answers[c] == "unknown");
      html.leaf("td", counts[c] > 0 ? std::to_string(counts[c]) : "",
                {{"style", styleOf(counts[c], total, right)}});
    }
  }
}

}  // namespace stiffscope::page
