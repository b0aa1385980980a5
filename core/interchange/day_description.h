#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign_xml.h"
#include "core/interchange/joint_log.h"
#include "core/interchange/point_reading.h"
#include "core/io/xml.h"

namespace stiffscope::interchange {

/// A stretch of a log in which the joints stand still: every joint stays within a band, for a time.
struct Standstill {
  std::size_t first = 0, last = 0;  ///< samples
  double from_s = 0.0, to_s = 0.0;  ///< by the robot's clock
};

struct StandstillOptions {
  double band =
      0.0;  ///< rad, of each joint; encoders' noise is below it, and the share of a motion that counts as still
  double shortest_s = 1.0;  ///< what is shorter is a pause of a motion
};

/// Standstills of a log whose samples have times, in their order.
std::vector<Standstill> standstillsOf(const std::vector<JointSample>& samples, const StandstillOptions& options);

/// Mean of the figures of samples first..last; where all are equal, that value to the last digit.
JointVector meanFigures(const std::vector<JointSample>& samples, std::size_t first, std::size_t last);

/// Mean of the poses that the controller states in samples first..last, turns as rotations; where all are equal, that
/// pose to the last digit. Without what one of them lacks.
campaign::StatedPose meanToolPose(const std::vector<JointSample>& samples, std::size_t first, std::size_t last);

/// A reading's time by the tracker's clock.
struct ReadingTime {
  double seconds = 0.0, resolution = 0.0;
};

/// Where the robot's clock stands beside the tracker's: t_robot = t_tracker + offset.
struct ClockOffset {
  double offset_s = 0.0;
  double uncertainty_s = 0.0;  ///< the offset lies within it: half of the offsets that serve equally
  std::size_t inside = 0;      ///< readings that fall into standstills by it
};

/// Offsets by which readings fall into standstills, the one of the most readings first. A reading may be off by the
/// last digit of its time, to either side. Starts and ends of motion bound each: an offset is the middle of those that
/// put the same readings (but 0.5 %) into standstills. Others follow as far as they put at least `share` of the most
/// into standstills, and do not touch a better one. Empty without readings or standstills.
std::vector<ClockOffset> possibleOffsets(const std::vector<ReadingTime>& readings,
                                         const std::vector<Standstill>& standstills, double share);

/// How names of points or taught targets tell what they are: `P{target}_{pose}_{step}`. A field stands for any text, as
/// short as the rest allows; {*} is not kept. A name takes time in proportion to its length times the pattern's. Parts
/// between `::` are matched with the last of collection, group and name.
class NamePattern {
 public:
  /// Fields: target, pose, step, repeat, axis, index, nest, *. Throws InputError, naming the attribute of `node`, for
  /// another field, a bracket that is not closed, or a field that stands twice.
  NamePattern(const io::XmlNode& node, const std::string& attribute, const std::string& pattern);

  bool has(const std::string& field) const;

  /// The fields in a name; nullopt where it is not of the pattern.
  std::optional<std::map<std::string, std::string>> fieldsIn(const std::string& name) const;
  std::optional<std::map<std::string, std::string>> fieldsIn(const PointReading& point) const;

 private:
  struct Piece {
    bool is_field = false;
    std::string text;  ///< the letters themselves, or the field's name; of {*} empty
  };

  std::vector<Piece> pieces_;
  std::size_t parts_ = 1;
};

/// The table of the campaign that a file of points becomes.
enum class Role { loading, circle_sweeps, wrist_sweep, nests };

inline constexpr std::array<const char*, 4> kRoleNames{"loading", "circle_sweeps", "wrist_sweep", "nests"};

inline const char* nameOf(Role role) { return kRoleNames[static_cast<std::size_t>(role)]; }

/// How readings find their joints: names say the pose; poses and taught targets follow one another in the same order;
/// or the log's clock says where the joints were.
enum class JoinBy { name, order, clock };

/// A file of points and what its rows are.
struct PointsSource {
  Role role = Role::loading;
  JoinBy by = JoinBy::order;
  std::string file = {};
  std::size_t line = 0;  ///< in DAY.xml
  FileOptions options = {};
  NamePattern names;
  std::string target = {}, pose = {}, step = {};  ///< of all rows, where given
  int axis = -1;                                  ///< from 0: the axis that turns; -1: names say it
  std::vector<std::string> only = {};             ///< names that are kept; empty: those of the role
  campaign::PointFrame frame = campaign::PointFrame::tracker;
};

struct LogSource {
  std::optional<Role> role = {};  ///< nullopt: of all points that no log has for itself
  std::string file = {};
  std::size_t line = 0;
  LogOptions options = {};
  NamePattern names;
  std::optional<double> every_s = {};  ///< of a log alone: a posture every so many seconds, moving or not
};

/// Load-cell readings by pose and step.
struct LoadsSource {
  std::string file;
  std::size_t line = 0;
  FileOptions options;
};

struct ClockOptions {
  StandstillOptions standstill;
  std::optional<double> offset_s;  ///< stated: the robot's clock less time_s of the campaign
};

/// What DAY.xml says: the campaign but for its tables, and the files these come from. docs/import.md has every element.
struct DayDescription {
  std::filesystem::path folder;
  std::string file;  ///< for messages
  campaign::CampaignXml xml;
  std::vector<PointsSource> points;
  std::vector<LogSource> logs;
  std::vector<LoadsSource> loads;
  std::map<std::string, std::string> target_names;  ///< as files name them, and as the campaign does
  ClockOptions clock;

  /// A file beside DAY.xml, for messages and to be opened.
  std::string pathOf(const std::string& name) const { return (folder / name).string(); }
};

/// Reads DAY.xml. Throws InputError, with line, attribute and value, for what it must not say; whether the files are
/// there is not looked at.
DayDescription parseDayDescription(const std::string& file, std::string_view bytes, std::vector<std::string>& warnings);

}  // namespace stiffscope::interchange
