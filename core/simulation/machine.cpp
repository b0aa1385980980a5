#include "core/simulation/machine.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/io/input_error.h"
#include "core/numerics/random.h"
#include "core/simulation/carriage.h"
#include "core/simulation/rail_beam.h"
#include "core/simulation/rotation.h"
#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// Tip stiffness K (6x6, order ux uy uz rx ry rz, z along the beam, tip axes) of a clamped uniform beam of
/// length L (m), the inverse, plane by plane, of
///   | u |   | L^3/(3EI) + L/(kGA)   L^2/(2EI) | | F |
///   | r | = | L^2/(2EI)             L/EI      | | M |
/// (Timoshenko; without shear Euler-Bernoulli), with EA/L along and GJ/L about the beam. Rows of what the
/// beam does not state are zero. S. P. Timoshenko, Strength of Materials I. Linear in the tip's displacement:
/// right for tip rotations small against 1; what lies beyond is still turned by the finite rotation.
Eigen::Matrix<double, 6, 6> beamTipStiffness(const LinkBeam& beam, double length);

/// What the joint's torsion has besides a linear spring; where it has stages or a gap, all of it: half of the
/// gap to each side with `rest` of the first rate, then the stages (or the one rate), shifted by that half.
TorqueCurve jointCurve(const JointStiffness& joint);

/// What the base gets where its crack has closed.
TorqueCurve contactCurve(const OneSidedContact& contact);

namespace {

constexpr double kMeets = 1e-6;  ///< m: nominal axes closer than this meet

/// The point where the axes of the wrist meet at zero, if they do.
std::optional<Eigen::Vector3d> wristCentre(const robot::Robot& robot) {
  // The point with the least sum of squared distances from the three lines.
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int i = robot.armAxes(); i < robot.axes(); ++i) {
    const metrology::Line& axis = robot.axes_in_base_at_zero[static_cast<std::size_t>(i)];
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis.direction * axis.direction.transpose();
    normal += across;
    right += across * axis.point;
  }
  const Eigen::Vector3d centre = normal.ldlt().solve(right);
  for (int i = robot.armAxes(); i < robot.axes(); ++i) {
    const metrology::Line& axis = robot.axes_in_base_at_zero[static_cast<std::size_t>(i)];
    if ((centre - axis.point).cross(axis.direction).norm() > kMeets) return std::nullopt;
  }
  return centre;
}

}  // namespace

PerJoint<AxisError> drawAxisErrors(const SimulationSpec& spec) {
  const GeometryErrors& geometry = spec.machine.geometry;
  numerics::RandomStream random(spec.seed, "geometry");
  const auto axes = static_cast<std::size_t>(spec.nominal.axes());
  const auto wrist = static_cast<std::size_t>(spec.nominal.armAxes());
  PerJoint<AxisError> errors(axes);
  for (std::size_t i = 0; i < axes; ++i) {
    const metrology::Line& axis = spec.nominal.axes_in_base_at_zero[i];
    const Eigen::Matrix3d frame = frameAlong(axis.point, axis.direction).linear();
    const double position_sigma =
        i > wrist ? geometry.wrist_position_sigma.value_or(geometry.position_sigma) : geometry.position_sigma;
    const auto across = [&](double sigma) -> Eigen::Vector3d {
      const double x = random.normal(), y = random.normal();
      return sigma * (frame.col(0) * x + frame.col(1) * y);
    };
    // Drawn for listed axes too, so that listing one leaves the others' draws as they were.
    errors[i].offset = across(position_sigma);
    errors[i].tilt = across(geometry.direction_sigma);
    errors[i].zero = geometry.zero_sigma * random.normal();
    const int joint = spec.nominal.axes_in_base_at_zero.jointOf(static_cast<int>(i));
    if (joint >= 0 && geometry.listed[static_cast<std::size_t>(joint)])
      errors[i] = *geometry.listed[static_cast<std::size_t>(joint)];
  }
  return errors;
}

Eigen::Isometry3d frameError(const robot::Robot& nominal, int axis, const AxisError& error) {
  const bool of_wrist = axis >= nominal.armAxes();
  const std::optional<Eigen::Vector3d> wrist = of_wrist ? wristCentre(nominal) : std::nullopt;
  const Eigen::Vector3d pivot = wrist.value_or(nominal.axes_in_base_at_zero[static_cast<std::size_t>(axis)].point);
  return Eigen::Translation3d(error.offset) * turnAbout(pivot, error.tilt);
}

Eigen::Matrix<double, 6, 6> beamTipStiffness(const LinkBeam& beam, double length) {
  Eigen::Matrix<double, 6, 6> k = Eigen::Matrix<double, 6, 6>::Zero();
  if (beam.bending) {
    const double l = length, ei = *beam.bending;
    const double shear = beam.shear ? l / *beam.shear : 0.0;
    Eigen::Matrix2d compliance;
    compliance << l * l * l / (3 * ei) + shear, l * l / (2 * ei), l * l / (2 * ei), l / ei;
    const Eigen::Matrix2d plane = compliance.inverse();
    k(0, 0) = k(1, 1) = plane(0, 0);
    k(4, 4) = k(3, 3) = plane(1, 1);
    // A tip force along x turns the tip about +y; one along y turns it about -x.
    k(0, 4) = k(4, 0) = plane(0, 1);
    k(1, 3) = k(3, 1) = -plane(0, 1);
  }
  if (beam.axial) k(2, 2) = *beam.axial / length;
  if (beam.torsion) k(5, 5) = *beam.torsion / length;
  return k;
}

namespace {

constexpr double kStandardGravity = 9.80665;  ///< m/s^2

ElasticElement jointElement(const robot::Robot& robot, int joint, const JointStiffness& stiffness) {
  ElasticElement element;
  element.name = robot.joint_names[joint];
  element.axis = robot.axes_in_base_at_zero.axisOf(joint);
  const metrology::Line& axis = robot.axes_in_base_at_zero[element.axis];
  element.base_from_element_at_zero = frameAlong(axis.point, axis.direction);
  if (stiffness.bearing) {
    element.free = {3, 4};
    element.stiffness(3, 3) = element.stiffness(4, 4) = *stiffness.bearing;
  }
  if (stiffness.torsion) {
    element.free.push_back(5);
    // Where the drive has stages or a gap its whole torque is in the curve.
    if (!stiffness.stages && !stiffness.backlash) element.stiffness(5, 5) = *stiffness.torsion;
  }
  return element;
}

ElasticElement plateElement(const robot::Robot& robot, const ToolPlate& plate) {
  ElasticElement element;
  element.name = "tool plate";
  element.axis = robot.axes();
  element.base_from_element_at_zero = robot.base_from_flange_at_zero;
  element.free = {0, 1, 2, 3, 4, 5};
  element.stiffness.diagonal() << plate.translation, plate.rotation;
  return element;
}

/// Torsion coordinates, and the curves of joints and base.
void addCurves(ElasticMachine& machine) {
  machine.torsion_coordinates.assign(machine.truth.joints.size(), -1);
  Eigen::Index at = 0;
  for (const ElasticElement& element : machine.elements) {
    const auto torsion = std::find(element.free.begin(), element.free.end(), 5);
    if (element.axis >= 0 && element.axis < machine.axes() && !element.is_link && torsion != element.free.end()) {
      const int of_joint = machine.nominal.axes_in_base_at_zero.jointOf(element.axis);
      const std::size_t joint = static_cast<std::size_t>(of_joint);
      machine.torsion_coordinates[joint] = at + (torsion - element.free.begin());
      TorqueCurve curve = jointCurve(machine.truth.joints[joint]);
      if (curve.acts()) {
        machine.curves.push_back({machine.torsion_coordinates[joint], of_joint, std::move(curve)});
      }
    }
    if (element.name == kBaseElement) {
      for (const OneSidedContact& contact : machine.truth.base_contacts) {
        const auto turn = std::find(element.free.begin(), element.free.end(), 3 + contact.axis);
        if (turn != element.free.end()) {
          machine.curves.push_back({at + (turn - element.free.begin()), -1, contactCurve(contact)});
        }
      }
    }
    at += static_cast<Eigen::Index>(element.free.size());
  }
}

ElasticElement linkElement(const SimulationSpec& spec, const LinkBeam& beam) {
  const robot::Robot& robot = spec.nominal;
  const int axis = robot.axes_in_base_at_zero.axisOf(beam.joint);
  const Eigen::Vector3d root = robot.axes_in_base_at_zero[axis].point;
  const Eigen::Vector3d tip = axis + 1 == robot.axes() ? Eigen::Vector3d(robot.base_from_flange_at_zero.translation())
                                                       : robot.axes_in_base_at_zero[axis + 1].point;
  const double length = (tip - root).norm();
  if (length < 1e-3) {
    throw io::InputError({spec.file.string(), 0, "after_joint"}, std::to_string(beam.joint + 1),
                         "expected a joint whose point and the next one's are at least 1 mm apart in the URDF");
  }
  ElasticElement element;
  element.name = "link " + std::to_string(beam.joint + 1);
  element.axis = axis;
  element.is_link = true;
  element.base_from_element_at_zero = frameAlong(tip, tip - root);
  if (beam.bending) element.free = {0, 1, 3, 4};
  if (beam.axial) element.free.push_back(2);
  if (beam.torsion) element.free.push_back(5);
  element.stiffness = beamTipStiffness(beam, length);
  return element;
}

/// The rail below the arm's base, as it is with the carriage at the middle between its supports.
ElasticElement railElement(const SimulationSpec& spec) {
  const RailBeam& beam = *spec.rail.beam;
  ElasticElement element;
  element.name = kRailElement;
  element.base_from_element_at_zero.linear() = railAxes(spec);
  element.free = {1, 2, 4, 5};
  if (beam.torsion) element.free = {1, 2, 3, 4, 5};
  element.stiffness = railStiffness(beam, 0.5 * (beam.from + beam.to));
  return element;
}

std::vector<ElasticElement> elasticElements(const SimulationSpec& spec, const PerJoint<JointStiffness>& joints) {
  std::vector<ElasticElement> elements;
  if (spec.nominal.rail && spec.rail.beam) elements.push_back(railElement(spec));
  if (spec.machine.base_rotation || spec.machine.base_translation) {
    ElasticElement base;
    base.name = kBaseElement;
    if (spec.machine.base_translation) {
      base.free = {0, 1, 2};
      base.stiffness.diagonal().head<3>() = *spec.machine.base_translation;
    }
    if (spec.machine.base_rotation) {
      base.free.insert(base.free.end(), {3, 4, 5});
      base.stiffness.diagonal().tail<3>() = *spec.machine.base_rotation;
    }
    elements.push_back(base);
  }
  for (int axis = 0; axis < spec.nominal.axes(); ++axis) {
    const int i = spec.nominal.axes_in_base_at_zero.jointOf(axis);
    if (i < 0) continue;  // follows others without a spring of its own
    ElasticElement joint = jointElement(spec.nominal, i, joints[static_cast<std::size_t>(i)]);
    if (!joint.free.empty()) elements.push_back(std::move(joint));
    for (const LinkBeam& beam : spec.machine.links) {
      if (beam.joint == i) elements.push_back(linkElement(spec, beam));
    }
  }
  if (spec.machine.tool_plate) elements.push_back(plateElement(spec.nominal, *spec.machine.tool_plate));
  return elements;
}

}  // namespace

int ElasticMachine::coordinateCount() const {
  std::size_t count = 0;
  for (const auto& element : elements) count += element.free.size();
  return static_cast<int>(count);
}

Eigen::Index ElasticMachine::sliderCount() const {
  std::size_t count = 0;
  for (const auto& one : curves) count += one.curve.sliders.size();
  return static_cast<Eigen::Index>(count);
}

ElasticMachine buildMachine(const SimulationSpec& spec) {
  using namespace simulation;
  ElasticMachine machine;
  machine.nominal = spec.nominal;
  machine.truth = spec.machine;
  machine.truth.joints.resize(static_cast<std::size_t>(spec.nominal.joints()));
  machine.tool = spec.machine.tool;
  machine.targets = spec.targets;
  machine.temperature = spec.temperature;
  if (spec.nominal.rail) machine.rail_beam = spec.rail.beam;
  machine.elements = elasticElements(spec, machine.truth.joints);
  addCurves(machine);

  for (const AxisError& error : drawAxisErrors(spec)) {
    const int axis = static_cast<int>(machine.zeros.size());
    machine.axis_errors.push_back(frameError(spec.nominal, axis, error));
    machine.zeros.push_back(error.zero);
  }

  numerics::RandomStream random(spec.seed, "masses");
  machine.bodies = spec.nominal.bodies;
  for (robot::BodyMass& body : machine.bodies) {
    body.mass_kg *= std::max(0.0, 1.0 + spec.machine.mass_relative_sigma * random.normal());
  }

  const Eigen::Vector3d tilt_axis(std::cos(spec.machine.base_tilt_azimuth), std::sin(spec.machine.base_tilt_azimuth),
                                  0.0);
  // base_link turned by +tilt in the world sees gravity turned by -tilt.
  machine.gravity_in_base =
      rotationExp(-spec.machine.base_tilt * tilt_axis) * Eigen::Vector3d(0.0, 0.0, -kStandardGravity);
  return machine;
}

void ElasticMachine::carryTo(double position) {
  if (!rail_beam) return;
  for (ElasticElement& element : elements) {
    if (element.name == kRailElement) element.stiffness = railStiffness(*rail_beam, position);
  }
}

void ElasticMachine::turnMotor(int joint, double angle) {
  const auto& axes = nominal.axes_in_base_at_zero;
  if (!axes.couplings) {
    zeros[static_cast<std::size_t>(joint)] += angle;
    return;
  }
  for (int axis = 0; axis < nominal.axes(); ++axis)
    zeros[static_cast<std::size_t>(axis)] += axes.couplings->turns(axis, joint) * angle;
}

robot::Robot rigidGeometry(const ElasticMachine& machine) {
  using namespace simulation;
  robot::Robot robot = machine.nominal;
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();  // nominal place at zero -> true place, for body i
  for (std::size_t i = 0; i < machine.zeros.size(); ++i) {
    moved = moved * machine.axis_errors[i];
    const metrology::Line& nominal = machine.nominal.axes_in_base_at_zero[i];
    robot.axes_in_base_at_zero[i] = {moved * nominal.point, moved.linear() * nominal.direction};
    moved = moved * turnAbout(nominal, machine.zeros[i]);
    robot.bodies[i + 1] = {machine.bodies[i + 1].mass_kg, moved * machine.bodies[i + 1].com_in_base_at_zero};
    for (robot::LinkFrame& link : robot.links) {
      if (link.body == static_cast<int>(i) + 1) link.base_from_link_at_zero = moved * link.base_from_link_at_zero;
    }
  }
  robot.base_from_flange_at_zero = moved * robot.base_from_flange_at_zero;
  return robot;
}

TorqueCurve jointCurve(const JointStiffness& joint) {
  TorqueCurve curve;
  curve.cubic = joint.cubic;
  if (joint.stages || joint.backlash) {
    curve.positive = joint.stages ? stagesByTorque(joint.stages->torques, joint.stages->rates)
                                  : std::vector{TorqueCurve::Stage{*joint.torsion}};
    if (joint.backlash) {
      const double half = 0.5 * joint.backlash->width;
      const double rate = joint.backlash->rest * curve.positive.front().rate;
      for (TorqueCurve::Stage& stage : curve.positive) stage.until += half;
      curve.positive.insert(curve.positive.begin(), {rate, half});
    }
    curve.negative = curve.positive;
  }
  if (joint.friction) {
    const int count = joint.friction->sliders;
    for (int s = 1; s <= count; ++s) {
      curve.sliders.push_back(
          {joint.friction->rate / count, joint.friction->torque * 2.0 * s / (count * (count + 1.0))});
    }
  }
  return curve;
}

TorqueCurve contactCurve(const OneSidedContact& contact) {
  TorqueCurve curve;
  (contact.positive ? curve.positive : curve.negative) = {{0.0, contact.gap}, {contact.stiffness}};
  return curve;
}

namespace {

/// At a twist of size `size` >= 0 on one side.
CurvePoint alongStages(const std::vector<TorqueCurve::Stage>& stages, double size) {
  CurvePoint at;
  double from = 0.0;
  for (const TorqueCurve::Stage& stage : stages) {
    const double part = std::min(size, stage.until) - from;
    at.energy += at.torque * part + 0.5 * stage.rate * part * part;
    at.torque += stage.rate * part;
    at.rate = stage.rate;
    if (size <= stage.until) break;
    from = stage.until;
  }
  return at;
}

}  // namespace

CurvePoint evaluate(const TorqueCurve& curve, double twist, const double* anchors) {
  const bool up = twist >= 0.0;
  CurvePoint at = alongStages(up ? curve.positive : curve.negative, std::abs(twist));
  if (!up) at.torque = -at.torque;

  const double square = twist * twist;
  at.energy += 0.25 * curve.cubic * square * square;
  at.torque += curve.cubic * square * twist;
  at.rate += 3.0 * curve.cubic * square;

  if (anchors == nullptr) return at;
  for (std::size_t s = 0; s < curve.sliders.size(); ++s) {
    const Slider& slider = curve.sliders[s];
    const double stretch = twist - anchors[s], most = slider.limit / slider.rate;
    if (std::abs(stretch) <= most) {
      at.energy += 0.5 * slider.rate * stretch * stretch;
      at.torque += slider.rate * stretch;
      at.rate += slider.rate;
    } else {
      at.energy += slider.limit * (std::abs(stretch) - 0.5 * most);
      at.torque += std::copysign(slider.limit, stretch);
    }
  }
  return at;
}

void slip(const TorqueCurve& curve, double twist, double* anchors) {
  for (std::size_t s = 0; s < curve.sliders.size(); ++s) {
    const double most = curve.sliders[s].limit / curve.sliders[s].rate;
    anchors[s] = std::clamp(anchors[s], twist - most, twist + most);
  }
}

std::vector<TorqueCurve::Stage> stagesByTorque(const std::vector<double>& torques, const std::vector<double>& rates) {
  std::vector<TorqueCurve::Stage> stages;
  double torque = 0.0, twist = 0.0;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    TorqueCurve::Stage stage{rates[k]};
    if (k < torques.size()) {
      twist += (torques[k] - torque) / rates[k];
      torque = torques[k];
      stage.until = twist;
    }
    stages.push_back(stage);
  }
  return stages;
}

}  // namespace stiffscope::simulation
