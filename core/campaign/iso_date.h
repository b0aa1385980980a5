#pragma once

#include <algorithm>
#include <charconv>
#include <chrono>
#include <string_view>

namespace stiffscope::campaign {

/// A day of the calendar as ISO 8601 writes it: 2026-11-21.
inline bool isIsoDate(std::string_view text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return false;
  const auto number = [text](std::size_t from, std::size_t count) {
    const std::string_view digits = text.substr(from, count);
    int value = -1;
    if (std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; }))
      std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return value;
  };
  const int year = number(0, 4), month = number(5, 2), day = number(8, 2);
  return year >= 0 && month >= 0 && day >= 0 &&
         std::chrono::year_month_day{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                     std::chrono::day(static_cast<unsigned>(day))}
             .ok();
}

/// Such a day, perhaps with a time of day or the last day of several behind it: "2026-11-21T09:30",
/// "2026-11-21/2026-11-22". As texts they are in the order of their days.
inline bool beginsWithIsoDate(std::string_view text) {
  constexpr std::size_t kDate = 10;
  return isIsoDate(text.substr(0, kDate)) &&
         (text.size() == kDate || std::string_view("T /").find(text[kDate]) != std::string_view::npos);
}

}  // namespace stiffscope::campaign
