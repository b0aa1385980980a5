#include "core/input/one_line.h"

#include "core/input/utf8.h"

namespace stiffscope {

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

}  // namespace stiffscope
