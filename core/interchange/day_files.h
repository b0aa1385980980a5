#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/interchange/day_description.h"
#include "core/robot/robot.h"

namespace stiffscope::interchange {

/// A file that was read.
struct ImportedFile {
  std::string name;    ///< as DAY.xml has it
  std::string role;    ///< loading, circle_sweeps, wrist_sweep, nests, log, loads, day, urdf
  std::string format;  ///< empty: of DAY.xml and the URDF
  std::string encoding;
  std::string sha256;
};

/// What the load cell read at a pose and step: force (N) and moment (Nm) on the robot, in the cell's axes.
struct StatedLoad {
  Vector6d wrench = Vector6d::Zero();
  std::size_t file = 0, line = 0;
};

/// The contents of all files that DAY.xml names, nothing joined yet. `points` and `logs` stand in the order of
/// DayDescription::points and logs; `file` of each is its place in `files`.
struct DayFiles {
  struct Points {
    PointFile content;
    std::size_t file = 0;
  };
  struct Log {
    RobotLog content;
    std::size_t file = 0;
  };

  std::vector<ImportedFile> files;
  std::filesystem::path urdf;
  robot::Robot robot;
  std::vector<Points> points;
  std::vector<Log> logs;
  std::map<std::pair<std::string, int>, StatedLoad> loads;  ///< by pose and step
  std::string start;  ///< the tracker's date and time at time_s = 0, ISO 8601; empty where its times have no date
};

/// Reads them. Times of a calendar become seconds since the first whole second of the day, which is `start`. Throws
/// InputError for a file that is not there or cannot be read, an axis that the robot has not, points in two frames,
/// times with and without dates, and two loads of one pose and step.
DayFiles readDayFiles(const DayDescription& day, std::vector<std::string>& warnings);

/// A load step as a name or cell states it; 0 where it is empty. Throws InputError where it is no whole number, 0 or
/// more; `file` and `line` are where it stands.
int wholeStep(const std::string& file, std::size_t line, const std::string& step);

/// The standard uncertainties that files of points state.
struct StatedUncertainty {
  double sigma = 0.0;                   ///< m, median over the readings of the rms of x, y, z
  std::optional<double> over_declared;  ///< the same over the noise declared of the tracker, median; where it is
  std::size_t compared = 0;             ///< readings that were compared with it
};

/// nullopt where no file states any.
std::optional<StatedUncertainty> statedUncertainty(const std::vector<DayFiles::Points>& files,
                                                   const std::optional<campaign::Tracker>& tracker);

/// The warning of uncertainties more than a factor of 2 from the declared noise; `file` is DAY.xml.
std::optional<std::string> warningOf(const StatedUncertainty& stated, const std::string& file);

}  // namespace stiffscope::interchange
