#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/robot/robot.h"
#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// The errors of the axes: as listed for the joint whose own axis it is, else drawn from stream "geometry" of the seed.
/// A listed axis leaves the others' draws as they were.
PerJoint<AxisError> drawAxisErrors(const SimulationSpec& spec);

/// E_i: where axis i and all that it carries truly stands at zero, from where the nominal robot has it
/// (base_link): first turned by the tilt about the axis's point - about the wrist centre for the wrist's axes
/// (4-6 of six) if these meet within 1 um - then moved by the offset. So the errors add up along the chain, the flange
/// stays true to the last axis, and wrist axes miss each other only by their own offsets but the first one's.
Eigen::Isometry3d frameError(const robot::Robot& nominal, int axis, const AxisError& error);

/// A Jenkins element: a spring of `rate` (Nm/rad) in series with a slider that holds up to `limit` (Nm) and
/// then slips. C. F. Beards, Damping in Structural Joints (1992); several in parallel are Iwan's model of
/// hysteresis (J. Appl. Mech. 33, 1966).
struct Slider {
  double rate = 0.0, limit = 0.0;
};

/// What acts on one elastic coordinate besides its linear spring: torque (Nm) against twist t (rad), or force
/// (N) against displacement (m). All parts add:
///   stages    piecewise linear through the origin; rate of the first stage up to its `until`, then the next
///             one's, for positive and negative twists apart. A catalogue's K1, K2, K3, a gap, a one-sided
///             contact.
///   cubic     cubic * t^3
///   sliders   clamp(rate (t - anchor), +-limit) each, `anchor` where its spring is unstrained now
/// Its energy's derivative is the torque, and that one's the rate, everywhere but at the corners.
struct TorqueCurve {
  struct Stage {
    double rate = 0.0;
    double until = std::numeric_limits<double>::infinity();  ///< |twist| where the next one begins
  };
  std::vector<Stage> positive, negative;  ///< until rising; empty: no torque on that side
  double cubic = 0.0;
  std::vector<Slider> sliders;

  bool acts() const { return !positive.empty() || !negative.empty() || cubic != 0.0 || !sliders.empty(); }
};

struct CurvePoint {
  double energy = 0.0;  ///< J, from twist 0 and, for sliders, from their anchors
  double torque = 0.0;  ///< dE/dt
  double rate = 0.0;    ///< d torque / dt
};

/// `anchors`: one a slider; null: sliders carry nothing.
CurvePoint evaluate(const TorqueCurve& curve, double twist, const double* anchors);

/// Lets the sliders slip that carry more than their limit at this twist.
void slip(const TorqueCurve& curve, double twist, double* anchors);

/// The stages of an odd curve given by the torques (Nm, rising) where the rate changes: rates.size() is one
/// more than torques.size().
std::vector<TorqueCurve::Stage> stagesByTorque(const std::vector<double>& torques, const std::vector<double>& rates);

/// A place where the machine deflects: up to three translations u (m) and a rotation vector r (rad) of what lies
/// beyond it, both in the element's frame as it was before deflecting: x -> Exp(r) x + u. Its strain energy is
/// 1/2 d' K d, d = (u, r).
struct ElasticElement {
  std::string name;
  int axis = -1;  ///< beyond the turn of this axis, from 0; -1: the rail, then the base; axes(): the tool's plate
  bool is_link = false;  ///< a beam's tip: follows the axis's own element and the mass of the body
  Eigen::Isometry3d base_from_element_at_zero = Eigen::Isometry3d::Identity();  ///< z along the axis or beam
  std::vector<int> free;  ///< which of (ux uy uz rx ry rz) can move
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();  ///< K; rows not free play no part
};

inline constexpr const char* kRailElement = "rail";
inline constexpr const char* kBaseElement = "base";

/// A torque curve of one elastic coordinate, besides what K gives it.
struct CoordinateCurve {
  Eigen::Index coordinate = 0;
  int joint = -1;  ///< whose torsion it is; -1: the base's
  TorqueCurve curve;
};

/// The machine as it truly is. Everything stands where the nominal robot has it in base_link at all joints
/// zero; a body's place follows from the chain rail element, base element, then per axis i: frame error E_i, motor turn
/// about axis i by zero_i + theta_i, joint element, [mass of body i], link element; last the tool's plate. theta are
/// the axes' angles at joint angles q (q itself but for coupled joints); a drive's torsion turns the joint's own axis
/// in its element, and what else the joint turns with the motor's turn there. base_link here is the ground's: the
/// tracker and the nests stand on it, and it does not move with the pedestal.
struct ElasticMachine {
  robot::Robot nominal;
  PerJoint<Eigen::Isometry3d> axis_errors;  ///< E_i of each axis, in base_link at zero, nominal place to true place
  PerJoint<double> zeros;                   ///< of each axis, rad
  std::vector<ElasticElement> elements;     ///< in chain order
  PerBody<robot::BodyMass> bodies;          ///< true masses, at nominal places; the last without the tool
  robot::Tool tool;
  Eigen::Vector3d gravity_in_base{0.0, 0.0, -9.80665};  ///< the true one
  std::vector<TrueTarget> targets;
  MachineSpec truth;  ///< what it was built from, with all joints: the true stiffness values are here
  std::optional<TemperatureCourse> temperature;  ///< of the day
  std::optional<RailBeam> rail_beam;             ///< of an arm on a rail that bends
  PerJoint<Eigen::Index> torsion_coordinates;    ///< of each joint; -1: rigid
  std::vector<CoordinateCurve> curves;

  int joints() const { return nominal.joints(); }
  int axes() const { return nominal.axes(); }
  /// Turns a joint's motor by an angle besides what is reported, rad, and all axes that it turns with it.
  void turnMotor(int joint, double angle);
  /// The rail's stiffness becomes that with the carriage at this position, m.
  void carryTo(double position);
  int coordinateCount() const;       ///< elastic coordinates in all
  Eigen::Index sliderCount() const;  ///< of all curves
  bool changes() const;              ///< with posture, time or carriage: see machineAt and carryTo
};

/// The machine at a posture and a time of the day (s): thermal growth, warming drives, ripple of stiffness and all that
/// turns a motor away from the angle reported put in, so that what is left does not change. The carriage stays.
ElasticMachine machineAt(const ElasticMachine& machine, const JointVector& q, double time_s);

/// Builds the machine of a specification, drawing what it leaves to chance from its seed (streams "geometry",
/// "masses"). Throws InputError where a link beam would have no length.
ElasticMachine buildMachine(const SimulationSpec& spec);

/// The true rigid geometry in zero-reference form, motor zeros inside the axes: what a perfect calibration of
/// a machine without compliance would find.
robot::Robot rigidGeometry(const ElasticMachine& machine);

}  // namespace stiffscope::simulation
