#include "core/compensation/joint_correction.h"

#include <Eigen/Dense>
#include <algorithm>

#include "core/robot/inverse_kinematics.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::compensation {

namespace {

JointVector leastTotalStep(const Jacobian& jacobian, const Vector6d& motion, const JointVector& so_far) {
  const SmallMatrix squared = jacobian * jacobian.transpose();
  const SmallVector whole = motion + jacobian * so_far;
  return jacobian.transpose() * solvePositive(squared, whole) - so_far;
}

JointVector positionFirstStep(const Jacobian& jacobian, const Vector6d& motion) {
  const PointJacobian shifts = jacobian.topRows<3>(), turns = jacobian.bottomRows<3>();
  const Eigen::Matrix3d squared = shifts * shifts.transpose();
  const Eigen::Matrix3d inverse = squared.inverse();  // of a singular one not finite
  const JointVector placed = shifts.transpose() * (inverse * motion.head<3>());
  JointMatrix free = JointMatrix::Identity(jacobian.cols(), jacobian.cols());
  free -= shifts.transpose() * inverse * shifts;
  const Eigen::Vector3d left = motion.tail<3>() - turns * placed;
  constexpr double kRounding = 1e-6;  // what the position takes of the freedom is none
  const JointVector turned = leastSquaresSolution(turns * free, left, kRounding);
  return placed + free * turned;
}

}  // namespace

JointVector jointStep(const Jacobian& jacobian, const Vector6d& motion, const JointVector& so_far) {
  if (jacobian.cols() == 6) return solveLu(SmallMatrix(jacobian), SmallVector(motion));
  return jacobian.cols() > 6 ? leastTotalStep(jacobian, motion, so_far) : positionFirstStep(jacobian, motion);
}

double stepConditioning(const robot::ArmAxes& axes, const Eigen::Vector3d& point_in_base) {
  const double whole = robot::conditioningAt(axes, point_in_base);
  if (axes.joints() >= 6) return whole;
  const Eigen::VectorXd singular = singularValues(robot::pointJacobianAt(axes, point_in_base));
  return std::min(whole, singular[2] / singular[0]);
}

}  // namespace stiffscope::compensation
