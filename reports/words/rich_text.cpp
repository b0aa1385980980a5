#include "reports/words/rich_text.h"

#include <array>
#include <regex>
#include <string_view>

namespace stiffscope::reports {

namespace {

constexpr char kAsIs = '\x1b';  // a campaign's own texts have no control characters left once they stand in a rich text

/// Where a stretch of another kind begins and ends; in the order of RichStretch::Kind.
struct Mark {
  const char* open;
  const char* close;
};
constexpr std::array<Mark, 4> kMarks{{{"_{", "}"}, {"`", "`"}, {"\x1b", "\x1b"}, {"@{", "}"}}};

}  // namespace

std::vector<RichStretch> richStretches(const std::string& rich_text) {
  std::vector<RichStretch> stretches;
  std::string_view text = rich_text;
  std::size_t from = 0;  // marks before it are text
  while (!text.empty()) {
    std::size_t open = std::string_view::npos, kind = RichStretch::normal;
    for (std::size_t i = 0; i < kMarks.size(); ++i) {
      const std::size_t at = text.find(kMarks[i].open, from);
      if (at < open) open = at, kind = i;
    }
    if (kind == RichStretch::normal) break;
    const std::size_t begin = open + std::string_view(kMarks[kind].open).size();
    const std::size_t close = text.find(kMarks[kind].close, begin);
    if (close == std::string_view::npos) {
      from = begin;
      continue;
    }
    if (open > 0) stretches.push_back({std::string(text.substr(0, open)), RichStretch::normal});
    stretches.push_back({std::string(text.substr(begin, close - begin)), static_cast<RichStretch::Kind>(kind)});
    text.remove_prefix(close + 1);
    from = 0;
  }
  if (!text.empty()) stretches.push_back({std::string(text), RichStretch::normal});
  return stretches;
}

std::string withSubscripts(const std::string& sentence) {
  static const std::regex point(R"(\b([PK])_(TCP|wrist|x|c)\b)"), stiffness(R"(\bk([1-8])\b)");
  return std::regex_replace(std::regex_replace(sentence, point, "$1_{$2}"), stiffness, "k_{$1}");
}

std::string plain(const std::string& rich_text) {
  std::string text;
  for (const RichStretch& stretch : richStretches(rich_text)) text += stretch.text;
  return text;
}

std::string asIs(const std::string& text) {
  std::string inside = text;
  std::erase(inside, kAsIs);
  // Behind a sign at its end a brace of what follows would make a mark, too.
  const bool marks = inside.find("_{") != std::string::npos || inside.find("@{") != std::string::npos ||
                     inside.find('`') != std::string::npos || inside.ends_with('_') || inside.ends_with('@');
  return marks ? kAsIs + inside + kAsIs : inside;
}

}  // namespace stiffscope::reports
