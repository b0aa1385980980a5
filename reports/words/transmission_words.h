#pragma once

#include <string>
#include <vector>

#include "core/identification/transmission.h"

namespace stiffscope::identification {
struct Identification;
}

namespace stiffscope::reports {

/// A side of the gear: a key of JSON ("link_side"), and words ("link side").
const char* keyOf(identification::HeldSide held);
const char* wordsOf(identification::HeldSide held);

/// How gear and structure go together: a key of JSON ("structure_seen"), and a clause.
const char* keyOf(identification::GearAgreement agreement);
const char* wordsOf(identification::GearAgreement agreement);

/// What to know of the gears of a result besides their numbers, a sentence each: joints that cannot be measured,
/// readings left out, lost motion, loops that are not as declared. Plain texts.
std::vector<std::string> transmissionNotes(const identification::Transmission& transmission);

}  // namespace stiffscope::reports
