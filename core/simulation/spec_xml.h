#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/io/xml.h"
#include "core/simulation/spec.h"

// The sections of a specification; read_spec.h has the format. `root` is the `simulation` element.

// Strict reading of a specification's elements: what is not understood is refused, so that a mistyped effect
// never silently fails to happen. All throw InputError with file, line, attribute and value.

namespace stiffscope::simulation {

MachineSpec readMachine(const io::XmlNode& root, int joints);
JointStiffness readJoint(const io::XmlNode& node, int index, int joints);  ///< from 0, of so many
void readSprings(const io::XmlNode& root, MachineSpec& machine);           ///< after the joints
void readBaseContacts(const io::XmlNode& base, MachineSpec& machine);
ToolPlate readToolPlate(const io::XmlNode& node);
LoosePlate readLoosePlate(const io::XmlNode& node);
void readSlowChanges(const io::XmlNode& root, MachineSpec& machine);  ///< after the joints

std::vector<TrueTarget> readTargets(const io::XmlNode& root);
TargetMotion readTargetMotion(const io::XmlNode& node);
TrackerSpec readTracker(const io::XmlNode& root);
StationSpec readStation(const io::XmlNode& root);
std::optional<TemperatureCourse> readTemperature(const io::XmlNode& root);
std::optional<EarlyLog> readEarlyLog(const io::XmlNode& robot, int joints);
std::optional<LoadCellSpec> readLoadCell(const io::XmlNode& root, const robot::Robot& robot);

std::optional<LoadingSpec> readLoading(const io::XmlNode& root);
void readSwing(const io::XmlNode& load, LoadingSpec& loading);
void readPostures(const io::XmlNode& root, SimulationSpec& spec);  ///< after nominal and loading

std::vector<CircleSweepSpec> readCircleSweeps(const io::XmlNode& root, int joints);
std::optional<WristSweepSpec> readWristSweep(const io::XmlNode& root, int joints, std::size_t targets);
RailSpec readRail(const io::XmlNode& root, const robot::Robot& robot);
void readNestsAndTimes(const io::XmlNode& root, SimulationSpec& spec);

/// Refuses attributes and child elements of `node` that are not listed, naming the nearest that is.
void refuseUnknown(const io::XmlNode& node, const std::vector<std::string>& attributes,
                   const std::vector<std::string>& elements = {});

/// Exactly `count` numbers (any number of them, at least one, for 0), times `unit`.
std::vector<double> numberList(const io::XmlNode& node, const std::string& attribute, std::size_t count, double unit);
/// The same of up to kMostJoints.
JointVector jointNumbers(const io::XmlNode& node, const std::string& attribute, int count, double unit);

std::optional<double> optionalNumber(const io::XmlNode& node, const std::string& attribute, double unit);
double numberOr(const io::XmlNode& node, const std::string& attribute, double unit, double otherwise);
double positive(const io::XmlNode& node, const std::string& attribute, double unit);  ///< required, > 0
std::optional<double> optionalPositive(const io::XmlNode& node, const std::string& attribute, double unit);
double nonNegativeOr(const io::XmlNode& node, const std::string& attribute, double unit, double otherwise);

/// A whole number from `low` to `high`; `otherwise` where absent, required where that is empty.
int integer(const io::XmlNode& node, const std::string& attribute, int low, int high,
            const std::optional<int>& otherwise = std::nullopt);
std::uint64_t integer64(const io::XmlNode& node, const std::string& attribute,
                        const std::optional<std::uint64_t>& otherwise = std::nullopt);
bool flag(const io::XmlNode& node, const std::string& attribute, bool otherwise);  ///< "true" or "false"

Eigen::Vector3d vectorOr(const io::XmlNode& node, const std::string& attribute, double unit,
                         const Eigen::Vector3d& otherwise);
std::optional<Eigen::Vector3d> optionalDirection(const io::XmlNode& node,
                                                 const std::string& attribute);  ///< made unit
/// parent_from_child of two attributes: a point in mm and fixed-axis roll, pitch, yaw in deg, absent: zero.
Eigen::Isometry3d placement(const io::XmlNode& node, const std::string& xyz_mm, const std::string& rpy_deg);

/// The value whose name the attribute has; refuses others, naming the nearest.
template <class Value>
Value choice(const io::XmlNode& node, const std::string& attribute,
             const std::vector<std::pair<std::string, Value>>& choices);

[[noreturn]] void refuseChoice(const io::XmlNode& node, const std::string& attribute, const std::string& value,
                               const std::vector<std::string>& names);

template <class Value>
Value choice(const io::XmlNode& node, const std::string& attribute,
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
