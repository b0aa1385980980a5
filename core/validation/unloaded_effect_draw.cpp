#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/io/units.h"
#include "core/validation/effect_draw.h"

namespace stiffscope::validation {

using Eigen::Vector3d;
using numerics::RandomStream;

double milliradianStiffness(const simulation::SimulationSpec& spec, int joint) {
  constexpr double kGravity = 9.80665, kTurn = 1e-3;  // m/s^2, rad
  const Vector3d axis = spec.nominal.axes_in_base_at_zero[static_cast<std::size_t>(joint)].point;
  double torque = 0.0;
  for (std::size_t body = static_cast<std::size_t>(joint) + 1; body < spec.nominal.bodies.size(); ++body) {
    const robot::BodyMass& mass = spec.nominal.bodies[body];
    torque += kGravity * mass.mass_kg * (mass.com_in_base_at_zero - axis).norm();
  }
  // The last joint may carry a body whose centre is on its axis; it is given what a flange of 5 cm would have.
  const double least = kGravity * 0.05 * spec.nominal.bodies.back().mass_kg;
  return std::max(torque, least) / kTurn;
}

double dayLength(const simulation::SimulationSpec& spec) {
  const double readings = static_cast<double>(spec.unloaded_repeats) * static_cast<double>(spec.targets.size());
  return static_cast<double>(spec.postures.size()) * (spec.timing.move_s + readings * spec.timing.reading_s);
}

namespace {

std::string jointCalled(int joint) { return "joint " + std::to_string(joint + 1); }

simulation::JointStiffness& jointOf(simulation::SimulationSpec& spec, int joint) {
  return spec.machine.joints[static_cast<std::size_t>(joint)];
}

/// Gives the joint this stiffness as well, in series with what it may have of another effect.
void soften(simulation::SimulationSpec& spec, int joint, double stiffness) {
  std::optional<double>& torsion = jointOf(spec, joint).torsion;
  torsion = torsion ? 1.0 / (1.0 / *torsion + 1.0 / stiffness) : stiffness;
}

/// Joint 2, joint 3, or all that own weight turns, which the first and the last are not; strength 1: a milliradian by
/// the weight standing out level.
EffectDraw jointCompliance(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int which = drawIndex(3, random);
  const int joints = machine.nominal.joints();
  PerJoint<double> stiffness(static_cast<std::size_t>(joints));
  for (int i = 0; i < joints; ++i) {
    const double spread = std::exp(0.4 * random.normal());
    if (which == 2 ? (i > 0 && i < joints - 1) : i == which + 1) {
      stiffness[static_cast<std::size_t>(i)] = spread * milliradianStiffness(machine, i);
    }
  }
  EffectDraw draw;
  draw.detail = which < 2 ? jointCalled(which + 1) : "joints 2 to " + std::to_string(joints - 1);
  draw.most = 5.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    for (std::size_t i = 0; i < stiffness.size() && s > 0.0; ++i) {
      if (stiffness[i] > 0.0) soften(spec, static_cast<int>(i), stiffness[i] / s);
    }
  };
  return draw;
}

EffectDraw linksBend(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int which = random.uniform() < 0.6 ? 0 : 1;
  const int joint = longestLinks(machine)[static_cast<std::size_t>(which)];
  const auto& axes = machine.nominal.axes_in_base_at_zero;
  const auto at = static_cast<std::size_t>(joint);
  const double length = (axes[at + 1].point - axes[at].point).norm(), twist = random.uniform(0.5, 2.0);
  const double rigidity = milliradianStiffness(machine, joint) * length;
  EffectDraw draw;
  draw.detail = which == 0 ? "upper arm" : "forearm";
  draw.most = 5.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s > 0.0) spec.machine.links.push_back({joint, rigidity / s, rigidity / twist / s, {}, {}});
  };
  return draw;
}

EffectDraw bearingsTilt(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int joint = drawIndex(machine.nominal.joints() - 1, random);
  const double rate = milliradianStiffness(machine, joint);
  EffectDraw draw;
  draw.detail = jointCalled(joint);
  draw.most = 5.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s > 0.0) jointOf(spec, joint).bearing = rate / s;
  };
  return draw;
}

EffectDraw baseGives(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const double rate = milliradianStiffness(machine, 0), other = random.uniform(0.6, 1.6);
  EffectDraw draw;
  draw.most = 5.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s > 0.0) spec.machine.base_rotation = rate / s * Vector3d(1.0, 1.0 / other, 10.0);
  };
  return draw;
}

/// A gas spring made for arm and payload: without the payload it pulls more than the weight does. It shows through the
/// compliance of the joint that it spans, the upper arm's, which the strength scales.
EffectDraw gasSpring(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const auto& axes = machine.nominal.axes_in_base_at_zero;
  const int joint = longestLinks(machine)[0];
  const auto at = static_cast<std::size_t>(joint);
  const Vector3d shoulder = axes[at].point, upper = axes[at + 1].point - axes[at].point;
  const Vector3d from = shoulder + upper.norm() * Vector3d(-random.uniform(0.25, 0.45), random.uniform(0.1, 0.2), -0.1);
  const Vector3d to = shoulder + random.uniform(0.25, 0.45) * upper + Vector3d(0, from.y() - shoulder.y(), 0);
  const double rate = random.uniform(0.3, 1.5), share = random.uniform(1.0, 2.0);
  const double stiffness = milliradianStiffness(machine, joint);
  const double arm = (to - shoulder).cross((from - to).normalized()).norm();
  const double tension =
      share * 1e-3 * stiffness / std::max(arm, 0.05);  // N, whose torque is that share of the weight's
  EffectDraw draw;
  draw.detail = jointCalled(joint);
  draw.most = 5.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s <= 0.0) return;
    soften(spec, joint, stiffness / s);
    spec.machine.link_springs.push_back({joint, joint + 1, from, to, rate * tension / (to - from).norm(), tension});
  };
  return draw;
}

/// An encoder ring or an eccentric gear, once or twice a turn; or a gear's own order, in quarters.
EffectDraw periodicError(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int joint = drawIndex(machine.nominal.joints(), random);
  const double kind = random.uniform(), phase = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double own = 5.0 + 0.25 * drawIndex(121, random);
  const double order = kind < 0.3 ? 1.0 : kind < 0.5 ? 2.0 : own;
  EffectDraw draw;
  draw.detail = jointCalled(joint);
  draw.most = 5e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in rad
    if (s > 0.0) jointOf(spec, joint).angle_wave = simulation::JointWave{s, order, phase};
  };
  return draw;
}

EffectDraw wrongRatio(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  // Within the wrist, and a parallelogram.
  const int joints = machine.nominal.joints(), wrist = robot::armJointsOf(joints);
  std::vector<std::array<int, 2>> pairs;
  for (int first = wrist; first + 1 < joints; ++first) pairs.push_back({first, first + 1});
  if (joints - wrist > 2) pairs.push_back({wrist, wrist + 2});
  pairs.push_back({1, 2});
  const bool own = random.uniform() < 0.5;
  const int joint = drawIndex(machine.nominal.joints(), random);
  const std::array<int, 2> pair = pairs[static_cast<std::size_t>(drawIndex(static_cast<int>(pairs.size()), random))];
  const int of = own ? joint : pair[0], turned = own ? joint : pair[1];
  const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
  EffectDraw draw;
  draw.detail = own ? jointCalled(joint) : "joints " + std::to_string(of + 1) + " and " + std::to_string(turned + 1);
  draw.most = 0.01;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s > 0.0) jointOf(spec, turned).ratio = simulation::JointRatio{sign * s, of};
  };
  return draw;
}

EffectDraw playInGear(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int joint = drawIndex(machine.nominal.joints(), random);
  const double torque = 1e-3 * milliradianStiffness(machine, joint), share = random.uniform(0.2, 0.8);
  const bool weight_decides = random.uniform() < 0.5;
  EffectDraw draw;
  draw.detail = jointCalled(joint);
  draw.most = 5e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in rad
    if (s <= 0.0) return;
    jointOf(spec, joint).lost_motion = simulation::LostMotion{s, {}};
    if (weight_decides) jointOf(spec, joint).lost_motion->friction = share * torque;
  };
  return draw;
}

EffectDraw loggedEarly(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const double after = random.uniform(0.2, 1.0);
  const int joints = machine.nominal.joints();
  const int slow =
      random.uniform() < 0.7 ? -1 : drawIndex(joints, random);  // all drives alike, about, or one that creeps
  PerJoint<double> shares(static_cast<std::size_t>(joints));
  for (double& share : shares) share = random.uniform(0.7, 1.3);
  EffectDraw draw;
  draw.detail = slow < 0 ? "joints 1 to " + std::to_string(joints) : jointCalled(slow);
  draw.most = 0.05;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s: the share of the move that is still to come
    if (s <= 0.0) return;
    spec.early_log = simulation::EarlyLog{after, JointVector::Constant(joints, after / 50.0)};
    for (int i = 0; i < joints; ++i) {
      if (slow < 0 || i == slow) {
        spec.early_log->time_constants[i] = -after / std::log(s * shares[static_cast<std::size_t>(i)]);
      }
    }
  };
  return draw;
}

EffectDraw stationWanders(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  Vector6d way;
  way << drawDirection(random), 0.4 * drawDirection(random);
  const int kind = drawIndex(3, random);
  const double day = dayLength(machine), time = day * random.uniform(0.15, 0.5), knot = day * random.uniform(0.1, 0.3);
  EffectDraw draw;
  draw.detail = std::array{"ramp", "limit", "walk"}[static_cast<std::size_t>(kind)];
  draw.most = 5e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in m a day
    simulation::StationSpec& station = spec.station;
    if (kind == 0) {
      station.ramp = s / day * way;
    } else if (kind == 1) {
      station.limit = s * way;
      station.limit_time = time;
    } else {
      station.walk = s / std::sqrt(day) * way.cwiseAbs();
      station.knot_s = knot;
      station.smooth = true;
    }
  };
  return draw;
}

double middleOfDay(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  return random.uniform(0.25, 0.75) * dayLength(machine);
}

EffectDraw stationJumps(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const Vector3d shift = drawDirection(random), turn = drawDirection(random);
  const bool robot = random.uniform() < 0.5;
  const double at_s = middleOfDay(machine, random);
  EffectDraw draw;
  draw.detail = robot ? "robot" : "station";
  draw.most = 5e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in m; the turn is as much at 2 m
    if (s <= 0.0) return;
    Eigen::Isometry3d moved(Eigen::AngleAxisd(0.5 * s, turn));
    moved.translation() = s * shift;
    (robot ? spec.station.robot_moved : spec.station.tracker_moved) = moved;
    (robot ? spec.station.robot_moved_s : spec.station.tracker_moved_s) = at_s;
  };
  return draw;
}

EffectDraw reflectorReseated(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const auto which = static_cast<std::size_t>(drawIndex(static_cast<int>(machine.targets.size()), random));
  const Vector3d direction = drawDirection(random);
  const double at_s = middleOfDay(machine, random);
  EffectDraw draw;
  draw.detail = machine.targets[which].id;
  draw.most = 5e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in m
    if (s <= 0.0) return;
    simulation::TargetMotion motion;
    motion.kind = simulation::TargetMotion::Kind::reseated;
    motion.shift = s * direction;
    motion.from_s = at_s;
    spec.targets[which].motion = motion;
  };
  return draw;
}

/// All links or one, in proportion to their lengths; with the hall's temperature, or as drives warm up.
EffectDraw armGrows(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int only = random.uniform() < 0.6 ? -1 : longestLinks(machine)[random.uniform() < 0.5 ? 0 : 1];
  const double day = dayLength(machine), time = day * random.uniform(0.2, 0.8);
  const bool by_temperature = random.uniform() < 0.6;
  const double warmer = random.uniform(1.0, 6.0), begin = random.uniform(17.0, 25.0);
  const simulation::TemperatureCourse course = machine.temperature.value_or(
      simulation::TemperatureCourse{{0.0, 0.4 * day, day}, {begin, begin + 0.7 * warmer, begin + warmer}});
  EffectDraw draw;
  draw.detail = by_temperature ? "with temperature" : "with time";
  draw.most = 2e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s: share of the length, per kelvin or in all
    if (s <= 0.0) return;
    const auto& axes = spec.nominal.axes_in_base_at_zero;
    for (int i = 0; i + 1 < spec.nominal.joints(); ++i) {
      if (only >= 0 && i != only) continue;
      const auto at = static_cast<std::size_t>(i);
      const double more = s * (axes[at + 1].point - axes[at].point).norm();
      spec.machine.growths.push_back(by_temperature ? simulation::ThermalGrowth{i, 0.0, 1.0, more}
                                                    : simulation::ThermalGrowth{i, more, time, 0.0});
    }
    if (by_temperature) spec.temperature = course;
  };
  return draw;
}

EffectDraw wrongWeather(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const bool grows = random.uniform() < 0.5;
  const double at_s = middleOfDay(machine, random), day = dayLength(machine);
  const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
  EffectDraw draw;
  draw.detail = grows ? "grows" : "steps";
  draw.most = 1e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (grows) {
      spec.station.scale_per_second = sign * s / day;
    } else {
      spec.station.scale_step = sign * s;
      spec.station.scale_step_s = at_s;
    }
  };
  return draw;
}

/// As on loaded days, but a calibration takes it in: what shows is that the URDF misses by more than URDFs do.
EffectDraw geometryOff(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  EffectDraw draw = drawEffect(effects::Effect::kinematic_error, machine, random);
  draw.shows = Shows::geometry;
  draw.most = 0.05;
  return draw;
}

EffectDraw drawNamed(const std::string& id, const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  if (id == "kinematic_error") return geometryOff(machine, random);
  if (id == "joint_compliance") return jointCompliance(machine, random);
  if (id == "link_compliance") return linksBend(machine, random);
  if (id == "bearing_tilt") return bearingsTilt(machine, random);
  if (id == "base_compliance") return baseGives(machine, random);
  if (id == "gravity_compensator") return gasSpring(machine, random);
  if (id == "transmission_error") return periodicError(machine, random);
  if (id == "ratio_error") return wrongRatio(machine, random);
  if (id == "backlash") return playInGear(machine, random);
  if (id == "read_back_error") return loggedEarly(machine, random);
  if (id == "tracker_drift") return stationWanders(machine, random);
  if (id == "frame_error") return stationJumps(machine, random);
  if (id == "target_motion") return reflectorReseated(machine, random);
  if (id == "thermal_growth") return armGrows(machine, random);
  if (id == "scale_error") return wrongWeather(machine, random);
  throw std::invalid_argument("no effect of days without a load is called '" + id + "'");
}

}  // namespace

const std::vector<std::string>& unloadedEffects() {
  static const std::vector<std::string> ids{
      "kinematic_error",     "joint_compliance",   "link_compliance", "bearing_tilt",   "base_compliance",
      "gravity_compensator", "transmission_error", "ratio_error",     "backlash",       "read_back_error",
      "tracker_drift",       "frame_error",        "target_motion",   "thermal_growth", "scale_error"};
  return ids;
}

EffectDraw drawUnloadedEffect(const std::string& id, const simulation::SimulationSpec& machine,
                              numerics::RandomStream& random) {
  EffectDraw draw = drawNamed(id, machine, random);
  if (draw.shows != Shows::geometry) draw.shows = Shows::positions;
  draw.effect = id;
  return draw;
}

}  // namespace stiffscope::validation
