#pragma once

#include "core/campaign/campaign.h"
#include "core/simulation/equilibrium.h"
#include "core/simulation/machine.h"
#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// The day as it would read with a perfect tracker and load cell: every table the specification asks for,
/// true points in the tracker frame, true load wrenches, reported joint angles (rounded to the read-back),
/// times. What the campaign declares (nominal robot, gravity, tool, tracker, load cell) is what the
/// specification declares, not the truth. The order of the day: nests, circle sweeps, wrist sweep, poses;
/// nests again whenever their interval has passed, and last. Throws InputError naming the posture where a
/// load leaves no stable equilibrium or one more than 0.1 rad (or m) away, where the load cell's parent is
/// not a link of the robot, and where drawn postures cannot keep their rules.
campaign::Campaign measureWithoutNoise(const ElasticMachine& machine, const SimulationSpec& spec);

/// The same as measured: buildMachine, measureWithoutNoise, then the errors of load cell and tracker. The
/// same specification gives the same numbers.
campaign::Campaign simulate(const SimulationSpec& spec);

}  // namespace stiffscope::simulation
