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

std::string escaped(char c) {
  const bool plain =
      (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || (c & 0x80) != 0;
  return plain ? std::string(1, c) : std::string("\\") + c;
}

}  // namespace

NamePattern::NamePattern(const io::XmlNode& node, const std::string& attribute, const std::string& pattern) {
  constexpr std::size_t kLongest = 200;
  if (pattern.empty() || pattern.size() > kLongest)
    node.refuse(attribute, pattern, "expected a pattern of 1 to 200 bytes");
  std::string expression;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] == '}') node.refuse(attribute, pattern, "expected '{' before '}'");
    if (pattern.compare(i, 2, "::") == 0) ++parts_;
    if (pattern[i] != '{') {
      expression += escaped(pattern[i]);
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
    fields_.push_back(field == "*" ? std::string() : field);
    // A name's part never holds what separates parts.
    expression += "([^:]+?)";
    i = close;
  }
  constexpr std::size_t kMostParts = 3;
  if (parts_ > kMostParts) node.refuse(attribute, pattern, "expected at most collection::group::name");
  regex_ = std::regex(expression);
}

bool NamePattern::has(const std::string& field) const {
  return std::find(fields_.begin(), fields_.end(), field) != fields_.end();
}

std::optional<std::map<std::string, std::string>> NamePattern::fieldsIn(const std::string& name) const {
  std::smatch match;
  if (!std::regex_match(name, match, regex_)) return std::nullopt;
  std::map<std::string, std::string> found;
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    if (!fields_[i].empty()) found[fields_[i]] = match[i + 1].str();
  }
  return found;
}

std::optional<std::map<std::string, std::string>> NamePattern::fieldsIn(const PointReading& point) const {
  std::string name = point.name;
  if (parts_ > 1) name = point.group() + "::" + name;
  if (parts_ > 2) name = point.collection() + "::" + name;
  return fieldsIn(name);
}

}  // namespace stiffscope::interchange
