#include "core/io/input_error.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
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
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x20 || first == 0x7f) return 0;
  const std::size_t length = utf8CharacterLength(text);
  return (first == 0xc2 && length == 2 && static_cast<unsigned char>(text[1]) < 0xa0) ? 0 : length;
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

namespace {

// Most text is ASCII, of which eight bytes are looked at in one go.
bool startsWithEightAscii(std::string_view text) {
  std::uint64_t eight = 0;
  if (text.size() < sizeof eight) return false;
  std::memcpy(&eight, text.data(), sizeof eight);
  return (eight & 0x8080808080808080ull) == 0;
}

}  // namespace

std::size_t utf8CharacterLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (text.empty()) return 0;
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  // Longer forms than needed, surrogates, and what lies beyond U+10FFFF.
  const unsigned char second = byte(1);
  const bool wrong = (first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
                     (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90);
  return wrong ? 0 : length;
}

std::size_t findNotUtf8(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    if (startsWithEightAscii(text.substr(at))) {
      at += 8;
      continue;
    }
    const std::size_t length = utf8CharacterLength(text.substr(at, 4));
    if (length == 0) return at;
    at += length;
  }
  return std::string_view::npos;
}

}  // namespace stiffscope::io
