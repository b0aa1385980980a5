#include "core/frames/frames.h"
#include "core/io/units.h"
#include "core/simulation/machine.h"
#include "core/simulation/spec.h"
#include "reports/json/campaign_json.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"

namespace stiffscope::reports {

/// What the true machine has besides joint springs, one entry a mechanism: `effect` is the id of the vocabulary that
/// names it, or a kind outside it. Values are the simulator's own, not what a fit of another equation would give.
Json trueEffectsJson(const simulation::SimulationSpec& spec);

namespace {

std::string jointName(std::size_t joint) { return "joint " + std::to_string(joint + 1); }

/// Null where that is rigid.
Json rate(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }
Json compliance(const std::optional<double>& value) { return value ? number(1.0 / *value) : Json(0.0); }

/// What one joint has. Periodic errors of its angle are in the vocabulary of days without a load alone.
Json effectsOfJoint(const simulation::JointStiffness& joint, bool loaded) {
  Json list = Json::array();
  if (joint.bearing) {
    list.push_back({{"effect", "bearing_tilt"},
                    {"bearing_nm_per_rad", *joint.bearing},
                    {"compliance_rad_per_nm", 1.0 / *joint.bearing}});
  }
  if (joint.cubic != 0.0) list.push_back({{"effect", "joint_hardening"}, {"cubic_nm_per_rad3", joint.cubic}});
  if (joint.stages) {
    list.push_back({{"effect", "joint_hardening"},
                    {"torques_nm", joint.stages->torques},
                    {"stage_stiffness_nm_per_rad", joint.stages->rates}});
  }
  if (joint.backlash) {
    list.push_back(
        {{"effect", "backlash"}, {"width_rad", joint.backlash->width}, {"rest_share", joint.backlash->rest}});
  }
  if (joint.friction) {
    list.push_back({{"effect", "hysteresis"},
                    {"torque_nm", joint.friction->torque},
                    {"friction_stiffness_nm_per_rad", joint.friction->rate},
                    {"sliders", joint.friction->sliders}});
  }
  const auto wave = [&](const char* effect, const char* amplitude, const std::optional<simulation::JointWave>& one) {
    if (!one) return;
    list.push_back(
        {{"effect", effect}, {amplitude, one->amplitude}, {"cycles_per_turn", one->cycles}, {"phase_rad", one->phase}});
  };
  wave("stiffness_ripple", "share", joint.rate_wave);
  wave(loaded ? "eccentric_encoder" : "transmission_error", "amplitude_rad", joint.angle_wave);
  if (joint.ratio)
    list.push_back({{"effect", "ratio_error"}, {"share", joint.ratio->share}, {"of_joint", joint.ratio->of + 1}});
  if (joint.lost_motion) {
    list.push_back(
        {{"effect", "backlash"},
         {"width_rad", joint.lost_motion->width},
         {"friction_nm", joint.lost_motion->friction ? number(*joint.lost_motion->friction) : Json(nullptr)}});
  }
  if (joint.zero_jump) {
    list.push_back(
        {{"effect", "slipped_belt"}, {"angle_rad", joint.zero_jump->angle}, {"from_s", joint.zero_jump->from_s}});
  }
  if (joint.zero_warming) {
    list.push_back({{"effect", "zero_by_temperature"},
                    {"rad_per_k", joint.zero_warming->per_kelvin},
                    {"lag_s", joint.zero_warming->lag}});
  }
  if (joint.softening) {
    list.push_back({{"effect", "warming_drives"},
                    {"share", joint.softening->share},
                    {"time_constant_s", joint.softening->time_constant}});
  }
  if (joint.gear) {
    list.push_back({{"effect", "gear_apart"},
                    {"stiffness_nm_per_rad", joint.gear->stiffness},
                    {"compliance_rad_per_nm", 1.0 / joint.gear->stiffness},
                    {"lost_motion_rad", joint.gear->lost_motion},
                    {"encoder_sigma_rad", joint.gear->encoder_sigma},
                    {"encoder_offset_rad", joint.gear->encoder_offset}});
  }
  return list;
}

Json linkEffect(const simulation::LinkBeam& link, const simulation::SimulationSpec& spec) {
  const auto& axes = spec.nominal.axes_in_base_at_zero;
  const auto at = static_cast<std::size_t>(axes.axisOf(link.joint));
  const Eigen::Vector3d tip =
      at + 1 < axes.size() ? axes[at + 1].point : Eigen::Vector3d(spec.nominal.base_from_flange_at_zero.translation());
  return {{"effect", "link_compliance"},
          {"part", "link " + std::to_string(link.joint + 1)},
          {"length_m", (tip - axes[at].point).norm()},
          {"bending_nm2", rate(link.bending)},
          {"torsion_nm2", rate(link.torsion)},
          {"shear_n", rate(link.shear)},
          {"axial_n", rate(link.axial)}};
}

void addStructure(const simulation::SimulationSpec& spec, Json& list) {
  const simulation::MachineSpec& machine = spec.machine;
  for (const simulation::LinkBeam& link : machine.links) list.push_back(linkEffect(link, spec));
  if (machine.base_rotation || machine.base_translation) {
    Json base{{"effect", "base_compliance"}, {"frame", "base_link"}};
    base["rotation_nm_per_rad"] = machine.base_rotation ? array(*machine.base_rotation) : Json(nullptr);
    base["translation_n_per_m"] = machine.base_translation ? array(*machine.base_translation) : Json(nullptr);
    list.push_back(base);
  }
  if (const auto& beam = spec.rail.beam) {
    list.push_back({{"effect", "rail_bending"},
                    {"supports_m", {beam->from, beam->to}},
                    {"bending_up_nm2", beam->bending_up},
                    {"bending_level_nm2", beam->bending_level},
                    {"torsion_nm2", rate(beam->torsion)}});
  }
  for (const simulation::OneSidedContact& contact : machine.base_contacts) {
    list.push_back({{"effect", "cracked_floor"},
                    {"about", std::string(1, "xyz"[contact.axis])},
                    {"side", contact.positive ? "positive" : "negative"},
                    {"stiffness_nm_per_rad", contact.stiffness},
                    {"gap_rad", contact.gap}});
  }
  if (machine.tool_plate) {
    list.push_back({{"effect", "tool_compliance"},
                    {"frame", "flange"},
                    {"translation_n_per_m", array(machine.tool_plate->translation)},
                    {"rotation_nm_per_rad", array(machine.tool_plate->rotation)}});
  }
  if (const auto& plate = machine.loose_plate) {
    list.push_back({{"effect", "loose_plate"},
                    {"frame", "flange"},
                    {"direction", array(plate->direction)},
                    {"shift_m", array(plate->shift)},
                    {"turn_rad", array(plate->turn)}});
  }
  for (const simulation::SharedSpring& shared : machine.shared_springs) {
    list.push_back(
        {{"effect", "joint_coupling"},
         {"part", "joints " + std::to_string(shared.joints[0] + 1) + " and " + std::to_string(shared.joints[1] + 1)},
         {"spring_rate", shared.rate},
         {"spring_rate_unit", "N/m with arms in m, or Nm/rad with ratios"},
         {"arms", shared.arms}});
  }
  for (const simulation::LinkSpring& spring : machine.link_springs) {
    if (spring.declared) continue;
    // A spring on joint 2 alone is what the vocabulary calls a compensator.
    const bool on_joint_2 = spring.from_body == 1 && spring.to_body == 2;
    list.push_back({{"effect", on_joint_2 ? "gravity_compensator" : "dress_pack"},
                    {"from_body", spring.from_body},
                    {"to_body", spring.to_body},
                    {"from_m", array(spring.from_in_base_at_zero)},
                    {"to_m", array(spring.to_in_base_at_zero)},
                    {"rate_n_per_m", spring.rate},
                    {"tension_n", spring.tension}});
    if (!spring.gas) continue;
    list.back()["gas"] = {{"pressure_pa", spring.gas->pressure},
                          {"area_m2", spring.gas->area},
                          {"volume_m3", spring.gas->volume},
                          {"exponent", spring.gas->exponent},
                          {"acts", spring.gas->pushes ? "push" : "pull"}};
  }
  for (const simulation::ThermalGrowth& growth : machine.growths) {
    list.push_back({{"effect", "thermal_growth"},
                    {"part", "link " + std::to_string(growth.joint + 1)},
                    {"growth_m", growth.growth},
                    {"time_constant_s", growth.time_constant},
                    {"growth_m_per_k", growth.per_kelvin}});
  }
  if (machine.creep) {
    list.push_back(
        {{"effect", "creep"}, {"share", machine.creep->share}, {"time_constant_s", machine.creep->time_constant}});
  }
  if (machine.base_tilt != 0.0 && !machine.base_tilt_declared) {
    list.push_back(
        {{"effect", "base_tilt"}, {"tilt_rad", machine.base_tilt}, {"azimuth_rad", machine.base_tilt_azimuth}});
  }
}

void addLoad(const simulation::SimulationSpec& spec, Json& list) {
  if (spec.loading && spec.loading->swing != 0.0) {
    list.push_back(
        {{"effect", "swinging_load"}, {"swing_rad", spec.loading->swing}, {"period_s", spec.loading->swing_period}});
  }
  if (!spec.load_cell) return;
  const simulation::LoadCellSpec& cell = *spec.load_cell;
  if (!cell.place_error.isZero(0.0))
    list.push_back({{"effect", "load_point_error"}, {"frame", "load cell"}, {"offset_m", array(cell.place_error)}});
  if (!cell.misalignment.isZero(0.0)) {
    list.push_back(
        {{"effect", "load_cell_misalignment"}, {"frame", "load cell"}, {"turn_rad", array(cell.misalignment)}});
  }
  if (!cell.bias.isZero(0.0)) {
    list.push_back({{"effect", "load_cell_bias"},
                    {"frame", "load cell"},
                    {"force_n", array(Eigen::Vector3d(cell.bias.head<3>()))},
                    {"moment_nm", array(Eigen::Vector3d(cell.bias.tail<3>()))}});
  }
  if (!cell.unread_force.isZero(0.0)) {
    list.push_back(
        {{"effect", "load_cell_bias"}, {"frame", "base_link"}, {"unread_force_n", array(cell.unread_force)}});
  }
  if (cell.gain_error != 0.0) list.push_back({{"effect", "load_cell_gain"}, {"gain_error", cell.gain_error}});
}

Json movedJson(const char* what, const Eigen::Isometry3d& moved, const char* frame,
               const std::optional<double>& from_s) {
  const Eigen::AngleAxisd turn(moved.linear());
  return {{"from_s", from_s ? number(*from_s) : Json(nullptr)},
          {"effect", "frame_error"},
          {"part", what},
          {"frame", frame},
          {"shift_m", array(Eigen::Vector3d(moved.translation()))},
          {"turn_rad", array(Eigen::Vector3d(turn.angle() * turn.axis()))}};
}

void addStation(const simulation::SimulationSpec& spec, Json& list) {
  const simulation::StationSpec& station = spec.station;
  if (!station.ramp.isZero(0.0) || !station.walk.isZero(0.0) || !station.limit.isZero(0.0)) {
    list.push_back({{"effect", "tracker_drift"},
                    {"frame", "tracker"},
                    {"ramp_m_per_s", array(Eigen::Vector3d(station.ramp.head<3>()))},
                    {"ramp_rad_per_s", array(Eigen::Vector3d(station.ramp.tail<3>()))},
                    {"limit_m", array(Eigen::Vector3d(station.limit.head<3>()))},
                    {"limit_rad", array(Eigen::Vector3d(station.limit.tail<3>()))},
                    {"limit_time_constant_s", station.limit_time},
                    {"walk_m_per_sqrt_s", array(Eigen::Vector3d(station.walk.head<3>()))},
                    {"walk_rad_per_sqrt_s", array(Eigen::Vector3d(station.walk.tail<3>()))}});
  }
  if (station.tracker_moved)
    list.push_back(movedJson("tracker", *station.tracker_moved, "tracker", station.tracker_moved_s));
  if (station.robot_moved) list.push_back(movedJson("robot", *station.robot_moved, "base_link", station.robot_moved_s));
  if (station.scale != 0.0 || station.scale_per_second != 0.0 || station.scale_step != 0.0) {
    list.push_back({{"effect", spec.loading ? "refraction" : "scale_error"},
                    {"scale", station.scale},
                    {"scale_per_s", station.scale_per_second},
                    {"scale_step", station.scale_step},
                    {"step_from_s", station.scale_step_s}});
  }
  if (station.bending != 0.0 || station.bending_per_m != 0.0) {
    list.push_back(
        {{"effect", "layered_air"}, {"bending_per_m", station.bending}, {"bending_per_m2", station.bending_per_m}});
  }
  if (spec.early_log) {
    list.push_back({{"effect", "read_back_error"},
                    {"after_s", spec.early_log->after},
                    {"time_constants_s", array(spec.early_log->time_constants)}});
  }
  for (const simulation::TrueTarget& target : spec.targets) {
    if (!target.motion) continue;
    const simulation::TargetMotion& motion = *target.motion;
    Json one{{"effect", "target_motion"}, {"part", target.id}};
    using Kind = simulation::TargetMotion::Kind;
    if (motion.kind == Kind::compliant) {
      one["kind"] = "compliant";
      one["compliance_m_per_n"] = motion.compliance;
    } else if (motion.kind == Kind::rattling) {
      one["effect"] = "rattling_reflector";
      one["shift_m"] = array(motion.shift);
    } else {
      one["kind"] = motion.kind == Kind::slip ? "slip" : motion.kind == Kind::reseated ? "reseated" : "proportional";
      one["shift_m"] = array(motion.shift);
      if (motion.kind == Kind::reseated) {
        one["from_s"] = motion.from_s;
      } else {
        one["at_n"] = motion.at_force;
      }
    }
    list.push_back(one);
  }
}

/// R0 and axes by the rules of `frames`, of a machine whose axes are known.
frames::ArmInR0 trueArm(const simulation::SimulationSpec& spec, const robot::Robot& geometry) {
  frames::MeasuredAxes axes(static_cast<std::size_t>(geometry.axes()), frames::MeasuredAxis(geometry.joints()));
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i].measured = true;
    axes[i].at_zero.line = geometry.axes_in_base_at_zero[i];
  }
  return frames::armInR0(spec.nominal, axes);
}

Json linksJson(const robot::Robot& nominal, const frames::ArmInR0& arm) {
  Json list = Json::array();
  const frames::Links links = frames::linkGeometry(nominal, arm);
  for (std::size_t i = 0; i < links.size(); ++i) {
    list.push_back({{"between_axes", {i + 1, i + 2}},
                    {"length_mm", links[i].distance / io::kMillimetre},
                    {"nominal_length_mm", links[i].nominal_distance / io::kMillimetre},
                    {"angle_deg", links[i].angle / io::kDegree},
                    {"nominal_angle_deg", links[i].nominal_angle / io::kDegree},
                    {"near_parallel", links[i].near_parallel}});
  }
  return list;
}

/// True less nominal, as the specification states it or as it was drawn.
Json axisErrorsJson(const simulation::SimulationSpec& spec) {
  Json list = Json::array();
  const PerJoint<simulation::AxisError> errors = simulation::drawAxisErrors(spec);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    list.push_back({{"axis", i + 1},
                    {"offset_m", array(errors[i].offset)},
                    {"tilt_rad", array(errors[i].tilt)},
                    {"zero_rad", errors[i].zero}});
  }
  return list;
}

Json targetsJson(const simulation::SimulationSpec& spec) {
  Json targets = Json::object();
  for (const simulation::TrueTarget& one : spec.targets) targets[one.id] = array(one.position_in_flange);
  return targets;
}

Json noiseJson(const simulation::SimulationSpec& spec) {
  const campaign::Tracker& tracker = spec.tracker.declared;
  Json noise{{"true_noise_factor", spec.tracker.true_noise_factor},
             {"range_fixed_m", tracker.range_fixed},
             {"range_m_per_m", tracker.range_per_m},
             {"angle_fixed_m", tracker.angle_fixed},
             {"angle_m_per_m", tracker.angle_per_m},
             {"read_back_resolution_rad", spec.read_back_resolution}};
  if (spec.load_cell) {
    noise["force_sigma_n"] = spec.load_cell->declared.force_sigma;
    noise["moment_sigma_nm"] = spec.load_cell->declared.moment_sigma;
  }
  return noise;
}

}  // namespace

Json trueEffectsJson(const simulation::SimulationSpec& spec) {
  Json list = Json::array();
  for (std::size_t i = 0; i < spec.machine.joints.size(); ++i) {
    for (Json& one : effectsOfJoint(spec.machine.joints[i], spec.loading.has_value())) {
      Json named{{"effect", one["effect"]}, {"part", jointName(i)}};
      named.update(one);
      list.push_back(std::move(named));
    }
  }
  addStructure(spec, list);
  addLoad(spec, list);
  addStation(spec, list);
  return list;
}

Json truthJson(const simulation::SimulationSpec& spec) {
  const simulation::ElasticMachine machine = simulation::buildMachine(spec);
  const robot::Robot geometry = simulation::rigidGeometry(machine);
  const frames::ArmInR0 arm = trueArm(spec, geometry);
  Json json{{"campaign",
             {{"name", spec.name},
              {"date", spec.date},
              {"robot", spec.nominal.name},
              {"double_encoder", nameOf(spec.double_encoder)}}},
            {"seed", spec.seed},
            {"measurement", spec.measurement}};
  if (!spec.double_encoder_joints.empty())
    json["campaign"]["double_encoder_joints"] = jointNumbers(spec.double_encoder_joints);
  Json stiffness = Json::array(), compliances = Json::array();
  for (const simulation::JointStiffness& joint : spec.machine.joints) {
    stiffness.push_back(rate(joint.torsion));
    compliances.push_back(compliance(joint.torsion));
  }
  json["stiffness_nm_per_rad"] = stiffness;
  json["compliance_rad_per_nm"] = compliances;
  json["effects"] = trueEffectsJson(spec);
  json["r0_from_base_link"] = matrix(arm.r0_from_base_link);
  json["r0_from_tracker"] = matrix(arm.r0_from_points * spec.tracker.base_from_tracker);
  json["axes"] = Json::array();
  for (std::size_t i = 0; i < arm.arm.axes_in_base_at_zero.size(); ++i) {
    const metrology::Line& axis = arm.arm.axes_in_base_at_zero[i];
    json["axes"].push_back({{"axis", i + 1}, {"point_m", array(axis.point)}, {"direction", array(axis.direction)}});
  }
  json["links"] = linksJson(spec.nominal, arm);
  json["link_lengths_mm"] = Json::array();
  for (const Json& link : json["links"]) json["link_lengths_mm"].push_back(link["length_mm"]);
  json["axis_errors"] = axisErrorsJson(spec);
  json["targets_in_flange_m"] = targetsJson(spec);
  Json masses = Json::array();
  for (std::size_t body = 1; body < machine.bodies.size(); ++body) masses.push_back(machine.bodies[body].mass_kg);
  json["masses_kg"] = masses;
  json["noise"] = noiseJson(spec);
  return json;
}

}  // namespace stiffscope::reports
