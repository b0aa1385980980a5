#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "metrology/lines.h"

namespace stiffscope {

/// One number a joint; or a wrench or twist: three and three.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
/// Displacement of a point by six joints.
using Matrix36d = Eigen::Matrix<double, 3, 6>;

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

/// A six-revolute-joint serial arm in zero-reference (product of exponentials) form: where each axis, each
/// link frame and each mass stands in base_link when all reported joint angles are zero. A joint i at angle
/// q_i turns everything beyond it about `axes_in_base_at_zero[i]` by q_i (right-hand rule), innermost joint
/// last: base_from_link(q) = exp(xi_1 q_1) ... exp(xi_b q_b) base_from_link_at_zero, b the link's body.
/// Joint-zero errors are inside the axes, so this form has no offsets. SI and radians.
struct Robot {
  std::string name;
  std::array<std::string, 6> joint_names;
  std::array<metrology::Line, 6> axes_in_base_at_zero;
  std::array<JointLimits, 6> limits;
  Eigen::Isometry3d base_from_flange_at_zero = Eigen::Isometry3d::Identity();
  std::array<BodyMass, 7> bodies;  ///< [0] the base (its mass plays no part), [i] the body beyond joint i
  std::vector<LinkFrame> links;    ///< every link on the chain, and every link rigidly fixed to one of those
};

/// Which joints' compliances are unknowns; the others' columns are left out (their compliance taken as 0).
using JointMask = std::array<bool, 6>;

}  // namespace stiffscope::robot
