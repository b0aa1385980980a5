#include "core/input/xml_node.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/input/nearest_name.h"
#include "core/input/numbers.h"

namespace stiffscope {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> found;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
    found.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return found;
}

// Names what was probably meant to be `wanted`. Two edits at most: a longer way mostly leads to another name
// that is right as it is (range_fixed_um, angle_fixed_um).
std::string misspelling(const std::string& wanted, const std::vector<std::string>& present) {
  constexpr std::size_t kMostEdits = 2;
  const std::string near = nearestName(wanted, present);
  if (near.empty() || editDistance(wanted, near) > kMostEdits) return {};
  return fmt::format("; there is '{}' (did you mean '{}'?)", near, wanted);
}

}  // namespace

std::string XmlNode::name() const { return element_->Name(); }

std::size_t XmlNode::line() const { return static_cast<std::size_t>(element_->GetLineNum()); }

std::string XmlNode::text() const {
  const char* text = element_->GetText();
  return text == nullptr ? std::string() : std::string(trimmed(text));
}

std::vector<XmlNode> XmlNode::children() const {
  std::vector<XmlNode> found;
  for (auto* e = element_->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    found.emplace_back(*file_, *e);
  }
  return found;
}

std::vector<XmlNode> XmlNode::children(const std::string& name) const {
  std::vector<XmlNode> found;
  for (auto* e = element_->FirstChildElement(name.c_str()); e != nullptr;
       e = e->NextSiblingElement(name.c_str())) {
    found.emplace_back(*file_, *e);
  }
  return found;
}

std::optional<XmlNode> XmlNode::child(const std::string& name) const {
  const std::vector<XmlNode> found = children(name);
  if (found.empty()) return std::nullopt;
  if (found.size() > 1) {
    found[1].refuse(name, "",
                    fmt::format("expected this element once; the first is in line {}", found[0].line()));
  }
  return found.front();
}

XmlNode XmlNode::requiredChild(const std::string& wanted) const {
  if (const auto found = child(wanted)) return *found;
  std::vector<std::string> present;
  for (const XmlNode& other : children()) present.push_back(other.name());
  refuse(wanted, "", fmt::format("expected this element in <{}>{}", name(), misspelling(wanted, present)));
}

std::vector<std::string> XmlNode::attributeNames() const {
  std::vector<std::string> names;
  for (auto* a = element_->FirstAttribute(); a != nullptr; a = a->Next()) names.emplace_back(a->Name());
  return names;
}

bool XmlNode::has(const std::string& attribute) const {
  return element_->FindAttribute(attribute.c_str()) != nullptr;
}

std::optional<std::string> XmlNode::attribute(const std::string& name) const {
  const char* value = element_->Attribute(name.c_str());
  return value == nullptr ? std::nullopt : std::optional<std::string>(value);
}

std::string XmlNode::requiredAttribute(const std::string& wanted) const {
  if (const auto value = attribute(wanted)) return *value;
  refuse(wanted, "",
         fmt::format("expected this attribute of <{}>{}", name(), misspelling(wanted, attributeNames())));
}

std::string XmlNode::requiredName(const std::string& wanted) const {
  const std::string value = requiredAttribute(wanted);
  if (trimmed(value).empty()) refuse(wanted, value, "expected a name that is not empty");
  return value;
}

double XmlNode::number(const std::string& wanted) const {
  const std::string value = requiredAttribute(wanted);
  const ParsedNumber parsed = parseNumber(trimmed(value));
  if (!parsed.expectation.empty()) refuse(wanted, value, parsed.expectation);
  return parsed.value;
}

Eigen::Vector3d XmlNode::vector(const std::string& wanted) const {
  const std::string value = requiredAttribute(wanted);
  const std::vector<std::string_view> parts = words(value);
  Eigen::Vector3d numbers = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const ParsedNumber parsed = parseNumber(parts[i]);
    if (!parsed.expectation.empty()) {
      refuse(wanted, value, fmt::format("{} (three, separated by blanks)", parsed.expectation));
    }
    if (i < 3) numbers[static_cast<Eigen::Index>(i)] = parsed.value;
  }
  if (parts.size() != 3) {
    refuse(wanted, value, fmt::format("expected three numbers; found {}", parts.size()));
  }
  return numbers;
}

void XmlNode::refuse(const std::string& column, const std::string& value,
                     const std::string& expectation) const {
  throw InputError({*file_, line(), column}, value, expectation);
}

std::string XmlNode::warning(const std::string& column, const std::string& value,
                             const std::string& finding) const {
  return inputMessage({*file_, line(), column}, value, finding);
}

void warnOfUnknown(const XmlNode& node, const std::vector<std::string>& attributes,
                   const std::vector<std::string>& elements, std::vector<std::string>& warnings) {
  const auto unknown = [](const std::string& name, const std::vector<std::string>& known) {
    const bool of_namespace =
        name.starts_with("xmlns") || name.starts_with("xsi:") || name.starts_with("xml:");
    return !of_namespace && std::find(known.begin(), known.end(), name) == known.end();
  };
  for (const std::string& name : node.attributeNames()) {
    if (!unknown(name, attributes)) continue;
    warnings.push_back(
        node.warning(name, "", "unknown attribute, ignored" + nearestNameHint(name, attributes)));
  }
  for (const XmlNode& child : node.children()) {
    if (!unknown(child.name(), elements)) continue;
    warnings.push_back(child.warning(child.name(), "",
                                     "unknown element, ignored" + nearestNameHint(child.name(), elements)));
  }
}

}  // namespace stiffscope
