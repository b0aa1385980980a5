#pragma once

#include "core/input/xml_node.h"
#include "core/simulation/spec.h"

// The sections of a specification; read_spec.h has the format. `root` is the `simulation` element.

namespace stiffscope::simulation {

MachineSpec readMachine(const XmlNode& root);

std::vector<TrueTarget> readTargets(const XmlNode& root);
TrackerSpec readTracker(const XmlNode& root);
std::optional<LoadCellSpec> readLoadCell(const XmlNode& root, const Robot& robot);

std::optional<LoadingSpec> readLoading(const XmlNode& root);
void readPostures(const XmlNode& root, SimulationSpec& spec);  ///< after nominal and loading

std::vector<CircleSweepSpec> readCircleSweeps(const XmlNode& root);
std::optional<WristSweepSpec> readWristSweep(const XmlNode& root, std::size_t targets);
void readNestsAndTimes(const XmlNode& root, SimulationSpec& spec);

}  // namespace stiffscope::simulation
