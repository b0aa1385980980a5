#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/input/xml_node.h"

// Strict reading of a specification's elements: what is not understood is refused, so that a mistyped effect
// never silently fails to happen. All throw InputError with file, line, attribute and value.

namespace stiffscope::simulation {

/// Refuses attributes and child elements of `node` that are not listed, naming the nearest that is.
void refuseUnknown(const XmlNode& node, const std::vector<std::string>& attributes,
                   const std::vector<std::string>& elements = {});

/// Exactly `count` numbers (any number of them, at least one, for 0), times `unit`.
std::vector<double> numberList(const XmlNode& node, const std::string& attribute, std::size_t count,
                               double unit);

std::optional<double> optionalNumber(const XmlNode& node, const std::string& attribute, double unit);
double numberOr(const XmlNode& node, const std::string& attribute, double unit, double otherwise);
double positive(const XmlNode& node, const std::string& attribute, double unit);  ///< required, > 0
std::optional<double> optionalPositive(const XmlNode& node, const std::string& attribute, double unit);
double nonNegativeOr(const XmlNode& node, const std::string& attribute, double unit, double otherwise);

/// A whole number from `low` to `high`; `otherwise` where absent, required where that is empty.
int integer(const XmlNode& node, const std::string& attribute, int low, int high,
            const std::optional<int>& otherwise = std::nullopt);
std::uint64_t integer64(const XmlNode& node, const std::string& attribute,
                        const std::optional<std::uint64_t>& otherwise = std::nullopt);
bool flag(const XmlNode& node, const std::string& attribute, bool otherwise);  ///< "true" or "false"

Eigen::Vector3d vectorOr(const XmlNode& node, const std::string& attribute, double unit,
                         const Eigen::Vector3d& otherwise);
std::optional<Eigen::Vector3d> optionalDirection(const XmlNode& node,
                                                 const std::string& attribute);  ///< made unit
/// parent_from_child of two attributes: a point in mm and fixed-axis roll, pitch, yaw in deg, absent: zero.
Eigen::Isometry3d placement(const XmlNode& node, const std::string& xyz_mm, const std::string& rpy_deg);

/// The value whose name the attribute has; refuses others, naming the nearest.
template <class Value>
Value choice(const XmlNode& node, const std::string& attribute,
             const std::vector<std::pair<std::string, Value>>& choices);

[[noreturn]] void refuseChoice(const XmlNode& node, const std::string& attribute, const std::string& value,
                               const std::vector<std::string>& names);

template <class Value>
Value choice(const XmlNode& node, const std::string& attribute,
             const std::vector<std::pair<std::string, Value>>& choices) {
  const std::string value = node.requiredAttribute(attribute);
  std::vector<std::string> names;
  for (const auto& [name, meaning] : choices) {
    if (name == value) return meaning;
    names.push_back(name);
  }
  refuseChoice(node, attribute, value, names);
}

}  // namespace stiffscope::simulation
