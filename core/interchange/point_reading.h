#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stiffscope::interchange {

/// How a file's bytes stand for characters. Programs of trackers and robots run on Windows: what is not UTF-8 there is
/// UTF-16 or the Western code page, or the Japanese one.
enum class Encoding { utf8, utf16_le, utf16_be, cp1252, cp932 };

/// utf-8, utf-16le, utf-16be, cp1252, cp932.
const std::vector<std::string>& encodingNames();
std::string nameOf(Encoding encoding);

/// The encoding of that name. Throws InputError, naming `option`, for another.
Encoding encodingNamed(const std::string& name, const std::string& option);

struct DecodedText {
  Encoding encoding = Encoding::utf8;
  std::string_view own;   ///< of a file in UTF-8: its bytes, which have to live as long
  std::string converted;  ///< of another

  /// UTF-8, without a byte-order mark.
  std::string_view text() const { return encoding == Encoding::utf8 ? own : std::string_view(converted); }
};

/// Bytes as UTF-8. Without `wanted` the encoding is what the file shows: a byte-order mark; zeros in every second byte;
/// UTF-8 where all of it is; else CP1252, or CP932 where a byte is none of CP1252 and all are CP932. Throws InputError,
/// with the line, where bytes are none of an encoding, where some characters are UTF-8 and others are not (two files
/// put together), and where the file shows another encoding than the one wanted. `file` is its name for messages.
DecodedText decodeText(const std::string& file, std::string_view bytes, std::optional<Encoding> wanted = std::nullopt);

/// When something was read, by the clock of the program that wrote it down. Clocks know no zone here: of two of them
/// only the difference matters, and that is found (day_description.h).
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

/// Dialects of files of points, names in the order of the enumeration. `columns` is any table whose columns the user
/// names.
enum class PointFormat { sa, leica, openindy, xyz, columns };

inline constexpr std::array<const char*, 5> kPointFormatNames{"sa", "leica", "openindy", "xyz", "columns"};
static_assert(kPointFormatNames.size() == static_cast<std::size_t>(PointFormat::columns) + 1);

inline const char* nameOf(PointFormat format) { return kPointFormatNames[static_cast<std::size_t>(format)]; }

/// What points of one group have in common. Names that a file does not state are empty.
struct PointGroup {
  std::string collection, group;
};

/// The groups of a file, each once: of a million points most share a few.
class PointGroups {
 public:
  std::shared_ptr<const PointGroup> of(std::string_view collection, std::string_view group) {
    if (last_ && last_->collection == collection && last_->group == group) return last_;
    std::shared_ptr<const PointGroup>& own = all_[{std::string(collection), std::string(group)}];
    if (!own) own = std::make_shared<PointGroup>(PointGroup{std::string(collection), std::string(group)});
    return last_ = own;
  }

 private:
  std::map<std::pair<std::string, std::string>, std::shared_ptr<const PointGroup>> all_;
  std::shared_ptr<const PointGroup> last_;
};

/// One point that a file states. Names that it does not state are empty.
struct PointReading {
  std::shared_ptr<const PointGroup> of;  ///< one of a PointGroups; null: no names of these
  std::string name;
  int occurrence = 1;  ///< this many of the same names so far: where names repeat once a pose it is the pose
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m, in the file's frame
  std::optional<Eigen::Vector3d> sigma;             ///< standard uncertainty of each coordinate, m
  std::optional<Timestamp> time;
  using Columns = std::map<std::string, std::string>;
  std::shared_ptr<const Columns> columns;  ///< pose, step, repeat, axis, index, where a table has such columns
  std::size_t line = 0;

  const std::string& collection() const { return of ? of->collection : kUnnamed; }
  const std::string& group() const { return of ? of->group : kUnnamed; }
  /// The cell of such a column; empty where there is none.
  std::string column(const std::string& name) const {
    const auto found = columns ? columns->find(name) : Columns::const_iterator();
    return !columns || found == columns->end() ? std::string() : found->second;
  }
  bool hasColumn(const std::string& name) const { return columns && columns->contains(name); }

 private:
  inline static const std::string kUnnamed;
};

/// Why a row is no reading.
enum class Skip {
  lost_beam,         ///< 0 0 0, which is what trackers write without a reflector
  marked_invalid,    ///< by the program that wrote it
  no_point,          ///< a reading of something else, such as a temperature
  another_point,     ///< its name is none of the day's
  in_motion,         ///< the joints moved
  outside_log,       ///< before the log's first or behind its last sample
  no_readings,       ///< a standstill, a target or a load for which nothing was read
  joints_not_given,  ///< a target in space, without angles
  repeated_row,      ///< says the same as an earlier row of its pose and step
  in_instruction,    ///< a joint target in a program's instruction: it has no name
  joints_computed,   ///< a joint target that a program computes, gives in part or hands on
};

struct SkippedRow {
  std::size_t line = 0;
  Skip reason = Skip::lost_beam;
};

/// What a file of points says.
struct PointFile {
  PointFormat format = PointFormat::sa;
  Encoding encoding = Encoding::utf8;
  std::string frame;  ///< as the file names it; empty where it does not
  std::vector<PointReading> points;
  std::vector<PointReading> lost;  ///< rows of lost beams, in `skipped` too: their names count as occurrences
  std::vector<SkippedRow> skipped;
  std::vector<std::string> warnings;  ///< what had to be taken for granted, one line each
};

/// What the user says of a file beside its bytes; everything else is the file's to say.
struct FileOptions {
  std::optional<PointFormat> format;
  std::optional<Encoding> encoding;
  std::string columns;    ///< names of the columns from left to right, `-` for one that is not read
  std::string separator;  ///< between columns: one character, `tab` or `blank`; else what the file shows
  bool decimal_comma = false;
  std::size_t skip = 0;  ///< lines before the first row
  std::string target;    ///< the name of all its points: one file a reflector
  std::string unit;      ///< of lengths where the file states none: mm, m or in
};

}  // namespace stiffscope::interchange
