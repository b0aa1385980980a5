#include "core/interchange/point_reading.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/interchange/delimited_text.h"
#include "core/io/numbers.h"

namespace stiffscope::interchange {

namespace {

bool allDigits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Whole numbers between separators; empty where a part is none.
std::vector<int> wholeNumbers(std::string_view text, char separator) {
  std::vector<int> numbers;
  for (const std::string_view part : cellsBetween(text, separator)) {
    const auto number = allDigits(part) ? io::parseInteger(part) : std::nullopt;
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<double> daysOf(int year, int month, int day) {
  // Two digits of a year are of this century or, above 79, of the last: no tracker is older.
  constexpr int kFirstYear = 80;
  if (year < 100) year += year >= kFirstYear ? 1900 : 2000;
  // The calendar's types are narrow: what does not fit would come back as another date.
  constexpr int kLastYear = 9999, kLastMonth = 12, kLastDay = 31;
  if (year > kLastYear || month < 1 || month > kLastMonth || day < 1 || day > kLastDay) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return std::nullopt;
  return static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

std::optional<double> parseDate(std::string_view text) {
  struct Order {
    char separator;
    std::array<std::size_t, 3> year_month_day;
  };
  constexpr std::array<Order, 3> kOrders{{{'/', {2, 0, 1}}, {'.', {2, 1, 0}}, {'-', {0, 1, 2}}}};
  for (const Order& order : kOrders) {
    if (text.find(order.separator) == std::string_view::npos) continue;
    const std::vector<int> parts = wholeNumbers(text, order.separator);
    if (parts.size() != 3) return std::nullopt;
    // A year stands first in both orders where it has four digits: 2025/02/12.
    constexpr int kFourDigits = 1000;
    if (parts[0] >= kFourDigits) return daysOf(parts[0], parts[1], parts[2]);
    return daysOf(parts[order.year_month_day[0]], parts[order.year_month_day[1]], parts[order.year_month_day[2]]);
  }
  return std::nullopt;
}

struct TimeOfDay {
  double seconds = 0.0, resolution = 1.0;
};

std::optional<TimeOfDay> parseTimeOfDay(std::string_view text, std::string_view half_of_day) {
  if (text.ends_with('Z')) text.remove_suffix(1);
  const std::vector<std::string_view> parts = cellsBetween(text, ':');
  if (parts.size() < 2 || parts.size() > 3 || !allDigits(parts[0]) || !allDigits(parts[1])) return std::nullopt;
  const std::optional<int> hour = io::parseInteger(parts[0]), minute = io::parseInteger(parts[1]);
  const std::string_view seconds = parts.size() == 3 ? parts[2] : "0";
  if (!hour || !minute || seconds.empty() || seconds.front() < '0' || seconds.front() > '9') return std::nullopt;
  const bool comma = seconds.find(',') != std::string_view::npos;
  const double second = decimalOrNan(seconds, comma ? DecimalSign::comma : DecimalSign::point);
  if (!(*hour < 24 && *minute < 60 && second < 61.0) || decimalsOf(seconds) < 0) return std::nullopt;
  int hours = *hour;
  if (!half_of_day.empty()) hours = hours % 12 + (half_of_day == "pm" ? 12 : 0);
  const double resolution = parts.size() == 2 ? 60.0 : std::pow(10.0, -decimalsOf(seconds));
  return TimeOfDay{hours * 3600.0 + *minute * 60.0 + second, resolution};
}

std::optional<Timestamp> parseDigits(std::string_view text) {
  constexpr std::size_t kDigits = 14;  // YYYYMMDDhhmmss
  if (text.size() != kDigits || !allDigits(text)) return std::nullopt;
  const auto part = [&](std::size_t from, std::size_t count) { return *io::parseInteger(text.substr(from, count)); };
  const auto days = daysOf(part(0, 4), part(4, 2), part(6, 2));
  const auto time = parseTimeOfDay(fmt::format("{}:{}:{}", text.substr(8, 2), text.substr(10, 2), text.substr(12)), {});
  if (!days || !time) return std::nullopt;
  return Timestamp{*days * 86400.0 + time->seconds, true, 1.0};
}

}  // namespace

bool isDate(std::string_view text) { return parseDate(text).has_value(); }

bool isTimeOfDay(std::string_view text) { return parseTimeOfDay(text, {}).has_value(); }

bool isNoTime(std::string_view text) {
  const auto time = parseTimeOfDay(text, {});
  return time && time->seconds == 0.0;
}

std::optional<Timestamp> parseTimestamp(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('\'')) text = trimmed(text.substr(1));
  if (const auto compact = parseDigits(text)) return compact;
  const std::size_t between = text.find_first_of(" T");
  if (between == std::string_view::npos) return std::nullopt;
  const auto days = parseDate(text.substr(0, between));
  std::string_view rest = trimmed(text.substr(between + 1));
  std::string half_of_day = lowered(rest.substr(rest.size() - std::min<std::size_t>(2, rest.size())));
  if (half_of_day == "am" || half_of_day == "pm") {
    rest = trimmed(rest.substr(0, rest.size() - 2));
  } else {
    half_of_day.clear();
  }
  const auto time = parseTimeOfDay(rest, half_of_day);
  if (!days || !time) return std::nullopt;
  return Timestamp{*days * 86400.0 + time->seconds, true, time->resolution};
}

std::string isoTime(const Timestamp& time) {
  const int decimals = std::clamp(static_cast<int>(std::lround(-std::log10(time.resolution))), 0, 6);
  // In whole ticks of the last digit: 59.9999999 s must not become 60.
  const auto per_second = static_cast<std::int64_t>(std::llround(std::pow(10.0, decimals)));
  const auto ticks = static_cast<std::int64_t>(std::llround(time.seconds * static_cast<double>(per_second)));
  const std::int64_t ticks_a_day = 86400 * per_second;
  const std::int64_t days = ticks / ticks_a_day - (ticks % ticks_a_day < 0 ? 1 : 0);
  const std::int64_t of_day = ticks - days * ticks_a_day, second = of_day / per_second;
  const std::chrono::year_month_day date{std::chrono::sys_days(std::chrono::days(days))};
  std::string text = fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", static_cast<int>(date.year()),
                                 static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), second / 3600,
                                 second / 60 % 60, second % 60);
  return decimals == 0 ? text : text + fmt::format(".{:0{}}", of_day % per_second, decimals);
}

}  // namespace stiffscope::interchange
