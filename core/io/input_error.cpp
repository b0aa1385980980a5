#include "core/io/input_error.h"

#include <fmt/format.h>
#include <utf8.h>
#include <algorithm>
#include <cstdint>
#include <numeric>

namespace stiffscope::io {

std::string inputMessage(const InputPlace& place, std::string_view value, std::string_view finding) {
  constexpr std::size_t kLongestValue = 80;
  constexpr std::size_t kLongestText = 1000;
  std::string text = oneLine(place.file, kLongestText);
  if (place.line > 0) text += fmt::format(":{}", place.line);
  if (!text.empty()) text += ": ";
  if (!place.column.empty()) text += fmt::format("{}: ", oneLine(place.column, kLongestValue));
  if (!value.empty()) text += fmt::format("'{}': ", oneLine(value, kLongestValue));
  return text + oneLine(finding, kLongestText);
}

InputError::InputError(InputPlace place, std::string value, std::string expectation)
    : std::runtime_error(inputMessage(place, value, expectation)),
      place_(std::move(place)),
      value_(std::move(value)),
      expectation_(std::move(expectation)) {}

namespace {

char lower(char c) { return (c >= 'A' && c <= 'Z') ? static_cast<char>(c - 'A' + 'a') : c; }

bool same(char a, char b) { return lower(a) == lower(b); }

}  // namespace

std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> two_above(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  std::iota(above.begin(), above.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = above[j - 1] + (same(a[i - 1], b[j - 1]) ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1])) {
        row[j] = std::min(row[j], two_above[j - 2] + 1);
      }
    }
    std::swap(two_above, above);
    std::swap(above, row);
  }
  return above[b.size()];
}

std::string nearestName(std::string_view word, const std::vector<std::string>& candidates) {
  // A longer word cannot be a slip of any name here, and the cost grows with the square of the length.
  constexpr std::size_t kLongest = 200;
  if (word.empty() || word.size() > kLongest) return {};
  std::string nearest;
  std::size_t fewest = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongest) continue;
    const std::size_t edits = editDistance(word, candidate);
    if (edits < fewest && edits < candidate.size()) {
      fewest = edits;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string nearestNameHint(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearestName(word, candidates);
  return nearest.empty() ? std::string() : fmt::format(" (did you mean '{}'?)", nearest);
}

namespace {

// Bytes of the character that starts `text`, 0 where it cannot be shown: no UTF-8, or a control character.
// The C1 ones (U+0080..U+009F) are among them: some terminals obey them.
std::size_t shownLength(std::string_view text) {
  const char* end = text.data();
  try {
    const auto character = static_cast<std::uint32_t>(utf8::next(end, text.data() + text.size()));
    const bool control = character < 0x20 || (character >= 0x7f && character < 0xa0);
    return control ? 0 : static_cast<std::size_t>(end - text.data());
  } catch (const utf8::exception&) {
    return 0;
  }
}

}  // namespace

std::string oneLine(std::string_view text, std::size_t longest) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t length = shownLength(text);
    const std::size_t taken = length == 0 ? 1 : length;
    if (shown.size() + taken > longest) {
      shown += "...";
      break;
    }
    shown += length == 0 ? std::string_view("?") : text.substr(0, length);
    text.remove_prefix(taken);
  }
  return shown;
}

std::string withoutControls(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const bool kept = text[0] == '\n' || text[0] == '\t';
    const std::size_t length = kept ? 1 : shownLength(text);
    shown += length == 0 ? std::string_view("?") : text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return shown;
}

std::size_t findNotUtf8(std::string_view text) {
  const char* const end = text.data() + text.size();
  const char* const invalid = utf8::find_invalid(text.data(), end);
  return invalid == end ? std::string_view::npos : static_cast<std::size_t>(invalid - text.data());
}

}  // namespace stiffscope::io
