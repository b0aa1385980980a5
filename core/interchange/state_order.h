#pragma once

#include <vector>

#include "core/interchange/joined_state.h"

namespace stiffscope::interchange {

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
