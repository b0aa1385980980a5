#include "reports/diagnosis_words.h"

namespace stiffscope {

std::string effectNames(const std::vector<Effect>& effects) {
  std::string names;
  for (const Effect effect : effects) names += (names.empty() ? "" : " or ") + std::string(idOf(effect));
  return names;
}

std::string verdictWords(const Verdict& verdict) {
  if (verdict.entries.empty()) return "none";
  std::string line;
  for (const VerdictEntry& entry : verdict.entries) {
    line += line.empty() ? "" : ", and ";
    line += entry.effects.empty() ? "unknown" : effectNames(entry.effects);
    if (!entry.detail.empty()) line += " (" + entry.detail + ")";
  }
  return line;
}

}  // namespace stiffscope
