#include "tests/fuzz/mutate.h"

#include <algorithm>

namespace stiffscope::fuzz {

// Steele, Lea and Flood's SplitMix64; the standard library's distributions differ between implementations.
std::size_t Mutator::below(std::size_t count) {
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return count == 0 ? 0 : static_cast<std::size_t>((z ^ (z >> 31)) % count);
}

void Mutator::change(std::string& text) {
  const std::size_t at = below(text.size() + 1);
  const std::size_t length = std::min(below(16) + 1, text.size() - at);
  switch (below(7)) {
    case 0:
      if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
      break;
    case 1:
      text.erase(at, length);
      break;
    case 2:
      text.insert(at, text.substr(at, length));
      break;
    case 3:
      text.insert(at, 1, static_cast<char>(below(256)));
      break;
    case 4:
      text.resize(at);
      break;
    case 5: {
      const std::string& other = texts_[below(texts_.size())];
      const std::size_t from = below(other.size() + 1);
      text.insert(at, other, from, below(64));
      break;
    }
    default:
      if (words_.empty()) break;
      text.replace(at, length, words_[below(words_.size())]);
  }
}

std::string Mutator::next() {
  std::string text = texts_[below(texts_.size())];
  for (std::size_t changes = below(8) + 1; changes > 0; --changes) change(text);
  return text;
}

}  // namespace stiffscope::fuzz
