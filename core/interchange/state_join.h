#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/interchange/joined_state.h"
#include "core/interchange/point_reading.h"

namespace stiffscope::interchange {

/// Where a reflector was read while the controller stated these figures.
struct PlacedReading {
  JointVector figures;  ///< rad, as the controller states them
  int target = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m
};

/// How far distances between a reflector's places are from those of the nominal arm: root mean square of
/// |T_k c - T_l c| - s |p_k - p_l| over pairs of postures k, l, where T is base_from_flange and c the reflector on the
/// flange, fitted for each. No frame enters, so it judges figures, units and which readings belong to which posture
/// before anything else is known. nullopt where no reflector was read in six postures.
std::optional<double> chordMisfit(const robot::Robot& robot, const std::vector<campaign::JointReading>& convention,
                                  const std::vector<PlacedReading>& readings, double scale = 1.0);

/// Arms differ from their nominal geometry, and bend, by a few millimetres, m; a wrong sign, or the joints of another
/// posture, make decimetres. What explains these makes distances agree so many times better.
inline constexpr double kAsArmsDiffer = 0.01, kExplains = 4.0;

/// What else the figures or the points could mean.
struct OtherMeaning {
  enum class Kind { sign, coupling, offset, unit };
  Kind kind = Kind::sign;
  int joint = 0;        ///< from 0, of the first three kinds
  int plus = -1;        ///< from 0, of a coupling
  double value = 0.0;   ///< sign; offset, rad; or the factor that points are to be multiplied by
  double misfit = 0.0;  ///< m
};

/// Tries each joint's other sign, each joint plus or without the one before it, offsets of a quarter and half a turn,
/// and other units of length, one at a time. Returns the one that fits best and those that fit as well (up to twice its
/// misfit), best first: of six joints with a spherical wrist the other sign of joint 5 is half a turn of joint 4. Empty
/// where no reflector was read in six postures.
std::vector<OtherMeaning> otherMeanings(const robot::Robot& robot,
                                        const std::vector<campaign::JointReading>& convention,
                                        const std::vector<PlacedReading>& readings);

/// The two clocks, as they were found or stated.
struct ClockReport {
  std::string log;
  double offset_s = 0.0;       ///< robot's clock less time_s of the campaign
  double uncertainty_s = 0.0;  ///< the offset lies within it; 0 where it was stated
  bool stated = false;
  std::size_t readings = 0, inside = 0, standstills = 0;
  std::optional<double> misfit;  ///< m, of distances by it (chord check above)
};

struct StateJoin {
  std::vector<JoinedState> states;
  std::vector<std::pair<std::size_t, Skip>> left_out;          ///< readings, and why
  std::vector<std::pair<std::size_t, std::size_t>> stretches;  ///< first and last sample of all that could be joined
  std::optional<ClockReport> clock;
  std::vector<std::size_t> merged = {};  ///< samples that say the same as an earlier one of their pose and step
  std::vector<std::string> warnings = {};
};

/// The joints of every pose that readings name, by the names of the log's rows or targets. Joints of a log that names
/// no step hold for all steps of their pose. Throws InputError for a pose or step without joints, for two rows of one
/// pose and step that differ, and for two steps that would share a wrench or an angle of the motor's side.
StateJoin joinByName(const JoinTask& task, const std::vector<DayReading>& readings);

/// Poses in the order in which the robot came to them (statesInKnownOrder), and the log's targets, or the standstills
/// of a log by time, in theirs. Throws InputError where that order cannot be known, where they are not as many, and
/// where the wrench changes within a standstill.
StateJoin joinByOrder(const JoinTask& task, const std::vector<DayReading>& readings);

/// Poses by their names or occurrences, without joints: of a day that has no log.
StateJoin joinNothing(const std::vector<DayReading>& readings);

/// Every posture of a log on its own: the standstills of one with times, or a sample every so often, numbered from 1;
/// else its rows or targets by their names. Throws InputError where there is none, for two rows of one pose and step
/// that differ, and where the wrench changes within a standstill.
StateJoin posturesOf(const JoinTask& task);

/// Readings by the standstill that they fall into, with the offset of the clocks that puts most of them into one. Where
/// several offsets put nearly as many there, and leave hardly more in motion, distances between the reflectors' places
/// decide (chord check above). Throws InputError where a time is missing, no offset serves, several do alike, the one
/// stated does not or distances contradict it and agree by another, or the wrench changes while a state is read.
StateJoin joinByClock(const JoinTask& task, const std::vector<DayReading>& readings);

/// One reading of each reflector and state, for the check of distances. Loads move reflectors by millimetres; readings
/// of another pose are off by decimetres, and often it is those of the last step.
std::vector<PlacedReading> placedReadings(const std::vector<JoinedState>& states,
                                          const std::vector<DayReading>& readings);

/// Throws InputError where distances between the reflectors' places contradict the figures, and another sign, coupling,
/// offset or unit would make them agree; that is named.
void requireMeaning(const JoinTask& task, const std::vector<PlacedReading>& placed, double misfit);

/// The states of readings and lost beams in the order in which the robot came to them; those of lost beams alone have
/// no readings.
///
/// A file written posture by posture shows the order by itself. Of one that has all readings of a reflector together,
/// and of several files, each reflector has its own part of the order, by where it first stands; a state that one
/// reflector lacks has its place by the others. Files that have no state in common follow one another as they are
/// listed. Throws InputError where two parts contradict each other, and where none tells which of two states came
/// first: a row that is missing would give every later state the joints of its neighbour.
std::vector<JoinedState> statesInKnownOrder(const JoinTask& task, const std::vector<DayReading>& readings);

}  // namespace stiffscope::interchange
