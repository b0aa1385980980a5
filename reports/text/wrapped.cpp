#include "reports/text/wrapped.h"

#include <sstream>

namespace stiffscope {

std::string wrapped(const std::string& text, std::size_t indent) {
  constexpr std::size_t kColumns = 98;
  std::istringstream words(text);
  std::string result, word;
  std::size_t column = 0;
  while (words >> word) {
    if (column > 0 && column + 1 + word.size() > kColumns) {
      result += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (column > 0) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

}  // namespace stiffscope
