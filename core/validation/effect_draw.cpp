#include "core/validation/effect_draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/io/units.h"
#include "core/simulation/machine.h"

namespace stiffscope::validation {

using Eigen::Vector3d;
using numerics::RandomStream;

Vector3d drawDirection(numerics::RandomStream& random) { return random.normal3().normalized(); }

int drawIndex(int count, numerics::RandomStream& random) {
  return std::min(count - 1, static_cast<int>(random.uniform() * count));
}

namespace {

double length(const simulation::SimulationSpec& spec, int joint) {
  const auto& axes = spec.nominal.axes_in_base_at_zero;
  const auto axis = static_cast<std::size_t>(axes.axisOf(joint));
  return (axes[axis + 1].point - axes[axis].point).norm();
}

}  // namespace

double fullLoad(const simulation::SimulationSpec& spec) {
  if (const auto* weights = std::get_if<simulation::HangingWeights>(&spec.loading->load)) {
    return weights->masses_kg.back() * 9.80665;
  }
  return std::get<simulation::CablePull>(spec.loading->load).tensions.back();
}

double usualTorque(const simulation::SimulationSpec& spec, int joint) {
  const Vector3d flange = spec.nominal.base_from_flange_at_zero.translation();
  const robot::ArmAxes& axes = spec.nominal.axes_in_base_at_zero;
  const Vector3d axis = axes[static_cast<std::size_t>(axes.axisOf(joint))].point;
  // The hook's own offset is what turns the last joint.
  return fullLoad(spec) * (0.5 * (flange - axis).norm() + 0.5 * spec.loading->hook_in_flange.norm());
}

std::array<int, 2> longestLinks(const simulation::SimulationSpec& spec) {
  std::vector<int> joints;
  for (int joint = 1; joint + 1 < spec.nominal.joints(); ++joint) joints.push_back(joint);
  std::stable_sort(joints.begin(), joints.end(), [&](int a, int b) { return length(spec, a) > length(spec, b); });
  return {std::min(joints[0], joints[1]), std::max(joints[0], joints[1])};
}

namespace {

double torsion(const simulation::SimulationSpec& spec, int joint) {
  return *spec.machine.joints[static_cast<std::size_t>(joint)].torsion;
}

std::string jointName(int joint) { return "joint " + std::to_string(joint + 1); }

std::string allJoints(const simulation::SimulationSpec& spec) {
  return "joints 1 to " + std::to_string(spec.nominal.joints());
}

/// A beam as stiff, at strength 1, as the joint it follows: EI / L and GJ / L are the joint's stiffness.
EffectDraw linkCompliance(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int which = drawIndex(2, random);
  const int joint = longestLinks(machine)[static_cast<std::size_t>(which)];
  const double twist = random.uniform(0.5, 2.0);
  const double root = torsion(machine, std::min(joint, 2));
  EffectDraw draw;
  draw.detail = which == 0 ? "upper arm" : "forearm";
  draw.most = 2.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s <= 0.0) return;
    const double rigidity = root * length(spec, joint) / s;
    spec.machine.links.push_back({joint, rigidity, rigidity / twist, std::nullopt, std::nullopt});
  };
  return draw;
}

EffectDraw bearingTilt(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int joint = drawIndex(machine.nominal.joints() - 1, random);
  EffectDraw draw;
  draw.detail = jointName(joint);
  draw.most = 3.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    simulation::JointStiffness& one = spec.machine.joints[static_cast<std::size_t>(joint)];
    one.bearing = 1.0 / (1.0 / *one.bearing + s / *one.torsion);
  };
  return draw;
}

EffectDraw baseCompliance(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const double rate = torsion(machine, 1), other = random.uniform(0.6, 1.6), yaw = random.uniform(0.0, 0.5);
  EffectDraw draw;
  draw.most = 1.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (!(s > 0.0)) return;
    spec.machine.base_rotation = rate / s * Vector3d(1.0, 1.0 / other, 10.0 / (0.1 + yaw));
    // Of an arm on a rail the carriage's drive gives along it as well, by as much at the height of a shoulder.
    if (spec.nominal.rail) spec.machine.base_translation = rate / s * Vector3d(1.0, 20.0, 20.0);
  };
  return draw;
}

/// A rail between two supports on either side of the carriage's travel: EI / L at strength 1 is joint 2's stiffness.
EffectDraw railBending(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const double before = random.uniform(0.3, 1.2), beyond = random.uniform(0.3, 1.2);  // m
  const double level = random.uniform(0.5, 2.0), twist = random.uniform(0.3, 1.0);
  EffectDraw draw;
  draw.apply = [](double, simulation::SimulationSpec&) {};
  if (!machine.nominal.rail) return draw;  // an arm on no rail has none
  const double from = machine.rail.low - before, to = machine.rail.high + beyond;
  const double rigidity = torsion(machine, 1) * (to - from);
  draw.most = 5.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s > 0.0)
      spec.rail.beam = simulation::RailBeam{from, to, rigidity / s, level * rigidity / s, twist * rigidity / s};
  };
  return draw;
}

EffectDraw jointCoupling(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int joints = machine.nominal.joints();
  std::vector<std::array<int, 2>> pairs{{1, 2}};  // a parallelogram, or within the wrist
  for (int j = robot::armJointsOf(joints); j + 1 < joints; ++j) pairs.push_back({j, j + 1});
  const std::array<int, 2> pair = pairs[static_cast<std::size_t>(drawIndex(static_cast<int>(pairs.size()), random))];
  const double ratio = random.uniform(0.5, 1.2) * (random.uniform() < 0.5 ? -1.0 : 1.0);
  const double a = torsion(machine, pair[0]), b = torsion(machine, pair[1]);
  EffectDraw draw;
  draw.detail = "joints " + std::to_string(pair[0] + 1) + " and " + std::to_string(pair[1] + 1);
  draw.most = 3.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    // Arms such that the shared spring, at strength 1, is to each joint about what its own is.
    if (s > 0.0) spec.machine.shared_springs.push_back({pair, {1.0, ratio * std::sqrt(b / a)}, s * a});
  };
  return draw;
}

EffectDraw jointHardening(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const std::array<int, 3> joints{1, 2, machine.nominal.joints() - 2};
  const int joint = joints[static_cast<std::size_t>(drawIndex(3, random))];
  const double k = torsion(machine, joint), torque = usualTorque(machine, joint);
  const int kind = drawIndex(3, random);
  EffectDraw draw;
  draw.detail = jointName(joint);
  draw.most = 5.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s <= 0.0) return;
    simulation::JointStiffness& one = spec.machine.joints[static_cast<std::size_t>(joint)];
    if (kind == 0) {
      one.cubic = s * k * std::pow(k / torque, 2);
    } else if (kind == 1) {  // a catalogue's K1, K2, K3, growing
      one.stages = simulation::JointStages{{0.25 * torque, 0.7 * torque}, {k, k * (1 + s), k * (1 + 1.6 * s)}};
    } else {  // and dropping
      one.stages = simulation::JointStages{{0.3 * torque, 0.8 * torque}, {k, k / (1 + s), k / (1 + 1.6 * s)}};
    }
  };
  return draw;
}

EffectDraw backlash(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  // Those whose torque changes sign with posture and load: the first and the wrist's.
  const int wrist = robot::wristJointsOf(machine.nominal.joints());
  const int which = drawIndex(1 + wrist, random);
  const int joint = which == 0 ? 0 : machine.nominal.joints() - wrist + which - 1;
  const double twist = usualTorque(machine, joint) / torsion(machine, joint);
  EffectDraw draw;
  draw.detail = jointName(joint);
  draw.most = 10.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s > 0.0) {
      spec.machine.joints[static_cast<std::size_t>(joint)].backlash = simulation::JointBacklash{s * twist, 0.02};
    }
  };
  return draw;
}

EffectDraw hysteresis(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int which = drawIndex(4, random);  // one of joints 1-3, or all three
  const int sliders = 1 + drawIndex(6, random);
  const double sticking = random.uniform(0.5, 1.5);
  std::array<double, 3> torque{};
  for (int i = 0; i < 3; ++i) torque[static_cast<std::size_t>(i)] = usualTorque(machine, i);
  EffectDraw draw;
  draw.detail = which < 3 ? jointName(which) : "joints 1 to 3";
  draw.most = 2.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s <= 0.0) return;
    for (int i = 0; i < 3; ++i) {
      if (which < 3 && i != which) continue;
      simulation::JointStiffness& one = spec.machine.joints[static_cast<std::size_t>(i)];
      one.friction =
          simulation::JointFriction{s * torque[static_cast<std::size_t>(i)], sticking * *one.torsion, sliders};
    }
  };
  return draw;
}

EffectDraw gravityCompensator(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const auto& axes = machine.nominal.axes_in_base_at_zero;
  const int joint = longestLinks(machine)[0];
  const auto at = static_cast<std::size_t>(axes.axisOf(joint));
  const Vector3d shoulder = axes[at].point, upper = axes[at + 1].point - axes[at].point;
  const double behind = random.uniform(0.25, 0.45), along = random.uniform(0.25, 0.45);
  const double rate = random.uniform(0.3, 1.5);
  const Vector3d from = shoulder + upper.norm() * Vector3d(-behind, random.uniform(0.1, 0.2), -0.1);
  const Vector3d to = shoulder + along * upper + Vector3d(0, from.y(), 0);
  const double weight = 9.80665 * (machine.nominal.bodies[at + 2].mass_kg + machine.nominal.bodies[at + 3].mass_kg);
  EffectDraw draw;
  draw.shows = Shows::positions;
  draw.detail = jointName(joint);
  draw.most = 5.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s > 0.0) {
      spec.machine.link_springs.push_back({static_cast<int>(at), static_cast<int>(at) + 1, from, to,
                                           s * rate * weight / (to - from).norm(), s * weight});
    }
  };
  return draw;
}

EffectDraw loadPointError(numerics::RandomStream& random) {
  const Vector3d direction = drawDirection(random);
  EffectDraw draw;
  draw.most = 0.15;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) { spec.load_cell->place_error = s * direction; };  // m
  return draw;
}

EffectDraw loadCellMisalignment(numerics::RandomStream& random) {
  const Vector3d axis = drawDirection(random);
  EffectDraw draw;
  draw.most = 20.0 * io::kDegree;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) { spec.load_cell->misalignment = s * axis; };  // rad
  return draw;
}

EffectDraw loadCellBias(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const Vector3d direction = drawDirection(random);
  const double full = fullLoad(machine);
  const bool unread = random.uniform() < 0.5;
  EffectDraw draw;
  draw.detail = unread ? "a force that is not read" : "a force that is only read";
  draw.most = 0.4;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (unread) {
      spec.load_cell->unread_force = Vector3d(0, 0, -s * full);  // a shackle that was tared away
    } else {
      spec.load_cell->bias.head<3>() = s * full * direction;
    }
  };
  return draw;
}

EffectDraw frameError(numerics::RandomStream& random) {
  const Vector3d shift = drawDirection(random), turn = drawDirection(random);
  const bool robot = random.uniform() < 0.5;
  EffectDraw draw;
  draw.shows = robot ? Shows::positions : Shows::nests;
  draw.detail = robot ? "robot" : "tracker";
  draw.most = 5e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in m; the turn is as much at 2 m
    if (s <= 0.0) return;
    Eigen::Isometry3d moved(Eigen::AngleAxisd(0.5 * s, turn));
    moved.translation() = s * shift;
    (robot ? spec.station.robot_moved : spec.station.tracker_moved) = moved;
  };
  return draw;
}

/// Joint zeros and link lengths against nominal, on top of the axes' background.
EffectDraw kinematicError(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const int inner = machine.nominal.joints() - 2;  // all but the first and the last
  const int first = 1 + drawIndex(inner, random), second = 1 + drawIndex(inner, random);
  const bool zero = random.uniform() < 0.5;
  const double sign = random.uniform() < 0.5 ? -1.0 : 1.0, share = random.uniform(-1.0, 1.0);
  const PerJoint<simulation::AxisError> background = simulation::drawAxisErrors(machine);
  EffectDraw draw;
  draw.shows = Shows::positions;
  draw.detail = zero ? "zeros of joints " : "lengths before joints ";
  draw.detail += std::to_string(first + 1) + " and " + std::to_string(second + 1);
  draw.most = 5e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in m, or rad
    PerJoint<simulation::AxisError> errors = background;
    const auto add = [&](int joint, double size) {
      const auto& axes = spec.nominal.axes_in_base_at_zero;
      const auto axis = static_cast<std::size_t>(axes.axisOf(joint));
      simulation::AxisError& error = errors[axis];
      const Vector3d link = axes[axis].point - axes[axis - 1].point;
      if (zero) {
        error.zero += size;
      } else {
        error.offset += size * (link.norm() > 1e-3 ? Vector3d(link.normalized()) : Vector3d(Vector3d::UnitX()));
      }
    };
    add(first, sign * s);
    if (second != first) add(second, share * s);
    for (int joint = 0; joint < spec.nominal.joints(); ++joint)
      spec.machine.geometry.listed[static_cast<std::size_t>(joint)] =
          errors[static_cast<std::size_t>(spec.nominal.axes_in_base_at_zero.axisOf(joint))];
  };
  return draw;
}

EffectDraw trackerDrift(numerics::RandomStream& random) {
  Vector6d way;
  way << drawDirection(random), 0.4 * drawDirection(random);
  const bool ramp = random.uniform() < 0.5;
  EffectDraw draw;
  draw.shows = Shows::nests;
  draw.detail = ramp ? "ramp" : "walk";
  draw.most = 5e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in m an hour, or after an hour
    if (ramp) {
      spec.station.ramp = s / 3600.0 * way;
    } else {
      spec.station.walk = s / 60.0 * way.cwiseAbs();
    }
  };
  return draw;
}

EffectDraw targetMotion(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  using Kind = simulation::TargetMotion::Kind;
  const std::size_t which = static_cast<std::size_t>(drawIndex(static_cast<int>(machine.targets.size()), random));
  const Kind kind =
      std::array{Kind::proportional, Kind::compliant, Kind::slip}[static_cast<std::size_t>(drawIndex(3, random))];
  const Vector3d direction = drawDirection(random);
  const double full = fullLoad(machine);
  EffectDraw draw;
  draw.detail = machine.targets[which].id;
  draw.most = 2e-3;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {  // s in m at full load
    if (s <= 0.0) return;
    spec.targets[which].motion =
        simulation::TargetMotion{kind, s * direction, kind == Kind::slip ? 0.6 * full : full, s / full};
  };
  return draw;
}

EffectDraw toolCompliance(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const double rate = torsion(machine, machine.nominal.joints() - 2),
               size = machine.targets[0].position_in_flange.norm();
  const Vector3d spread(random.uniform(0.7, 1.4), random.uniform(0.7, 1.4), random.uniform(0.5, 3.0));
  EffectDraw draw;
  draw.most = 3.0;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s <= 0.0) return;
    spec.machine.tool_plate =
        simulation::ToolPlate{rate / s / (size * size) * Vector3d(10.0, 10.0, 10.0), rate / s * spread};
  };
  return draw;
}

EffectDraw drawOf(effects::Effect effect, const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  switch (effect) {
    case effects::Effect::link_compliance:
      return linkCompliance(machine, random);
    case effects::Effect::bearing_tilt:
      return bearingTilt(machine, random);
    case effects::Effect::base_compliance:
      return baseCompliance(machine, random);
    case effects::Effect::rail_bending:
      return railBending(machine, random);
    case effects::Effect::joint_coupling:
      return jointCoupling(machine, random);
    case effects::Effect::joint_hardening:
      return jointHardening(machine, random);
    case effects::Effect::backlash:
      return backlash(machine, random);
    case effects::Effect::hysteresis:
      return hysteresis(machine, random);
    case effects::Effect::gravity_compensator:
      return gravityCompensator(machine, random);
    case effects::Effect::load_point_error:
      return loadPointError(random);
    case effects::Effect::load_cell_misalignment:
      return loadCellMisalignment(random);
    case effects::Effect::load_cell_bias:
      return loadCellBias(machine, random);
    case effects::Effect::frame_error:
      return frameError(random);
    case effects::Effect::kinematic_error:
      return kinematicError(machine, random);
    case effects::Effect::tracker_drift:
      return trackerDrift(random);
    case effects::Effect::target_motion:
      return targetMotion(machine, random);
    case effects::Effect::tool_compliance:
      return toolCompliance(machine, random);
  }
  return {};
}

/// Strength 1 is half of what an arm of this kind usually has.
constexpr double kHalf = 0.5;

EffectDraw bearingsAsTheyAre(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  PerJoint<double> stiffer(machine.machine.joints.size());
  for (double& ratio : stiffer) ratio = random.uniform(8.0, 18.0) / kHalf;
  EffectDraw draw;
  draw.detail = allJoints(machine);
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s <= 0.0) return;
    for (std::size_t i = 0; i < stiffer.size(); ++i)
      spec.machine.joints[i].bearing = stiffer[i] / s * *spec.machine.joints[i].torsion;
  };
  return draw;
}

EffectDraw linksAsTheyAre(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  struct Link {
    int joint;
    double bending, torsion;  // Nm^2
  };
  std::vector<Link> links;
  for (const int joint : longestLinks(machine)) {
    const double ratio = random.uniform(4.0, 10.0) / kHalf, twist = random.uniform(0.5, 2.0);
    const double rigidity = ratio * torsion(machine, std::min(joint, 2)) * length(machine, joint);
    links.push_back({joint, rigidity, rigidity / twist});
  }
  EffectDraw draw;
  draw.detail = "upper arm and forearm";
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s <= 0.0) return;
    for (const Link& one : links)
      spec.machine.links.push_back({one.joint, one.bending / s, one.torsion / s, std::nullopt, std::nullopt});
  };
  return draw;
}

EffectDraw baseAsItIs(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  const double about_x = random.uniform(10.0, 25.0) / kHalf, about_y = random.uniform(10.0, 25.0) / kHalf;
  const Vector3d rates = torsion(machine, 1) * Vector3d(about_x, about_y, 10.0 * about_x);
  EffectDraw draw;
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s > 0.0) spec.machine.base_rotation = rates / s;
  };
  return draw;
}

EffectDraw frictionAsItIs(const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  PerJoint<simulation::JointFriction> frictions(machine.machine.joints.size());
  for (std::size_t i = 0; i < frictions.size(); ++i) {
    const double share = kHalf * random.uniform(0.01, 0.02);
    frictions[i] = {share * usualTorque(machine, static_cast<int>(i)),
                    random.uniform(0.5, 1.5) * torsion(machine, static_cast<int>(i)), 1 + drawIndex(6, random)};
  }
  EffectDraw draw;
  draw.detail = allJoints(machine);
  draw.apply = [=](double s, simulation::SimulationSpec& spec) {
    if (s <= 0.0) return;
    for (std::size_t i = 0; i < frictions.size(); ++i) {
      spec.machine.joints[i].friction = frictions[i];
      spec.machine.joints[i].friction->torque *= s;
    }
  };
  return draw;
}

}  // namespace

EffectDraw drawAsIs(effects::Effect effect, const simulation::SimulationSpec& machine, numerics::RandomStream& random) {
  EffectDraw draw;
  if (effect == effects::Effect::bearing_tilt) {
    draw = bearingsAsTheyAre(machine, random);
  } else if (effect == effects::Effect::link_compliance) {
    draw = linksAsTheyAre(machine, random);
  } else if (effect == effects::Effect::base_compliance) {
    draw = baseAsItIs(machine, random);
  } else if (effect == effects::Effect::hysteresis) {
    draw = frictionAsItIs(machine, random);
  } else {
    throw std::invalid_argument("no arm is known to have " + std::string(effects::idOf(effect)) + " as it is");
  }
  draw.effect = effects::idOf(effect);
  return draw;
}

EffectDraw drawEffect(effects::Effect effect, const simulation::SimulationSpec& machine,
                      numerics::RandomStream& random) {
  EffectDraw draw = drawOf(effect, machine, random);
  draw.effect = effects::idOf(effect);
  return draw;
}

}  // namespace stiffscope::validation
