#pragma once

#include <string>

#include "core/fleet/fleet.h"

// The tables of a fleet (docs/fleet.md lists their columns): numbers with their unit in the column's name, interval
// ends apart, nothing where a number is not known.

namespace stiffscope::reports {

std::string fleetCsv(const fleet::Fleet& fleet);    ///< fleet.csv: a row a campaign
std::string changesCsv(const fleet::Fleet& fleet);  ///< changes.csv: a row a joint, or geometry, of two dates
std::string stepsCsv(const fleet::Fleet& fleet);    ///< steps.csv: a row a thing that is another from a date on
/// detectable.csv: a row a joint of a series of dates, and by how much it has to change to be found.
std::string detectableCsv(const fleet::Fleet& fleet);
std::string needsCsv(const fleet::Fleet& fleet);  ///< needs.csv: a row a need, machines that need most first

}  // namespace stiffscope::reports
