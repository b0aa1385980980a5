#include "reports/page/with_micro.h"

#include <array>
#include <cctype>
#include <string_view>
#include <utility>

namespace stiffscope::page {

namespace {

bool partOfWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

void replaceWord(std::string& text, std::string_view word, std::string_view by) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const bool begins = at == 0 || !partOfWord(text[at - 1]) || !partOfWord(word.front());
    const std::size_t end = at + word.size();
    const bool ends = end == text.size() || !partOfWord(text[end]) || !partOfWord(word.back());
    if (begins && ends) text.replace(at, word.size(), by);
  }
}

}  // namespace

std::string withMicro(const std::string& text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kUnits{
      {{"um", "µm"}, {"urad", "µrad"}, {"+-", "±"}, {"chi2", "χ²"}}};
  std::string words = text;
  for (const auto& [from, to] : kUnits) replaceWord(words, from, to);
  return words;
}

}  // namespace stiffscope::page
