#include <cmath>

#include "core/io/units.h"
#include "core/simulation/spec_xml.h"

namespace stiffscope::simulation {

namespace {

constexpr double kHour = 3600.0;  ///< s

Vector6d shiftAndTurn(const io::XmlNode& node, const std::string& shift_mm, const std::string& turn_deg, double unit) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  return (Vector6d() << vectorOr(node, shift_mm, io::kMillimetre * unit, zero),
          vectorOr(node, turn_deg, io::kDegree * unit, zero))
      .finished();
}

std::optional<Eigen::Isometry3d> readMoved(const io::XmlNode& station, const char* name, std::optional<double>& at_s) {
  const auto node = station.child(name);
  if (!node) return std::nullopt;
  refuseUnknown(*node, {"xyz_mm", "rpy_deg", "at_s"});
  at_s = optionalNumber(*node, "at_s", 1.0);
  if (!node->has("xyz_mm") && !node->has("rpy_deg")) node->refuse(name, "", "expected xyz_mm or rpy_deg");
  return placement(*node, "xyz_mm", "rpy_deg");
}

}  // namespace

StationSpec readStation(const io::XmlNode& root) {
  StationSpec station;
  const auto node = root.child("station");
  if (!node) return station;
  refuseUnknown(*node, {}, {"drift", "tracker_moved", "robot_moved", "refraction"});
  if (const auto drift = node->child("drift")) {
    refuseUnknown(*drift, {"ramp_mm_per_h", "ramp_deg_per_h", "limit_mm", "limit_deg", "time_constant_s",
                           "walk_mm_per_sqrt_h", "walk_deg_per_sqrt_h", "knot_s", "smooth"});
    station.ramp = shiftAndTurn(*drift, "ramp_mm_per_h", "ramp_deg_per_h", 1.0 / kHour);
    station.limit = shiftAndTurn(*drift, "limit_mm", "limit_deg", 1.0);
    station.limit_time = optionalPositive(*drift, "time_constant_s", 1.0).value_or(station.limit_time);
    station.smooth = flag(*drift, "smooth", false);
    station.walk = shiftAndTurn(*drift, "walk_mm_per_sqrt_h", "walk_deg_per_sqrt_h", 1.0 / std::sqrt(kHour));
    for (const char* name : {"walk_mm_per_sqrt_h", "walk_deg_per_sqrt_h"}) {
      if (drift->has(name) && drift->vector(name).minCoeff() < 0.0) {
        drift->refuse(name, drift->requiredAttribute(name), "expected three numbers not below 0");
      }
    }
    station.knot_s = optionalPositive(*drift, "knot_s", 1.0).value_or(station.knot_s);
    if (station.knot_s < 1.0) drift->refuse("knot_s", drift->requiredAttribute("knot_s"), "expected at least 1");
  }
  station.tracker_moved = readMoved(*node, "tracker_moved", station.tracker_moved_s);
  station.robot_moved = readMoved(*node, "robot_moved", station.robot_moved_s);
  if (const auto refraction = node->child("refraction")) {
    refuseUnknown(*refraction, {"scale_ppm", "scale_ppm_per_h", "step_ppm", "step_at_s", "bending_urad_per_m",
                                "bending_urad_per_m2"});
    station.scale = numberOr(*refraction, "scale_ppm", 1e-6, 0.0);
    station.scale_step = numberOr(*refraction, "step_ppm", 1e-6, 0.0);
    station.scale_step_s = numberOr(*refraction, "step_at_s", 1.0, 0.0);
    station.bending = numberOr(*refraction, "bending_urad_per_m", 1e-6, 0.0);
    station.bending_per_m = numberOr(*refraction, "bending_urad_per_m2", 1e-6, 0.0);
    station.scale_per_second = numberOr(*refraction, "scale_ppm_per_h", 1e-6 / kHour, 0.0);
  }
  return station;
}

TargetMotion readTargetMotion(const io::XmlNode& node) {
  using Kind = TargetMotion::Kind;
  TargetMotion motion;
  motion.kind = choice<Kind>(node, "kind",
                             {{"proportional", Kind::proportional},
                              {"slip", Kind::slip},
                              {"compliant", Kind::compliant},
                              {"reseated", Kind::reseated},
                              {"rattling", Kind::rattling}});
  if (motion.kind == Kind::compliant) {
    refuseUnknown(node, {"kind", "compliance_um_per_kn"});
    motion.compliance = node.number("compliance_um_per_kn") * io::kMicrometre / 1000.0;
    return motion;
  }
  motion.shift = node.vector("shift_um") * io::kMicrometre;
  if (motion.kind == Kind::rattling) {
    refuseUnknown(node, {"kind", "shift_um"});
    return motion;
  }
  if (motion.kind == Kind::reseated) {
    refuseUnknown(node, {"kind", "shift_um", "at_s"});
    motion.from_s = node.number("at_s");
    return motion;
  }
  refuseUnknown(node, {"kind", "shift_um", "at_n"});
  motion.at_force = positive(node, "at_n", 1.0);
  return motion;
}

std::optional<TemperatureCourse> readTemperature(const io::XmlNode& root) {
  const auto node = root.child("temperature");
  if (!node) return std::nullopt;
  refuseUnknown(*node, {"times_s", "celsius"});
  TemperatureCourse course{numberList(*node, "times_s", 0, 1.0), {}};
  course.celsius = numberList(*node, "celsius", course.times_s.size(), 1.0);
  for (std::size_t k = 1; k < course.times_s.size(); ++k) {
    if (!(course.times_s[k] > course.times_s[k - 1])) {
      node->refuse("times_s", node->requiredAttribute("times_s"), "expected rising times");
    }
  }
  return course;
}

std::optional<EarlyLog> readEarlyLog(const io::XmlNode& robot, int joints) {
  const auto node = robot.child("early_log");
  if (!node) return std::nullopt;
  refuseUnknown(*node, {"after_s", "time_constant_s"});
  const double after = nonNegativeOr(*node, "after_s", 1.0, 0.0);
  const EarlyLog log(after, jointNumbers(*node, "time_constant_s", joints, 1.0));
  if (!(log.time_constants.minCoeff() > 0.0)) {
    node->refuse("time_constant_s", node->requiredAttribute("time_constant_s"),
                 "expected " + (joints == 6 ? "six" : std::to_string(joints)) + " numbers above 0");
  }
  return log;
}

}  // namespace stiffscope::simulation
