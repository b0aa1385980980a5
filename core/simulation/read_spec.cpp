#include "core/simulation/read_spec.h"

#include "core/input/read_file.h"
#include "core/input/units.h"
#include "core/robot/read_urdf.h"
#include "core/simulation/read_spec_parts.h"
#include "core/simulation/spec_xml.h"

namespace stiffscope {

namespace {

void readRobot(const XmlNode& root, const std::filesystem::path& folder, SimulationSpec& spec) {
  using namespace simulation;
  const XmlNode node = root.requiredChild("robot");
  refuseUnknown(node, {"urdf", "base_link", "flange_link", "double_encoder", "read_back_resolution_deg"});
  spec.urdf_file = folder / node.requiredName("urdf");
  spec.base_link = node.requiredName("base_link");
  spec.flange_link = node.requiredName("flange_link");
  if (node.has("double_encoder")) {
    spec.double_encoder = choice<DoubleEncoder>(node, "double_encoder",
                                                {{"active", DoubleEncoder::active},
                                                 {"inactive", DoubleEncoder::inactive},
                                                 {"unspecified", DoubleEncoder::unspecified}});
  }
  spec.read_back_resolution = nonNegativeOr(node, "read_back_resolution_deg", kDegree, 0.0);
  spec.nominal = readUrdf(spec.urdf_file, spec.base_link, spec.flange_link);
}

}  // namespace

SimulationSpec readSimulationSpec(const std::filesystem::path& file) {
  return parseSimulationSpec(readTextFile(file, kLargestXml), file);
}

SimulationSpec parseSimulationSpec(std::string_view bytes, const std::filesystem::path& file) {
  using namespace simulation;
  const XmlFile xml(file.string(), bytes);
  const XmlNode root = xml.root();
  if (root.name() != "simulation") root.refuse(root.name(), "", "expected the root element 'simulation'");
  refuseUnknown(root, {"format", "name", "date", "seed", "measurement"},
                {"robot",        "joints",      "base",      "link",         "geometry",   "tool",
                 "tool_plate",   "coupling",    "spring",    "growth",       "creep",      "targets",
                 "tracker",      "station",     "load_cell", "hanging_load", "cable_load", "postures",
                 "circle_sweep", "wrist_sweep", "nests",     "times"});
  integer(root, "format", 1, 1);

  SimulationSpec spec;
  spec.file = file;
  spec.name = root.requiredName("name");
  spec.date = root.requiredName("date");
  spec.seed = integer64(root, "seed");
  spec.measurement = integer64(root, "measurement", 1);
  readRobot(root, file.parent_path(), spec);
  spec.machine = readMachine(root);
  spec.targets = readTargets(root);
  spec.tracker = readTracker(root);
  spec.station = readStation(root);
  spec.load_cell = readLoadCell(root, spec.nominal);
  spec.loading = readLoading(root);
  readPostures(root, spec);
  spec.circle_sweeps = readCircleSweeps(root);
  spec.wrist_sweep = readWristSweep(root, spec.targets.size());
  readNestsAndTimes(root, spec);
  return spec;
}

std::vector<int> rigidJoints(const SimulationSpec& spec) {
  std::vector<int> rigid;
  for (std::size_t j = 0; j < spec.machine.joints.size(); ++j) {
    if (!spec.machine.joints[j].torsion) rigid.push_back(static_cast<int>(j) + 1);
  }
  return rigid;
}

}  // namespace stiffscope
