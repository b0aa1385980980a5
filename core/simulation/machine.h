#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "core/robot/robot.h"
#include "core/simulation/spec.h"
#include "core/simulation/torque_curve.h"

namespace stiffscope {

namespace simulation {

/// A place where the machine gives: up to three translations u (m) and a rotation vector r (rad) of what lies
/// beyond it, both in the element's frame as it was before giving: x -> Exp(r) x + u. Its strain energy is
/// 1/2 d' K d, d = (u, r).
struct ElasticElement {
  std::string name;
  int joint = -1;        ///< follows the motor of this joint (0..5); -1: the base; 6: the tool's plate
  bool is_link = false;  ///< a beam's tip: follows the joint's own element and the mass of the body
  Eigen::Isometry3d base_from_element_at_zero = Eigen::Isometry3d::Identity();  ///< z along the axis or beam
  std::vector<int> free;  ///< which of (ux uy uz rx ry rz) can move
  Eigen::Matrix<double, 6, 6> stiffness =
      Eigen::Matrix<double, 6, 6>::Zero();  ///< K; rows not free play no part
};

/// A torque curve of one elastic coordinate, besides what K gives it.
struct CoordinateCurve {
  Eigen::Index coordinate = 0;
  int joint = -1;  ///< whose torsion it is; -1: the base's
  TorqueCurve curve;
};

}  // namespace simulation

/// The machine as it truly is. Everything stands where the nominal robot has it in base_link at all joints
/// zero; a body's place follows from the chain base element, then per joint i: frame error E_i, motor turn
/// about axis i by zero_i + q_i, joint element, [mass of body i], link element; last the tool's plate.
/// base_link here is the ground's: the tracker and the nests stand on it, and it does not move with the
/// pedestal.
struct ElasticMachine {
  Robot nominal;
  std::array<Eigen::Isometry3d, 6> axis_errors;  ///< E_i, in base_link at zero, nominal place to true place
  std::array<double, 6> zeros{};                 ///< rad
  std::vector<simulation::ElasticElement> elements;  ///< in chain order
  std::array<BodyMass, 7> bodies;                    ///< true masses, at nominal places; [6] without the tool
  Tool tool;
  Eigen::Vector3d gravity_in_base{0.0, 0.0, -9.80665};  ///< the true one
  std::vector<simulation::TrueTarget> targets;
  simulation::MachineSpec truth;  ///< what it was built from: the true stiffness values are here
  std::array<Eigen::Index, 6> torsion_coordinates{-1, -1, -1, -1, -1, -1};  ///< of each joint; -1: rigid
  std::vector<simulation::CoordinateCurve> curves;

  int coordinateCount() const;       ///< elastic coordinates in all
  Eigen::Index sliderCount() const;  ///< of all curves
  bool changes() const;              ///< with posture or time: see machineAt
};

/// The machine at a posture and a time of the day (s): thermal growth, warming drives, ripple of stiffness
/// and of the motor's angle put in, so that what is left does not change.
ElasticMachine machineAt(const ElasticMachine& machine, const Vector6d& q, double time_s);

/// Builds the machine of a specification, drawing what it leaves to chance from its seed (streams "geometry",
/// "masses"). Throws InputError where a link beam would have no length.
ElasticMachine buildMachine(const SimulationSpec& spec);

/// The true rigid geometry in zero-reference form, motor zeros inside the axes: what a perfect calibration of
/// a machine without compliance would find.
Robot rigidGeometry(const ElasticMachine& machine);

}  // namespace stiffscope
