#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign_xml.h"
#include "core/interchange/joint_log.h"
#include "core/interchange/name_pattern.h"
#include "core/interchange/standstill.h"

namespace stiffscope::interchange {

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
  std::string file;
  std::size_t line = 0;  ///< in DAY.xml
  FileOptions options;
  NamePattern names;
  std::string target, pose, step;  ///< of all rows, where given
  int axis = -1;                   ///< 0..5: the axis that turns; -1: names say it
  std::vector<std::string> only;   ///< names that are kept; empty: those of the role
  campaign::PointFrame frame = campaign::PointFrame::tracker;
};

struct LogSource {
  std::optional<Role> role;  ///< nullopt: of all points that no log has for itself
  std::string file;
  std::size_t line = 0;
  LogOptions options;
  NamePattern names;
  std::optional<double> every_s;  ///< of a log alone: a posture every so many seconds, moving or not
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
