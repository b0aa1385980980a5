#pragma once

#include <map>
#include <optional>
#include <regex>
#include <string>

#include "core/interchange/point_reading.h"
#include "core/io/xml.h"

namespace stiffscope::interchange {

/// How names of points or taught targets tell what they are: `P{target}_{pose}_{step}`. A field stands for any text, as
/// short as the rest allows; {*} is not kept. Parts between `::` are matched with the last of collection, group and
/// name.
class NamePattern {
 public:
  /// Fields: target, pose, step, repeat, axis, index, nest, *. Throws InputError, naming the attribute of `node`, for
  /// another field, a bracket that is not closed, or a field that stands twice.
  NamePattern(const io::XmlNode& node, const std::string& attribute, const std::string& pattern);

  bool has(const std::string& field) const;

  /// The fields in a name; nullopt where it is not of the pattern.
  std::optional<std::map<std::string, std::string>> fieldsIn(const std::string& name) const;
  std::optional<std::map<std::string, std::string>> fieldsIn(const PointReading& point) const;

 private:
  std::vector<std::string> fields_;  ///< in their order; empty for {*}
  std::size_t parts_ = 1;
  std::regex regex_;
};

}  // namespace stiffscope::interchange
