#include <algorithm>
#include <cmath>

#include "core/input/input_error.h"
#include "core/simulation/axis_errors.h"
#include "core/simulation/beam.h"
#include "core/simulation/element_curves.h"
#include "core/simulation/machine.h"
#include "core/simulation/random.h"
#include "core/simulation/rotation.h"

namespace stiffscope {

namespace simulation {

namespace {

constexpr double kStandardGravity = 9.80665;  ///< m/s^2

ElasticElement jointElement(const Robot& robot, int joint, const JointStiffness& stiffness) {
  ElasticElement element;
  element.name = robot.joint_names[joint];
  element.joint = joint;
  const Line& axis = robot.axes_in_base_at_zero[joint];
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

ElasticElement plateElement(const Robot& robot, const ToolPlate& plate) {
  ElasticElement element;
  element.name = "tool plate";
  element.joint = 6;
  element.base_from_element_at_zero = robot.base_from_flange_at_zero;
  element.free = {0, 1, 2, 3, 4, 5};
  element.stiffness.diagonal() << plate.translation, plate.rotation;
  return element;
}

/// Torsion coordinates, and the curves of joints and base.
void addCurves(const MachineSpec& spec, ElasticMachine& machine) {
  Eigen::Index at = 0;
  for (const ElasticElement& element : machine.elements) {
    const auto torsion = std::find(element.free.begin(), element.free.end(), 5);
    if (element.joint >= 0 && element.joint < 6 && !element.is_link && torsion != element.free.end()) {
      const std::size_t joint = static_cast<std::size_t>(element.joint);
      machine.torsion_coordinates[joint] = at + (torsion - element.free.begin());
      TorqueCurve curve = jointCurve(spec.joints[joint]);
      if (curve.acts()) {
        machine.curves.push_back({machine.torsion_coordinates[joint], element.joint, std::move(curve)});
      }
    }
    if (element.joint == -1) {
      for (const OneSidedContact& contact : spec.base_contacts) {
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
  const Robot& robot = spec.nominal;
  const Eigen::Vector3d root = robot.axes_in_base_at_zero[beam.joint].point;
  const Eigen::Vector3d tip = beam.joint == 5 ? Eigen::Vector3d(robot.base_from_flange_at_zero.translation())
                                              : robot.axes_in_base_at_zero[beam.joint + 1].point;
  const double length = (tip - root).norm();
  if (length < 1e-3) {
    throw InputError({spec.file.string(), 0, "after_joint"}, std::to_string(beam.joint + 1),
                     "expected a joint whose point and the next one's are at least 1 mm apart in the URDF");
  }
  ElasticElement element;
  element.name = "link " + std::to_string(beam.joint + 1);
  element.joint = beam.joint;
  element.is_link = true;
  element.base_from_element_at_zero = frameAlong(tip, tip - root);
  if (beam.bending) element.free = {0, 1, 3, 4};
  if (beam.axial) element.free.push_back(2);
  if (beam.torsion) element.free.push_back(5);
  element.stiffness = beamTipStiffness(beam, length);
  return element;
}

std::vector<ElasticElement> elasticElements(const SimulationSpec& spec) {
  std::vector<ElasticElement> elements;
  if (spec.machine.base_rotation || spec.machine.base_translation) {
    ElasticElement base;
    base.name = "base";
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
  for (int i = 0; i < 6; ++i) {
    ElasticElement joint = jointElement(spec.nominal, i, spec.machine.joints[i]);
    if (!joint.free.empty()) elements.push_back(std::move(joint));
    for (const LinkBeam& beam : spec.machine.links) {
      if (beam.joint == i) elements.push_back(linkElement(spec, beam));
    }
  }
  if (spec.machine.tool_plate) elements.push_back(plateElement(spec.nominal, *spec.machine.tool_plate));
  return elements;
}

}  // namespace

}  // namespace simulation

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
  machine.tool = spec.machine.tool;
  machine.targets = spec.targets;
  machine.elements = elasticElements(spec);
  addCurves(spec.machine, machine);

  const std::array<AxisError, 6> errors = drawAxisErrors(spec);
  for (int i = 0; i < 6; ++i) {
    machine.axis_errors[i] = frameError(spec.nominal, i, errors[i]);
    machine.zeros[i] = errors[i].zero;
  }

  RandomStream random(spec.seed, "masses");
  machine.bodies = spec.nominal.bodies;
  for (BodyMass& body : machine.bodies) {
    body.mass_kg *= std::max(0.0, 1.0 + spec.machine.mass_relative_sigma * random.normal());
  }

  const Eigen::Vector3d tilt_axis(std::cos(spec.machine.base_tilt_azimuth),
                                  std::sin(spec.machine.base_tilt_azimuth), 0.0);
  // base_link turned by +tilt in the world sees gravity turned by -tilt.
  machine.gravity_in_base =
      rotationExp(-spec.machine.base_tilt * tilt_axis) * Eigen::Vector3d(0.0, 0.0, -kStandardGravity);
  return machine;
}

Robot rigidGeometry(const ElasticMachine& machine) {
  using namespace simulation;
  Robot robot = machine.nominal;
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();  // nominal place at zero -> true place, for body i
  for (int i = 0; i < 6; ++i) {
    moved = moved * machine.axis_errors[i];
    const Line& nominal = machine.nominal.axes_in_base_at_zero[i];
    robot.axes_in_base_at_zero[i] = {moved * nominal.point, moved.linear() * nominal.direction};
    moved = moved * turnAbout(nominal, machine.zeros[i]);
    robot.bodies[i + 1] = {machine.bodies[i + 1].mass_kg, moved * machine.bodies[i + 1].com_in_base_at_zero};
    for (LinkFrame& link : robot.links) {
      if (link.body == i + 1) link.base_from_link_at_zero = moved * link.base_from_link_at_zero;
    }
  }
  robot.base_from_flange_at_zero = moved * robot.base_from_flange_at_zero;
  return robot;
}

}  // namespace stiffscope
