#pragma once

#include <fmt/format.h>
#include <cstddef>
#include <string>
#include <vector>

namespace stiffscope::reports {

/// Entries that a text or a page shows of a list that grows with the data.
inline constexpr std::size_t kMostListed = 10;
inline constexpr std::size_t kMostRows = 100;  ///< of a table with a row a posture

/// Where the whole of such a list stands.
inline constexpr const char* kListedInJson = "--json";
inline constexpr const char* kListedInResults = "results.json";

/// The words of the first items; where there are more, a last entry says how many and where all of them stand.
template <class Item, class Words>
std::vector<std::string> listed(const std::vector<Item>& items, const Words& words, const char* whole,
                                std::size_t most = kMostListed) {
  std::vector<std::string> entries;
  for (const Item& item : items) {
    if (entries.size() == most) {
      entries.push_back(fmt::format("and {} more; all of them in {}", items.size() - most, whole));
      break;
    }
    entries.push_back(words(item));
  }
  return entries;
}

}  // namespace stiffscope::reports
