#include "core/interchange/day_description.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

namespace stiffscope::interchange {

namespace {

const std::vector<std::string>& patternFields() {
  static const std::vector<std::string> fields{"target", "pose", "step", "repeat", "axis", "index", "nest", "*"};
  return fields;
}

// A name's part never holds what separates parts.
constexpr char kBetweenParts = ':';
const std::string kPartsApart = "::";

}  // namespace

NamePattern::NamePattern(const io::XmlNode& node, const std::string& attribute, const std::string& pattern) {
  constexpr std::size_t kLongest = 200;
  if (pattern.empty() || pattern.size() > kLongest)
    node.refuse(attribute, pattern, "expected a pattern of 1 to 200 bytes");
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] == '}') node.refuse(attribute, pattern, "expected '{' before '}'");
    if (pattern.compare(i, 2, "::") == 0) ++parts_;
    if (pattern[i] != '{') {
      if (pieces_.empty() || pieces_.back().is_field) pieces_.emplace_back();
      pieces_.back().text += pattern[i];
      continue;
    }
    const std::size_t close = pattern.find('}', i);
    if (close == std::string::npos) node.refuse(attribute, pattern, "expected '}' behind '{'");
    const std::string field = pattern.substr(i + 1, close - i - 1);
    const auto& known = patternFields();
    if (std::find(known.begin(), known.end(), field) == known.end())
      node.refuse(attribute, "{" + field + "}",
                  fmt::format("expected {{{}}}{}", fmt::join(known, "}, {"), io::nearestNameHint(field, known)));
    if (field != "*" && has(field)) node.refuse(attribute, "{" + field + "}", "expected this field once");
    pieces_.push_back({true, field == "*" ? std::string() : field});
    i = close;
  }
  constexpr std::size_t kMostParts = 3;
  if (parts_ > kMostParts) node.refuse(attribute, pattern, "expected at most collection::group::name");
}

bool NamePattern::has(const std::string& field) const {
  return std::any_of(pieces_.begin(), pieces_.end(),
                     [&](const Piece& piece) { return piece.is_field && piece.text == field; });
}

// From the end: which pieces can make up the rest of the name from which letter on. Then each field takes the fewest
// letters that leave a rest that its followers can make up. Trying out all lengths of all fields instead takes longer
// than anyone waits: of six fields in a name of a hundred letters there are a billion ways.
std::optional<std::map<std::string, std::string>> NamePattern::fieldsIn(const std::string& name) const {
  const std::size_t letters = name.size(), width = letters + 1;
  std::vector<bool> fits((pieces_.size() + 1) * width, false);
  const auto rest = [&](std::size_t piece, std::size_t from) { return fits[piece * width + from]; };
  fits[pieces_.size() * width + letters] = true;
  for (std::size_t p = pieces_.size(); p-- > 0;) {
    const Piece& piece = pieces_[p];
    for (std::size_t from = letters; from-- > 0;) {
      fits[p * width + from] =
          piece.is_field
              ? name[from] != kBetweenParts && (rest(p + 1, from + 1) || rest(p, from + 1))
              : name.compare(from, piece.text.size(), piece.text) == 0 && rest(p + 1, from + piece.text.size());
    }
  }
  if (!rest(0, 0)) return std::nullopt;
  std::map<std::string, std::string> found;
  std::size_t from = 0;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const std::size_t start = from;
    from += pieces_[p].is_field ? 1 : pieces_[p].text.size();
    if (!pieces_[p].is_field) continue;
    while (!rest(p + 1, from)) ++from;
    if (!pieces_[p].text.empty()) found[pieces_[p].text] = name.substr(start, from - start);
  }
  return found;
}

std::optional<std::map<std::string, std::string>> NamePattern::fieldsIn(const PointReading& point) const {
  if (parts_ == 1) return fieldsIn(point.name);
  std::string name = point.group() + kPartsApart + point.name;
  if (parts_ > 2) name = point.collection() + kPartsApart + name;
  // From the right, as one cell may hold several parts: "A::P1::T1".
  std::size_t from = name.size();
  for (std::size_t part = 0; part < parts_; ++part) {
    const std::size_t mark =
        from < kPartsApart.size() ? std::string::npos : name.rfind(kPartsApart, from - kPartsApart.size());
    if (mark == std::string::npos) return fieldsIn(name);
    from = mark;
  }
  return fieldsIn(name.substr(from + kPartsApart.size()));
}

}  // namespace stiffscope::interchange
