#pragma once

#include <fmt/format.h>
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

// What verdicts of loaded and of unloaded days have in common: entries of effects with a detail. The effects'
// ids (idOf) are those of their vocabulary.

namespace stiffscope::reports {

/// "bearing tilt" of the id bearing_tilt.
std::string nameOfId(std::string_view id);

/// "joints 1, 2 and 4" for "joint 1, joint 2, joint 4", "joints 1 to 6" for all; other details as they are.
std::string shortDetail(const std::string& detail);

template <class Effect>
std::string namesJoined(const std::vector<Effect>& effects, const char* between) {
  std::string names;
  for (const Effect effect : effects) names += (names.empty() ? "" : between) + nameOfId(idOf(effect));
  return names;
}

/// "bearing tilt (joints 1 and 2), and hysteresis": those that can be in a model.
template <class Entry>
std::string namedOf(const std::vector<Entry>& entries) {
  std::string words;
  for (const Entry& entry : entries) {
    if (entry.effects.empty()) continue;
    words += (words.empty() ? "" : ", and ") + namesJoined(entry.effects, " or ");
    if (!entry.detail.empty()) words += fmt::format(" ({})", shortDetail(entry.detail));
  }
  return words;
}

template <class Entry>
std::string presentOf(const std::vector<Entry>& entries) {
  const bool unknown =
      std::any_of(entries.begin(), entries.end(), [](const Entry& entry) { return entry.effects.empty(); });
  std::string words = namedOf(entries);
  if (unknown) words += std::string(words.empty() ? "" : ", and ") + "something that no known effect explains";
  return words.empty() ? "nothing" : words;
}

}  // namespace stiffscope::reports
