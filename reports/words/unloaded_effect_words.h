#pragma once

#include <string>
#include <vector>

#include "core/accuracy/accuracy_diagnosis.h"

// Effects of days without a load in the words of the page and its pictures. Plain texts, not rich ones.

namespace stiffscope::reports {

std::string effectName(calibration::UnloadedEffect effect);  ///< "transmission error"
std::string effectNames(const std::vector<calibration::UnloadedEffect>& effects, const char* between = " or ");
std::string effectMeaning(calibration::UnloadedEffect effect);  ///< what the machine or the measurement then does
std::string effectRemedy(calibration::UnloadedEffect effect);   ///< rich text: what a laboratory can do about it

/// "transmission error (joint 6), and backlash (joint 2)"; empty where nothing is named.
std::string namedWords(const std::vector<accuracy::AccuracyEntry>& verdict);

/// The same with "something that no known effect explains" where that is in the verdict; "nothing" of an empty one.
std::string presentWords(const std::vector<accuracy::AccuracyEntry>& verdict);

}  // namespace stiffscope::reports
