#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/interchange/text_decoding.h"
#include "core/interchange/timestamp.h"

namespace stiffscope::interchange {

/// Dialects of files of points. `columns` is any table whose columns the user names.
enum class PointFormat { sa, leica, openindy, xyz, columns };

inline constexpr std::array<const char*, 5> kPointFormatNames{"sa", "leica", "openindy", "xyz", "columns"};

inline const char* nameOf(PointFormat format) { return kPointFormatNames[static_cast<std::size_t>(format)]; }

/// One point that a file states. Names that it does not state are empty.
struct PointReading {
  std::string collection, group, name;
  int occurrence = 1;  ///< this many of the same names so far: where names repeat once a pose it is the pose
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m, in the file's frame
  std::optional<Eigen::Vector3d> sigma;             ///< standard uncertainty of each coordinate, m
  std::optional<Timestamp> time;
  std::map<std::string, std::string> columns;  ///< pose, step, repeat, axis, index, where a table has such columns
  std::size_t line = 0;
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
