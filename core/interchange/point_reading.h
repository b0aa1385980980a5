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

#include "core/interchange/text_decoding.h"
#include "core/interchange/timestamp.h"

namespace stiffscope::interchange {

/// Dialects of files of points. `columns` is any table whose columns the user names.
enum class PointFormat { sa, leica, openindy, xyz, columns };

inline constexpr std::array<const char*, 5> kPointFormatNames{"sa", "leica", "openindy", "xyz", "columns"};

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
