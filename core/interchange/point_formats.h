#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/interchange/delimited_text.h"
#include "core/interchange/point_reading.h"

// The formats of points, one source each. `looksLike...` judges how a text is built; `read...` throws InputError where
// a row is not as the format has it. Occurrences are counted, and lost beams taken out, by the caller.

namespace stiffscope::interchange {

/// A text with its name for messages and what the user said of it.
struct FileText {
  const std::string& file;
  std::string_view text;
  const FileOptions& options;

  DecimalSign decimalSign() const { return options.decimal_comma ? DecimalSign::comma : DecimalSign::point; }
};

/// SpatialAnalyzer's ASCII export: `//` comments; names of none to three parts, x y z, perhaps target offsets,
/// uncertainties and a time; cells between commas or blanks. The comments give frame ('Collection::Frame'), unit (in
/// brackets) and coverage (a number before % or sigma).
enum class SaLikeness { none, possible, certain };
SaLikeness looksLikeSpatialAnalyzer(const FileText& text);
PointFile readSpatialAnalyzer(const FileText& text);

/// A table whose header has units in its columns' names, with U(95) of coordinates or a quaternion, as Leica's Absolute
/// Trackers with T-Mac write it. U(95) is expanded with k = 2.
bool looksLikeLeica(const FileText& text);
PointFile readLeica(const FileText& text);

/// A project of OpenIndy: polar readings (azimuth, zenith, distance) and Cartesian ones, of the station.
bool looksLikeOpenIndy(std::string_view text);
PointFile readOpenIndy(const FileText& text);

/// `NAME;x;y;z;;;;`
bool looksLikeSemicolonXyz(const FileText& text);
PointFile readSemicolonXyz(const FileText& text);

/// A table whose columns the user names, or whose header line has such names.
bool hasColumnHeader(const FileText& text);
PointFile readPointColumns(const FileText& text);

}  // namespace stiffscope::interchange
