#pragma once

#include <Eigen/Geometry>
#include <boost/container/static_vector.hpp>
#include <string>
#include <vector>

#include "metrology/lines.h"

namespace stiffscope {

/// A wrench or a twist: three and three. Not one number a joint: that is a JointVector.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Machines have from four to eight joints, a rail among them.
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

/// A serial arm of four to eight revolute joints in zero-reference (product of exponentials) form: where each axis,
/// each link frame and each mass stands in base_link when all reported joint angles are zero. A joint i at angle q_i
/// turns everything beyond it about `axes_in_base_at_zero[i]` by q_i (right-hand rule), innermost joint last:
/// base_from_link(q) = exp(xi_1 q_1) ... exp(xi_b q_b) base_from_link_at_zero, b the link's body. Joint-zero errors are
/// inside the axes, so this form has no offsets. SI and radians.
struct Robot {
  std::string name;
  PerJoint<std::string> joint_names;
  PerJoint<metrology::Line> axes_in_base_at_zero;
  PerJoint<JointLimits> limits;
  Eigen::Isometry3d base_from_flange_at_zero = Eigen::Isometry3d::Identity();
  PerBody<BodyMass> bodies;      ///< [0] the base (its mass plays no part), [i] the body beyond joint i
  std::vector<LinkFrame> links;  ///< every link on the chain, and every link rigidly fixed to one of those

  int joints() const { return static_cast<int>(axes_in_base_at_zero.size()); }
};

/// Joints at the end of the arm whose axes meet in the wrist centre, where the machine has one: three, of four and five
/// joints two. The joints before them, the arm's, carry the wrist centre.
constexpr int wristJointsOf(int joints) { return joints >= 6 ? 3 : 2; }
constexpr int armJointsOf(int joints) { return joints - wristJointsOf(joints); }

/// Which joints' compliances are unknowns; the others' columns are left out (their compliance taken as 0).
using JointMask = PerJoint<bool>;

}  // namespace stiffscope::robot
