#include "core/simulation/spec_xml.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <charconv>
#include <sstream>

#include "core/io/input_error.h"
#include "core/io/numbers.h"
#include "core/io/units.h"
#include "core/robot/kinematics.h"

namespace stiffscope::simulation {

namespace {

bool listed(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

double refusedUnless(bool holds, const io::XmlNode& node, const std::string& attribute, double value,
                     const std::string& expectation) {
  if (!holds) node.refuse(attribute, node.attribute(attribute).value_or(""), "expected " + expectation);
  return value;
}

}  // namespace

void refuseUnknown(const io::XmlNode& node, const std::vector<std::string>& attributes,
                   const std::vector<std::string>& elements) {
  for (const std::string& name : node.attributeNames()) {
    if (listed(attributes, name)) continue;
    node.refuse(
        name, node.attribute(name).value_or(""),
        fmt::format("expected an attribute that '{}' has{}", node.name(), io::nearestNameHint(name, attributes)));
  }
  for (const io::XmlNode& child : node.children()) {
    if (listed(elements, child.name())) continue;
    child.refuse(
        child.name(), "",
        fmt::format("expected an element that '{}' has{}", node.name(), io::nearestNameHint(child.name(), elements)));
  }
}

std::vector<double> numberList(const io::XmlNode& node, const std::string& attribute, std::size_t count, double unit) {
  const std::string text = node.requiredAttribute(attribute);
  std::istringstream words(text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    const io::ParsedNumber number = io::parseNumber(word);
    if (!number.expectation.empty()) node.refuse(attribute, word, number.expectation);
    numbers.push_back(number.value * unit);
  }
  if (numbers.empty() || (count > 0 && numbers.size() != count)) {
    node.refuse(attribute, text,
                count > 0 ? fmt::format("expected {} numbers separated by blanks", count)
                          : std::string("expected numbers separated by blanks"));
  }
  return numbers;
}

JointVector jointNumbers(const io::XmlNode& node, const std::string& attribute, int count, double unit) {
  const std::vector<double> values = numberList(node, attribute, static_cast<std::size_t>(count), unit);
  return Eigen::Map<const JointVector>(values.data(), count);
}

std::optional<double> optionalNumber(const io::XmlNode& node, const std::string& attribute, double unit) {
  if (!node.has(attribute)) return std::nullopt;
  return node.number(attribute) * unit;
}

double numberOr(const io::XmlNode& node, const std::string& attribute, double unit, double otherwise) {
  return optionalNumber(node, attribute, unit).value_or(otherwise);
}

double positive(const io::XmlNode& node, const std::string& attribute, double unit) {
  const double value = node.number(attribute);
  return unit * refusedUnless(value > 0.0, node, attribute, value, "a number above 0");
}

std::optional<double> optionalPositive(const io::XmlNode& node, const std::string& attribute, double unit) {
  if (!node.has(attribute)) return std::nullopt;
  return positive(node, attribute, unit);
}

double nonNegativeOr(const io::XmlNode& node, const std::string& attribute, double unit, double otherwise) {
  if (!node.has(attribute)) return otherwise;
  const double value = node.number(attribute);
  return unit * refusedUnless(value >= 0.0, node, attribute, value, "a number not below 0");
}

int integer(const io::XmlNode& node, const std::string& attribute, int low, int high,
            const std::optional<int>& otherwise) {
  if (!node.has(attribute) && otherwise) return *otherwise;
  const std::string text = node.requiredAttribute(attribute);
  const std::optional<int> value = io::parseInteger(text);
  if (!value || *value < low || *value > high) {
    node.refuse(attribute, text, fmt::format("expected a whole number from {} to {}", low, high));
  }
  return *value;
}

std::uint64_t integer64(const io::XmlNode& node, const std::string& attribute,
                        const std::optional<std::uint64_t>& otherwise) {
  if (!node.has(attribute) && otherwise) return *otherwise;
  const std::string text = node.requiredAttribute(attribute);
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    node.refuse(attribute, text, "expected a whole number from 0 to 18446744073709551615");
  }
  return value;
}

bool flag(const io::XmlNode& node, const std::string& attribute, bool otherwise) {
  if (!node.has(attribute)) return otherwise;
  return choice<bool>(node, attribute, {{"true", true}, {"false", false}});
}

Eigen::Vector3d vectorOr(const io::XmlNode& node, const std::string& attribute, double unit,
                         const Eigen::Vector3d& otherwise) {
  if (!node.has(attribute)) return otherwise;
  return node.vector(attribute) * unit;
}

std::optional<Eigen::Vector3d> optionalDirection(const io::XmlNode& node, const std::string& attribute) {
  if (!node.has(attribute)) return std::nullopt;
  const Eigen::Vector3d direction = node.vector(attribute);
  if (!(direction.norm() > 1e-9)) {
    node.refuse(attribute, node.requiredAttribute(attribute), "expected a direction, not three zeros");
  }
  return direction.normalized();
}

Eigen::Isometry3d placement(const io::XmlNode& node, const std::string& xyz_mm, const std::string& rpy_deg) {
  Eigen::Isometry3d parent_from_child = Eigen::Isometry3d::Identity();
  parent_from_child.translation() = vectorOr(node, xyz_mm, io::kMillimetre, Eigen::Vector3d::Zero());
  parent_from_child.linear() = robot::rotationFromRpy(vectorOr(node, rpy_deg, io::kDegree, Eigen::Vector3d::Zero()));
  return parent_from_child;
}

void refuseChoice(const io::XmlNode& node, const std::string& attribute, const std::string& value,
                  const std::vector<std::string>& names) {
  node.refuse(attribute, value,
              fmt::format("expected one of {}{}", fmt::join(names, ", "), io::nearestNameHint(value, names)));
}

}  // namespace stiffscope::simulation
