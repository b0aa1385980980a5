#pragma once

#include <string>
#include <vector>

#include "core/conformity/decide.h"

// Acceptance limits in the words of the page, of JSON and of CSV. Rich texts.

namespace stiffscope::reports {

const char* nameOf(conformity::Verdict verdict);  ///< "pass", "fail", "not evaluated"
const char* nameOf(conformity::Missing missing);  ///< "not_identified"; empty where nothing is missing

std::string limitName(conformity::Quantity quantity);     ///< "k_{2}", "compensated at the reflectors"
std::string limitAsked(const conformity::Limit& limit);   ///< "at least 4.5·10⁶ Nm/rad"
std::string foundWords(const conformity::Decision& one);  ///< "5.58 (4.96 to 6.21)·10⁶ Nm/rad"; or why there is none
std::string verdictWords(const conformity::Decision& one);  ///< "fail: keeps the limit, but not by U"

/// How U enters.
std::string decisionRuleWords();

/// What came of all limits over the days of a report, a sentence.
std::string acceptanceSentence(const std::vector<std::vector<conformity::Decision>>& by_day);

}  // namespace stiffscope::reports
