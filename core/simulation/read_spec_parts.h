#pragma once

#include "core/input/xml_node.h"
#include "core/simulation/spec.h"

// The sections of a specification; read_spec.h has the format. `root` is the `simulation` element.

namespace stiffscope::simulation {

MachineSpec readMachine(const XmlNode& root);
JointStiffness readJoint(const XmlNode& node);
void readSprings(const XmlNode& root, MachineSpec& machine);  ///< after the joints
void readBaseContacts(const XmlNode& base, MachineSpec& machine);
ToolPlate readToolPlate(const XmlNode& node);
void readSlowChanges(const XmlNode& root, MachineSpec& machine);

std::vector<TrueTarget> readTargets(const XmlNode& root);
TargetMotion readTargetMotion(const XmlNode& node);
TrackerSpec readTracker(const XmlNode& root);
StationSpec readStation(const XmlNode& root);
std::optional<LoadCellSpec> readLoadCell(const XmlNode& root, const Robot& robot);

std::optional<LoadingSpec> readLoading(const XmlNode& root);
void readSwing(const XmlNode& load, LoadingSpec& loading);
void readPostures(const XmlNode& root, SimulationSpec& spec);  ///< after nominal and loading

std::vector<CircleSweepSpec> readCircleSweeps(const XmlNode& root);
std::optional<WristSweepSpec> readWristSweep(const XmlNode& root, std::size_t targets);
void readNestsAndTimes(const XmlNode& root, SimulationSpec& spec);

}  // namespace stiffscope::simulation
