#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace stiffscope::interchange {

/// When something was read, by the clock of the program that wrote it down. Clocks know no zone here: of two of them
/// only the difference matters, and that is found (standstill.h).
struct Timestamp {
  double seconds = 0.0;     ///< since 1970-01-01 00:00 of that clock; of a clock without a date since its start
  bool dated = false;       ///< of a calendar
  double resolution = 0.0;  ///< the last digit written, s
};

/// A date and a time as programs write them: `MM/DD/YY hh:mm:ss` (month first where there are slashes), `DD.MM.YYYY
/// hh:mm:ss.fff` (day first where there are points), `YYYY-MM-DDThh:mm:ss`, fourteen digits; with an apostrophe before
/// it, as a spreadsheet keeps text. AM or PM may follow. nullopt where `text` is none, or no day of the calendar.
std::optional<Timestamp> parseTimestamp(std::string_view text);

/// Digits as the date alone, or the time alone, is written. For rows that have them in cells of their own.
bool isDate(std::string_view text);
bool isTimeOfDay(std::string_view text);

/// 00:00:00, which programs write where nothing was measured.
bool isNoTime(std::string_view text);

/// ISO 8601, with the digits the resolution has: 2025-02-12T16:38:29.
std::string isoTime(const Timestamp& time);

}  // namespace stiffscope::interchange
