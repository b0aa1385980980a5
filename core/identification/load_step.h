#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"

namespace stiffscope {

/// What a campaign lacks to be identified from at all, and what it is needed for; empty where it has joint
/// angles, wrenches and readings under load. A day of sweeps alone lacks these.
std::string whatLoadsLack(const Campaign& campaign);

/// Mean force of each step that `states` has, 0 among them, N.
std::map<int, double> meanForces(const Campaign& campaign);

/// The load steps that `states` has, in order; 0, the unloaded one, is none.
std::vector<int> loadSteps(const Campaign& campaign);

/// The load steps whose mean force is at least 5 % of the largest step's: the others are returns to zero.
std::vector<int> loadedSteps(const Campaign& campaign);

/// The step to identify from: the one asked for, else the one with the largest mean force.
/// Throws InputError where the campaign has no loads, where it does not have that step (the message lists
/// those it has), or where no step has a force.
int chosenStep(const Campaign& campaign, const std::optional<int>& asked);

}  // namespace stiffscope
