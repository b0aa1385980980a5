#include <cmath>

#include "core/input/units.h"
#include "core/simulation/read_spec_parts.h"
#include "core/simulation/spec_xml.h"

namespace stiffscope::simulation {

namespace {

constexpr double kHour = 3600.0;  ///< s

Vector6d shiftAndTurn(const XmlNode& node, const std::string& shift_mm, const std::string& turn_deg,
                      double unit) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  return (Vector6d() << vectorOr(node, shift_mm, kMillimetre * unit, zero),
          vectorOr(node, turn_deg, kDegree * unit, zero))
      .finished();
}

std::optional<Eigen::Isometry3d> readMoved(const XmlNode& station, const char* name) {
  const auto node = station.child(name);
  if (!node) return std::nullopt;
  refuseUnknown(*node, {"xyz_mm", "rpy_deg"});
  if (!node->has("xyz_mm") && !node->has("rpy_deg")) node->refuse(name, "", "expected xyz_mm or rpy_deg");
  return placement(*node, "xyz_mm", "rpy_deg");
}

}  // namespace

StationSpec readStation(const XmlNode& root) {
  StationSpec station;
  const auto node = root.child("station");
  if (!node) return station;
  refuseUnknown(*node, {}, {"drift", "tracker_moved", "robot_moved", "refraction"});
  if (const auto drift = node->child("drift")) {
    refuseUnknown(*drift,
                  {"ramp_mm_per_h", "ramp_deg_per_h", "walk_mm_per_sqrt_h", "walk_deg_per_sqrt_h", "knot_s"});
    station.ramp = shiftAndTurn(*drift, "ramp_mm_per_h", "ramp_deg_per_h", 1.0 / kHour);
    station.walk = shiftAndTurn(*drift, "walk_mm_per_sqrt_h", "walk_deg_per_sqrt_h", 1.0 / std::sqrt(kHour));
    for (const char* name : {"walk_mm_per_sqrt_h", "walk_deg_per_sqrt_h"}) {
      if (drift->has(name) && drift->vector(name).minCoeff() < 0.0) {
        drift->refuse(name, drift->requiredAttribute(name), "expected three numbers not below 0");
      }
    }
    station.knot_s = optionalPositive(*drift, "knot_s", 1.0).value_or(station.knot_s);
    if (station.knot_s < 1.0)
      drift->refuse("knot_s", drift->requiredAttribute("knot_s"), "expected at least 1");
  }
  station.tracker_moved = readMoved(*node, "tracker_moved");
  station.robot_moved = readMoved(*node, "robot_moved");
  if (const auto refraction = node->child("refraction")) {
    refuseUnknown(*refraction, {"scale_ppm", "scale_ppm_per_h"});
    station.scale = numberOr(*refraction, "scale_ppm", 1e-6, 0.0);
    station.scale_per_second = numberOr(*refraction, "scale_ppm_per_h", 1e-6 / kHour, 0.0);
  }
  return station;
}

TargetMotion readTargetMotion(const XmlNode& node) {
  using Kind = TargetMotion::Kind;
  TargetMotion motion;
  motion.kind = choice<Kind>(
      node, "kind",
      {{"proportional", Kind::proportional}, {"slip", Kind::slip}, {"compliant", Kind::compliant}});
  if (motion.kind == Kind::compliant) {
    refuseUnknown(node, {"kind", "compliance_um_per_kn"});
    motion.compliance = node.number("compliance_um_per_kn") * kMicrometre / 1000.0;
    return motion;
  }
  refuseUnknown(node, {"kind", "shift_um", "at_n"});
  motion.shift = node.vector("shift_um") * kMicrometre;
  motion.at_force = positive(node, "at_n", 1.0);
  return motion;
}

void readSwing(const XmlNode& load, LoadingSpec& loading) {
  const auto node = load.child("swing");
  if (!node) return;
  refuseUnknown(*node, {"angle_deg", "period_s"});
  loading.swing = node->number("angle_deg") * kDegree;
  loading.swing_period = positive(*node, "period_s", 1.0);
}

}  // namespace stiffscope::simulation
