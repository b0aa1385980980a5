#include "core/input/units.h"
#include "core/simulation/read_spec_parts.h"
#include "core/simulation/spec_xml.h"

namespace stiffscope::simulation {

std::vector<CircleSweepSpec> readCircleSweeps(const XmlNode& root) {
  std::vector<CircleSweepSpec> sweeps;
  for (const XmlNode& node : root.children("circle_sweep")) {
    refuseUnknown(node, {"axis", "start_deg", "stop_deg", "count", "others_deg"});
    CircleSweepSpec sweep;
    sweep.axis = integer(node, "axis", 1, 6) - 1;
    for (const CircleSweepSpec& other : sweeps) {
      if (other.axis == sweep.axis) {
        node.refuse("axis", node.requiredAttribute("axis"), "expected one sweep an axis");
      }
    }
    sweep.start = node.number("start_deg") * kDegree;
    sweep.stop = node.number("stop_deg") * kDegree;
    sweep.count = integer(node, "count", 2, 100000);
    if (node.has("others_deg")) {
      const std::vector<double> values = numberList(node, "others_deg", 6, kDegree);
      sweep.others = Eigen::Map<const Vector6d>(values.data());
    }
    sweeps.push_back(sweep);
  }
  return sweeps;
}

std::optional<WristSweepSpec> readWristSweep(const XmlNode& root, std::size_t targets) {
  const std::optional<XmlNode> node = root.child("wrist_sweep");
  if (!node) return std::nullopt;
  refuseUnknown(*node, {"readings", "scheme", "arm_deg", "min_deg", "max_deg"});
  WristSweepSpec sweep;
  const int count = static_cast<int>(targets);
  sweep.readings = integer(*node, "readings", count, 1000000);
  if (node->has("scheme")) {
    sweep.scheme = choice<WristScheme>(
        *node, "scheme",
        {{"one_target", WristScheme::one_target}, {"all_targets", WristScheme::all_targets}});
  }
  if (sweep.scheme == WristScheme::all_targets && sweep.readings % count != 0) {
    node->refuse("readings", node->requiredAttribute("readings"),
                 "expected a multiple of the number of targets for all_targets");
  }
  sweep.arm = vectorOr(*node, "arm_deg", kDegree, Eigen::Vector3d::Zero());
  sweep.low = node->vector("min_deg") * kDegree;
  sweep.high = node->vector("max_deg") * kDegree;
  if ((sweep.high - sweep.low).minCoeff() < 0.0) {
    node->refuse("max_deg", node->requiredAttribute("max_deg"), "expected no angle below that of min_deg");
  }
  return sweep;
}

void readNestsAndTimes(const XmlNode& root, SimulationSpec& spec) {
  if (const auto nests = root.child("nests")) {
    refuseUnknown(*nests, {"interval_s", "after_sweeps"}, {"nest"});
    spec.nests_after_sweeps = flag(*nests, "after_sweeps", false);
    spec.timing.nest_interval_s = optionalPositive(*nests, "interval_s", 1.0).value_or(3600.0);
    for (const XmlNode& node : nests->children("nest")) {
      refuseUnknown(node, {"id", "xyz_mm"});
      const std::string id = node.requiredName("id");
      for (const NestSpec& other : spec.nests) {
        if (other.id == id) node.refuse("id", id, "expected every nest once");
      }
      spec.nests.push_back({id, node.vector("xyz_mm") * kMillimetre});
    }
  }
  if (const auto times = root.child("times")) {
    refuseUnknown(*times, {"reading_s", "move_s", "load_change_s"});
    spec.timing.reading_s = optionalPositive(*times, "reading_s", 1.0).value_or(spec.timing.reading_s);
    spec.timing.move_s = nonNegativeOr(*times, "move_s", 1.0, spec.timing.move_s);
    spec.timing.load_change_s = nonNegativeOr(*times, "load_change_s", 1.0, spec.timing.load_change_s);
  }
}

}  // namespace stiffscope::simulation
