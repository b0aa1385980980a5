#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/input_error.h"

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace stiffscope::io {

/// The line of a text, counted from 1, that the byte at `at` is in.
inline std::size_t lineOf(std::string_view bytes, std::size_t at) {
  const auto before = bytes.substr(0, at);
  return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
}

/// An element of an XML file that was read. Cheap to copy; valid while its XmlFile lives. Everything that is
/// asked for and not as it should be throws InputError with file, line, attribute and value.
class XmlNode {
 public:
  XmlNode(const std::string& file, const tinyxml2::XMLElement& element) : file_(&file), element_(&element) {}

  const std::string& file() const { return *file_; }
  std::string name() const;
  std::size_t line() const;
  std::string text() const;  ///< of the element itself, blanks at both ends cut off

  std::vector<XmlNode> children() const;
  std::vector<XmlNode> children(const std::string& name) const;
  std::optional<XmlNode> child(const std::string& name) const;  ///< refuses a second one
  XmlNode requiredChild(const std::string& name) const;

  std::vector<std::string> attributeNames() const;
  bool has(const std::string& attribute) const;
  std::optional<std::string> attribute(const std::string& name) const;
  std::string requiredAttribute(const std::string& name) const;
  std::string requiredName(const std::string& attribute) const;  ///< as above, and not empty
  double number(const std::string& attribute) const;             ///< finite
  Eigen::Vector3d vector(const std::string& attribute) const;    ///< exactly three finite numbers

  /// Throws the InputError; `column` is an attribute or element name.
  [[noreturn]] void refuse(const std::string& column, const std::string& value, const std::string& expectation) const;
  /// A one-line warning about this element.
  std::string warning(const std::string& column, const std::string& value, const std::string& finding) const;

 private:
  const std::string* file_;
  const tinyxml2::XMLElement* element_;
};

/// An XML file, parsed from memory. External and declared entities are never expanded.
class XmlFile {
 public:
  /// `file` is the name for messages. Throws InputError where `bytes` are not well-formed XML, have a
  /// DOCTYPE, more than one root, an attribute twice in one element, or an entity that is not one of the five of XML.
  XmlFile(std::string file, std::string_view bytes);
  ~XmlFile();
  XmlFile(const XmlFile&) = delete;
  XmlFile& operator=(const XmlFile&) = delete;

  XmlNode root() const;

 private:
  std::string file_;
  std::unique_ptr<tinyxml2::XMLDocument> document_;
};

/// Warnings for attributes and child elements of `node` that are not among the known ones; each names the
/// nearest known name. Names of namespaces (xmlns, xsi:...) pass.
void warnOfUnknown(const XmlNode& node, const std::vector<std::string>& attributes,
                   const std::vector<std::string>& elements, std::vector<std::string>& warnings);

}  // namespace stiffscope::io
