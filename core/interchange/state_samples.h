#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <tuple>

#include "core/interchange/joined_state.h"

// What a state takes from its samples of the log: parts that all ways of joining share.

namespace stiffscope::interchange {

using StateKey = std::tuple<int, std::string, int>;  ///< axis, pose, step

/// "axis 2, pose 7, step 1": axis and step where there are any.
std::string shownKey(const StateKey& key);

/// Whether every sample has a time.
bool isTimed(const RobotLog& log);

/// Makes the state's figures the mean of these samples.
void setSamples(JoinedState& state, const RobotLog& log, std::size_t first, std::size_t last);

/// Whether the states' wrenches are the log's: it has some, and no file of loads has others.
bool takesWrench(const JoinTask& task);

/// Where a wrench goes from one level to another.
struct WrenchChange {
  std::size_t sample = 0;            ///< the first of the other level
  Eigen::Index component = 0;        ///< of the wrench
  double before = 0.0, after = 0.0;  ///< means on both sides, N or Nm
};

/// Tells a change of load from the scatter of a load cell.
class WrenchSteadiness {
 public:
  /// Of a log with a wrench.
  explicit WrenchSteadiness(const JoinTask& task);

  /// The largest change within samples first..last: means of the samples before and from some sample on that differ by
  /// more than six times the scatter (from sample to sample, or as load_cell states it), 5 % of the log's largest force
  /// or moment, and 1 N or Nm; nullopt where there is none. Each side has a tenth of the samples at least: a single
  /// spike is no load.
  std::optional<WrenchChange> changeIn(std::size_t first, std::size_t last) const;

 private:
  const RobotLog& log_;
  Vector6d allowed_;
};

/// Throws InputError, with the line of the log, where the wrench changes within the state's samples, so that their mean
/// is none that was ever there. `hint` says what the user can do.
void requireSteadyWrench(const JoinTask& task, const WrenchSteadiness& steadiness, const JoinedState& state,
                         const std::string& hint);

/// Means of what a table of states has beside the joints; not a number where the log does not say.
struct StateMeans {
  Vector6d wrench;  ///< N, Nm
  double temperature_c = campaign::kNotGiven;
  campaign::StatedPose tool_pose;
  JointVector motor_side, commanded;  ///< rad, as the controller states them; of the samples that have them
};

StateMeans meansOf(const RobotLog& log, std::size_t first, std::size_t last);

/// What was not read is not zero: where states have no wrench (`without` of them) all lose theirs, so that the table is
/// written without the columns. Returns the warning of load steps that are left without, or of wrenches that are lost
/// as others have none.
std::optional<std::string> leaveWrenchesOut(campaign::Campaign& campaign, std::size_t without, const std::string& day);

/// The warning of what a log has and no table takes: motor-side and commanded angles of one that gives joints to sweeps
/// alone (no state is of it), the wrench beside a file of loads.
std::optional<std::string> warningOfUntaken(const RobotLog& log, const std::string& file, bool gives_states,
                                            bool loads_elsewhere);

}  // namespace stiffscope::interchange
