#include "core/io/xml.h"

#include <fmt/format.h>
#include <tinyxml2.h>
#include <utility>

#include "core/io/input_error.h"
#include "core/io/numbers.h"

namespace stiffscope::io {

namespace {

// A DOCTYPE may only stand before the root. It is looked for in the bytes, because one that declares entities
// is mostly not even well-formed for tinyxml2, and the reason should be named.
bool hasDoctype(std::string_view bytes) {
  std::size_t at = bytes.find('<');
  while (at != std::string_view::npos) {
    const std::string_view rest = bytes.substr(at);
    if (rest.starts_with("<!DOCTYPE")) return true;
    const std::string_view closing = rest.starts_with("<!--") ? "-->" : rest.starts_with("<?") ? "?>" : "";
    if (closing.empty()) return false;
    const std::size_t end = bytes.find(closing, at);
    at = end == std::string_view::npos ? end : bytes.find('<', end);
  }
  return false;
}

// Text that XML does not look into, by what opens and what closes it.
constexpr std::pair<std::string_view, std::string_view> kVerbatim[] = {
    {"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}};

// Place behind the comment, CDATA section or instruction that starts at `at`; `at` where none does.
std::size_t behindVerbatim(std::string_view bytes, std::size_t at) {
  for (const auto& [opening, closing] : kVerbatim) {
    if (!bytes.substr(at).starts_with(opening)) continue;
    const std::size_t end = bytes.find(closing, at + opening.size());
    return end == std::string_view::npos ? bytes.size() : end + closing.size();
  }
  return at;
}

bool isKnownReference(std::string_view name) {
  if (name.starts_with("#x"))
    return name.size() > 2 && name.find_first_not_of("0123456789abcdefABCDEF", 2) == name.npos;
  if (name.starts_with("#")) return name.size() > 1 && name.find_first_not_of("0123456789", 1) == name.npos;
  return name == "amp" || name == "lt" || name == "gt" || name == "quot" || name == "apos";
}

// XML knows no other '&' without a DOCTYPE, and tinyxml2 mixes up the letters behind one that follows a known
// reference.
void refuseOtherReferences(const std::string& file, std::string_view bytes) {
  constexpr std::size_t kLongestReference = 12;
  for (std::size_t at = bytes.find_first_of("<&"); at < bytes.size(); at = bytes.find_first_of("<&", at)) {
    const std::size_t behind = behindVerbatim(bytes, at);
    if (behind > at) {
      at = behind;
      continue;
    }
    // No further than a reference is long: the rest of the file may have no semicolon.
    const std::string_view window = bytes.substr(at + 1, kLongestReference);
    const std::string_view name = window.substr(0, window.find(';'));
    if (bytes[at++] == '<' || (name.size() < window.size() && isKnownReference(name))) continue;
    throw InputError({file, lineOf(bytes, at), ""}, "&" + std::string(name.substr(0, name.find_first_of(" <\"\n"))),
                     "expected &amp; for an ampersand; XML without a document type has no entities of its own");
  }
}

// tinyxml2 compares every attribute of an element with all before it: a hundred thousand of them would take half a
// minute.
void refuseManyAttributes(const std::string& file, std::string_view bytes) {
  constexpr int kMost = 1000;
  for (std::size_t at = bytes.find('<'); at < bytes.size(); at = bytes.find('<', at)) {
    const std::size_t behind = behindVerbatim(bytes, at);
    const std::size_t element = at++;
    if (behind > element) {
      at = behind;
      continue;
    }
    int attributes = 0;
    for (at = bytes.find_first_of("\"'>", at); at < bytes.size() && bytes[at] != '>';
         at = bytes.find_first_of("\"'>", at)) {
      at = bytes.find(bytes[at], at + 1);  // the end of the value
      if (++attributes > kMost) {
        throw InputError({file, lineOf(bytes, element), ""}, "",
                         fmt::format("expected an element of at most {} attributes", kMost));
      }
      if (at != bytes.npos) ++at;
    }
  }
}

std::string whyNotWellFormed(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "expected well-formed XML: an element is not closed, or another one is";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "expected well-formed XML: an attribute needs a value in quotes, and to be there once";
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "expected an XML element; there is none";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return "expected elements nested less deeply";
    default: {
      std::string name = document.ErrorName();
      if (name.starts_with("XML_ERROR_")) name = name.substr(10);
      return fmt::format("expected well-formed XML: {}", name);
    }
  }
}

}  // namespace

XmlFile::XmlFile(std::string file, std::string_view bytes)
    : file_(std::move(file)), document_(new tinyxml2::XMLDocument) {
  if (hasDoctype(bytes)) {
    throw InputError({file_, 0, ""}, "DOCTYPE", "expected XML without a document type or entities");
  }
  refuseManyAttributes(file_, bytes);
  if (document_->Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS) {
    throw InputError({file_, static_cast<std::size_t>(document_->ErrorLineNum()), ""}, "",
                     whyNotWellFormed(*document_));
  }
  refuseOtherReferences(file_, bytes);
  const tinyxml2::XMLElement* root_element = document_->RootElement();
  if (root_element == nullptr) throw InputError({file_, 0, ""}, "", "expected an XML element; there is none");
  if (const auto* second = root_element->NextSiblingElement()) {
    XmlNode(file_, *second).refuse(second->Name(), "", "expected the end of the file after the root element");
  }
}

XmlFile::~XmlFile() = default;

XmlNode XmlFile::root() const { return {file_, *document_->RootElement()}; }

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
  for (auto* e = element_->FirstChildElement(name.c_str()); e != nullptr; e = e->NextSiblingElement(name.c_str())) {
    found.emplace_back(*file_, *e);
  }
  return found;
}

std::optional<XmlNode> XmlNode::child(const std::string& name) const {
  const std::vector<XmlNode> found = children(name);
  if (found.empty()) return std::nullopt;
  if (found.size() > 1) {
    found[1].refuse(name, "", fmt::format("expected this element once; the first is in line {}", found[0].line()));
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

bool XmlNode::has(const std::string& attribute) const { return element_->FindAttribute(attribute.c_str()) != nullptr; }

std::optional<std::string> XmlNode::attribute(const std::string& name) const {
  const char* value = element_->Attribute(name.c_str());
  return value == nullptr ? std::nullopt : std::optional<std::string>(value);
}

std::string XmlNode::requiredAttribute(const std::string& wanted) const {
  if (const auto value = attribute(wanted)) return *value;
  refuse(wanted, "", fmt::format("expected this attribute of <{}>{}", name(), misspelling(wanted, attributeNames())));
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

void XmlNode::refuse(const std::string& column, const std::string& value, const std::string& expectation) const {
  throw InputError({*file_, line(), column}, value, expectation);
}

std::string XmlNode::warning(const std::string& column, const std::string& value, const std::string& finding) const {
  return inputMessage({*file_, line(), column}, value, finding);
}

void warnOfUnknown(const XmlNode& node, const std::vector<std::string>& attributes,
                   const std::vector<std::string>& elements, std::vector<std::string>& warnings) {
  const auto unknown = [](const std::string& name, const std::vector<std::string>& known) {
    const bool of_namespace = name.starts_with("xmlns") || name.starts_with("xsi:") || name.starts_with("xml:");
    return !of_namespace && std::find(known.begin(), known.end(), name) == known.end();
  };
  for (const std::string& name : node.attributeNames()) {
    if (!unknown(name, attributes)) continue;
    warnings.push_back(node.warning(name, "", "unknown attribute, ignored" + nearestNameHint(name, attributes)));
  }
  for (const XmlNode& child : node.children()) {
    if (!unknown(child.name(), elements)) continue;
    warnings.push_back(
        child.warning(child.name(), "", "unknown element, ignored" + nearestNameHint(child.name(), elements)));
  }
}

}  // namespace stiffscope::io
