#pragma once

#include <string>
#include <vector>

#include "core/diagnosis/diagnosis.h"
#include "reports/words/entry_words.h"

// Effects in the words of the page and its pictures. Plain texts, not rich ones: details name reflectors.

namespace stiffscope::reports {

/// Why no share held out is stated (diagnosis::Shrink::judged).
std::string notHeldOutWords();

std::string effectName(effects::Effect effect);  ///< "bearing tilt"
/// "bearing tilt or link compliance".
std::string effectNames(const std::vector<effects::Effect>& effects, const char* between = " or ");
std::string effectMeaning(effects::Effect effect);  ///< what the machine then does
std::string effectRemedy(effects::Effect effect);   ///< rich text: what a laboratory can do about it, one sentence
std::string effectUse(effects::Effect effect);      ///< what is done with it in the extended model, and why

/// "bearing tilt (joints 1 and 2), and hysteresis": those that can be in a model; empty where there is none.
std::string namedWords(const diagnosis::Verdict& verdict);

/// "bearing tilt (joints 1 and 2), and something that no known effect explains"; "nothing" where nothing is
/// present.
std::string presentWords(const diagnosis::Verdict& verdict);

/// "-1.3"; "> 8.2" and "< -8.2" at the limit of what a deviate says (numerics::kLargestDeviate).
std::string deviateWords(double deviate);

/// What a table whose parts overlap adds up to; empty where they do not.
std::string overlapWords(const diagnosis::WhereTable& table);

/// Why the verdict is what it is, sentence after sentence.
std::string reasonWords(const diagnosis::Verdict& verdict);

}  // namespace stiffscope::reports
