#include <fmt/format.h>
#include <tinyxml2.h>

#include <utility>

#include "core/input/line_of.h"
#include "core/input/xml_node.h"

namespace stiffscope {

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
  if (name.starts_with("#x")) return name.size() > 2 && name.find_first_not_of("0123456789abcdefABCDEF", 2) == name.npos;
  if (name.starts_with("#")) return name.size() > 1 && name.find_first_not_of("0123456789", 1) == name.npos;
  return name == "amp" || name == "lt" || name == "gt" || name == "quot" || name == "apos";
}

// XML knows no other '&' without a DOCTYPE, and tinyxml2 mixes up the letters behind one that follows a known reference.
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

// tinyxml2 compares every attribute of an element with all before it: a hundred thousand of them would take half a minute.
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
    for (at = bytes.find_first_of("\"'>", at); at < bytes.size() && bytes[at] != '>'; at = bytes.find_first_of("\"'>", at)) {
      at = bytes.find(bytes[at], at + 1);  // the end of the value
      if (++attributes > kMost) {
        throw InputError({file, lineOf(bytes, element), ""}, "", fmt::format("expected an element of at most {} attributes", kMost));
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

}  // namespace stiffscope
