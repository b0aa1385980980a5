#pragma once

#include <Eigen/Core>

namespace stiffscope {

/// One number a joint; or a wrench or twist: three and three.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
/// Displacement of a point by six joints.
using Matrix36d = Eigen::Matrix<double, 3, 6>;

}  // namespace stiffscope
