#pragma once

#include <Eigen/Geometry>
#include <boost/container/static_vector.hpp>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "metrology/lines.h"

namespace stiffscope {

/// A wrench or a twist: three and three. Not one number a joint: that is a JointVector.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Machines have from four to eight joints, and no more axes than that.
inline constexpr int kFewestJoints = 4, kMostJoints = 8;

/// One number a joint. As many as the machine has joints; kept in place, without allocation.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostJoints, 1>;
/// One number a pair of joints.
using JointMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostJoints, kMostJoints>;
/// Displacement (rows 0-2) and rotation (rows 3-5) by joint.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMostJoints>;
/// Displacement of a point by joint.
using PointJacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kMostJoints>;

/// Rows by joint, such as displacements of several points, stacked.
using JointRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, Eigen::Dynamic, kMostJoints>;

/// One thing a joint, [0] for the one at the base, kept in place.
template <class T>
using PerJoint = boost::container::static_vector<T, kMostJoints>;
/// One thing a body: [0] the base, [i] what joint i (1..) moves.
template <class T>
using PerBody = boost::container::static_vector<T, kMostJoints + 1>;

}  // namespace stiffscope

namespace stiffscope::robot {

/// Mass of one moving body with everything fixed to it, and where its centre of mass stands in base_link
/// when all joints are at zero (m). A mass of 0 means: not known.
struct BodyMass {
  double mass_kg = 0.0;
  Eigen::Vector3d com_in_base_at_zero = Eigen::Vector3d::Zero();
};

/// A named frame rigidly fixed to one body of the chain.
struct LinkFrame {
  std::string name;
  int body = 0;  ///< 0: the base; i: the body moved by joints 1..i
  Eigen::Isometry3d base_from_link_at_zero = Eigen::Isometry3d::Identity();
};

struct JointLimits {
  double lower = 0.0;  ///< rad; -infinity for a continuous joint
  double upper = 0.0;  ///< rad
};

/// A linear axis below the arm (a URDF's prismatic joint before all others): the arm stands on a carriage. Everything
/// else of a Robot is stated with the carriage at zero.
struct Rail {
  std::string joint_name;
  Eigen::Vector3d direction_in_base = Eigen::Vector3d::UnitX();  ///< unit; in which the position grows
  double lower = 0.0, upper = 0.0;                               ///< limits of the position, m
};

/// A coil spring by its maker's data: `tension_n` at `length_m`, and `rate_n_per_m` more by length. Pulls its ends
/// together where the tension is positive.
struct SpringLaw {
  double rate_n_per_m = 0.0, tension_n = 0.0, length_m = 0.0;
};

/// A gas cylinder: gauge pressure and gas volume at `length_m`, p V^exponent constant with p absolute (1: the gas keeps
/// its temperature, as it does at rest). `pushes`: its volume grows with its length, else it shrinks and it pulls.
struct GasLaw {
  double pressure_pa = 0.0, area_m2 = 0.0, volume_m3 = 0.0, length_m = 0.0, exponent = 1.0;
  bool pushes = false;
};

/// A point of a body, where it stands in the base frame with all joints at zero.
struct BalancerEnd {
  int body = 0;
  Eigen::Vector3d in_base_at_zero = Eigen::Vector3d::Zero();
};

/// A spring or a gas cylinder between two bodies of the arm, that carries some of its weight (core/robot/balancer.h).
struct Balancer {
  std::variant<SpringLaw, GasLaw> law;
  BalancerEnd from, to;
  std::optional<double> shortest_m, longest_m;  ///< its stroke
};

/// Joints at the end of the arm whose axes meet in the wrist centre, where the machine has one: three, of four and five
/// joints two. The joints before them, the arm's, carry the wrist centre.
constexpr int wristJointsOf(int joints) { return joints >= 6 ? 3 : 2; }
constexpr int armJointsOf(int joints) { return joints - wristJointsOf(joints); }

/// How joints turn axes where a joint turns more than its own (a parallelogram's rods, `mimic` in a URDF): axis angles
/// theta = turns * q. What a joint's drive holds is its own angle, so that springs, torques and compliances are the
/// joints': delta x = J turns C turns^T J^T W, J by axis.
struct Couplings {
  JointMatrix turns;        ///< rows: axes, columns: joints; 1 where a joint turns its own axis
  PerJoint<int> own_axis;   ///< of each joint, from 0
  PerJoint<int> own_joint;  ///< of each axis, from 0; -1: the axis follows joints and has none of its own

  JointVector angles(const JointVector& q) const;
  JointVector torques(const JointVector& by_axis) const;
};

/// Axes of an arm in its base frame, all at zero or all at one posture, from the base outwards, and the joints that
/// turn them. Most arms turn each axis by a joint of its own.
class ArmAxes : public PerJoint<metrology::Line> {
 public:
  using PerJoint<metrology::Line>::PerJoint;

  std::shared_ptr<const Couplings> couplings;  ///< null: joint i turns axis i alone

  int joints() const { return couplings ? static_cast<int>(couplings->turns.cols()) : static_cast<int>(size()); }

  /// Angles of the axes at joint angles q, rad.
  JointVector angles(const JointVector& q) const { return couplings ? couplings->angles(q) : q; }
  /// Torques that joints hold, by the torques about the axes, Nm.
  JointVector torques(const JointVector& by_axis) const { return couplings ? couplings->torques(by_axis) : by_axis; }
  /// The axis that carries the name and the drive of a joint, from 0.
  int axisOf(int joint) const { return couplings ? couplings->own_axis[static_cast<std::size_t>(joint)] : joint; }
  /// The joint that has this axis for its own, from 0; -1 where the axis only follows.
  int jointOf(int axis) const { return couplings ? couplings->own_joint[static_cast<std::size_t>(axis)] : axis; }
  /// The axes before the wrist's, which are as many as wristJointsOf: they carry the wrist centre.
  int armAxes() const { return static_cast<int>(size()) - wristJointsOf(joints()); }
  /// Whether a joint turns its own axis and no other: its sweep then shows that axis.
  bool turnsAlone(int joint) const;
};

/// A serial arm of four to eight revolute joints in zero-reference (product of exponentials) form: where each axis,
/// each link frame and each mass stands in base_link when all reported joint angles are zero. An axis i at angle
/// theta_i, which is its joint's q_i where joints are not coupled (Couplings), turns everything beyond it about
/// `axes_in_base_at_zero[i]` by theta_i (right-hand rule), innermost axis last:
/// base_from_link(q) = exp(xi_1 theta_1) ... exp(xi_b theta_b) base_from_link_at_zero, b the link's body. Joint-zero
/// errors are inside the axes, so this form has no offsets. SI and radians.
struct Robot {
  std::string name;
  PerJoint<std::string> joint_names;
  PerJoint<std::string> axis_names;  ///< of the URDF's joints, those that follow others among them
  ArmAxes axes_in_base_at_zero;
  PerJoint<JointLimits> limits;       ///< of the joints
  PerJoint<JointLimits> axis_limits;  ///< of all axes
  Eigen::Isometry3d base_from_flange_at_zero = Eigen::Isometry3d::Identity();
  PerBody<BodyMass> bodies;      ///< [0] the base (its mass plays no part), [i] the body beyond axis i
  std::vector<LinkFrame> links;  ///< every link on the chain, and every link rigidly fixed to one of those
  std::optional<Rail> rail;      ///< of an arm on a linear axis
  std::vector<Balancer> balancers;

  // Copied and moved by functions of kinematics.cpp, which is compiled once and not wherever somebody holds a robot.
  Robot();
  Robot(const Robot&);
  Robot(Robot&&) noexcept;
  Robot& operator=(const Robot&);
  Robot& operator=(Robot&&) noexcept;
  ~Robot();

  int joints() const { return axes_in_base_at_zero.joints(); }                ///< that have angles and springs
  int axes() const { return static_cast<int>(axes_in_base_at_zero.size()); }  ///< as many as moving bodies
  bool coupled() const { return axes_in_base_at_zero.couplings != nullptr; }

  int armAxes() const { return axes_in_base_at_zero.armAxes(); }
  /// Whether the wrist's joints turn none of the arm's axes, so that P_wrist sees the arm's joints alone. Not so where
  /// rods of a palletiser keep its flange level.
  bool wristStandsApart() const;
};

/// Whether all axes are within their limits at joint angles q, also those that follow joints, and all balancers within
/// their strokes.
bool withinAxisLimits(const Robot& robot, const JointVector& q);

/// Which joints' compliances are unknowns; the others' columns are left out (their compliance taken as 0).
using JointMask = PerJoint<bool>;

}  // namespace stiffscope::robot
