#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace stiffscope {

/// Edits that turn `a` into `b`: insertions, deletions, replacements, and swaps of two neighbours, each
/// counting one (optimal string alignment distance); letter case does not count.
std::size_t editDistance(std::string_view a, std::string_view b);

/// The candidate that a person who wrote `word` most likely meant: the one with the fewest edits, the first
/// of equals; empty where even that differs in more than a third of the letters (at least one edit is
/// allowed).
std::string nearestName(std::string_view word, const std::vector<std::string>& candidates);

/// " (did you mean 'X'?)" with the nearest candidate, or nothing, to end a message with.
std::string nearestNameHint(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace stiffscope
