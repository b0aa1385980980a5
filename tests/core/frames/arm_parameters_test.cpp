#include "core/frames/arm_parameters.h"

#include <gtest/gtest.h>

#include "tests/fixtures/chain_arm.h"

// Positions against a product of exponentials summed up here as power series; their derivatives against differences of
// that product, and of the forward kinematics of a geometry moved by steps.

namespace stiffscope {
namespace arm_parameters_test {

using frames::ArmParameters;

constexpr std::size_t kTargets = 2;

/// exp of a screw (rotation vector, shift of the origin) by its series; arguments here are below 3.
Eigen::Matrix4d exponential(const Eigen::Vector3d& rotation, const Eigen::Vector3d& shift) {
  Eigen::Matrix4d screw = Eigen::Matrix4d::Zero();
  for (int k = 0; k < 3; ++k) screw.col(k).head<3>() = rotation.cross(Eigen::Vector3d::Unit(k));
  screw.col(3).head<3>() = shift;
  Eigen::Matrix4d sum = Eigen::Matrix4d::Identity(), term = sum;
  for (int n = 1; n < 40; ++n) sum += term = (term * screw / n).eval();
  return sum;
}

struct Arm {
  frames::LoadingGeometry geometry;
  Eigen::Vector3d centre{0.8, -0.3, 1.2};
  JointVector q;
  ArmParameters at;
  Eigen::VectorXd steps;

  explicit Arm(const ChainArm& chain = exampleChain())
      : at(chain.joints()), steps(Eigen::VectorXd::Zero(at.count(kTargets))) {
    Noise noise(5);
    geometry.arm = chain.disturbed(noise, 1e-2, 2e-2).robot();  // no two axes meet or are parallel
    q = chain.joints() == 6 ? degrees(20, -30, 40, 100, -50, 70) : somePosture(noise, chain);
    geometry.r0_from_loading = Eigen::Translation3d(3.0, -2.0, 0.5) * Eigen::AngleAxisd(0.7, noise.direction());
    for (std::size_t t = 0; t < kTargets; ++t)
      geometry.targets_at_zero.push_back(geometry.arm.base_from_flange_at_zero * (0.3 * noise.normal3()));
  }

  /// Steps as large as calibrations of nominal arms take, and a base turned by far more.
  Arm stepped() const {
    Arm other = *this;
    for (Eigen::Index k = 0; k < steps.size(); ++k) other.steps[k] = 0.02 * std::cos(3.0 * static_cast<double>(k));
    other.steps.segment<3>(at.baseAt()) << 0.5, -0.8, 0.3;
    return other;
  }

  frames::AxesAtStart start() const { return frames::axesAtStart(geometry.arm.axes_in_base_at_zero); }

  frames::PlacedArm placed() const { return {start(), centre, steps.head(at.axes()), steps.segment<6>(at.baseAt())}; }

  Eigen::Vector3d atZero(std::size_t target) const {
    return *geometry.targets_at_zero[target] + steps.segment<3>(at.targetAt(target));
  }

  /// By the equation of the header.
  Eigen::Vector3d expected(std::size_t target) const {
    Eigen::Vector4d point = atZero(target).homogeneous();
    for (int j = geometry.arm.joints() - 1; j >= 0; --j) {
      const metrology::MeasuredLine axis = start()[static_cast<std::size_t>(j)];
      const Eigen::Vector4d own = steps.segment<4>(4 * j);
      const Eigen::Vector3d at = axis.line.point + own[0] * axis.across_u + own[1] * axis.across_v;
      const Eigen::Vector3d along = axis.line.direction + own[2] * axis.across_u + own[3] * axis.across_v;
      const Eigen::Vector3d turn = q[j] * along / along.norm();
      point = exponential(turn, at.cross(turn)) * point;
    }
    const Eigen::Vector3d rotation = steps.segment<3>(at.baseAt());
    const Eigen::Vector3d shift = steps.segment<3>(at.baseAt() + 3);
    return exponential(-rotation, Eigen::Vector3d::Zero()).topLeftCorner<3, 3>() * (point.head<3>() - centre - shift) +
           centre;
  }

  Eigen::MatrixXd differences(std::size_t target) const {
    constexpr double kStep = 1e-5;
    Eigen::MatrixXd columns(3, steps.size());
    Arm ahead = *this, behind = *this;
    for (Eigen::Index k = 0; k < steps.size(); ++k) {
      ahead.steps[k] += kStep, behind.steps[k] -= kStep;
      columns.col(k) = (ahead.expected(target) - behind.expected(target)) / (2.0 * kStep);
      ahead.steps[k] = behind.steps[k] = steps[k];
    }
    return columns;
  }

  Eigen::MatrixXd computed(std::size_t target) const {
    const frames::PlacedArm arm = placed();
    const frames::PlacedPosture posture(arm, q);
    const Eigen::Vector3d position = posture.position(atZero(target));
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(3, steps.size());
    columns.leftCols(at.axes()) = posture.byAxes(position);
    columns.middleCols<6>(at.baseAt()) = posture.byBase(position);
    columns.middleCols<3>(at.targetAt(target)) = posture.byTarget();
    return columns;
  }
};

TEST(PlacedPosture, IsTheProductOfExponentials) {
  for (const Arm& one : {Arm(), Arm().stepped(), Arm(fiveAxisChain()).stepped(), Arm(sevenAxisChain()).stepped(),
                         Arm(eightAxisChain()).stepped()}) {
    const frames::PlacedArm arm = one.placed();
    const frames::PlacedPosture posture(arm, one.q);
    for (std::size_t t = 0; t < kTargets; ++t)
      EXPECT_LT((posture.position(one.atZero(t)) - one.expected(t)).norm(), 1e-13);  // rounding of some metres
  }
}

TEST(PlacedPosture, HasTheDerivativesOfTheProductOfExponentials) {
  Arm hardly_turned = Arm().stepped();  // the other side of where the turn's series ends
  hardly_turned.steps.segment<3>(hardly_turned.at.baseAt()) *= 1e-3;
  for (const Arm& one : {Arm(), hardly_turned, Arm().stepped(), Arm(fiveAxisChain()).stepped(),
                         Arm(sevenAxisChain()).stepped(), Arm(eightAxisChain()).stepped()}) {
    for (std::size_t t = 0; t < kTargets; ++t) {
      const Eigen::MatrixXd expected = one.differences(t);
      // Rounding of some metres over a step of 1e-5, and the third derivative times the step's square.
      EXPECT_LT((one.computed(t) - expected).cwiseAbs().maxCoeff(), 1e-9) << one.computed(t) - expected;
      EXPECT_GT(expected.leftCols(one.at.targetsAt()).colwise().norm().minCoeff(), 1e-3);  // none is empty
    }
  }
}

TEST(PlacedPosture, HasTheJacobianOfItsAngles) {
  const Arm one = Arm().stepped();
  const frames::PlacedArm arm = one.placed();
  const Eigen::Vector3d position = frames::PlacedPosture(arm, one.q).position(one.atZero(0));
  const PointJacobian by_angles = frames::PlacedPosture(arm, one.q).byAngles(position);
  for (int j = 0; j < 6; ++j) {
    constexpr double kStep = 1e-5;
    Arm ahead = one, behind = one;
    ahead.q[j] += kStep, behind.q[j] -= kStep;
    const Eigen::Vector3d expected = (ahead.expected(0) - behind.expected(0)) / (2.0 * kStep);
    EXPECT_LT((by_angles.col(j) - expected).norm(), 1e-9) << j;  // as above
  }
}

/// Where a geometry's forward kinematics has a reflector, in the frame of the readings.
Eigen::Vector3d inLoading(const frames::LoadingGeometry& geometry, const JointVector& q, std::size_t target) {
  return geometry.r0_from_loading->inverse() *
         (robot::postureAt(geometry.arm, q).motion.back() * *geometry.targets_at_zero[target]);
}

TEST(Moved, PutsReflectorsWhereTheParametersSay) {
  for (const Arm& one : {Arm().stepped(), Arm(fiveAxisChain()).stepped(), Arm(sevenAxisChain()).stepped()}) {
    const frames::LoadingGeometry there = frames::moved(one.geometry, one.steps, one.centre);
    for (std::size_t t = 0; t < kTargets; ++t) {
      EXPECT_LT((inLoading(there, one.q, t) - one.geometry.r0_from_loading->inverse() * one.expected(t)).norm(), 1e-13);
    }
  }
}

TEST(Moved, DiffersByTheDerivatives) {
  const Arm one;
  for (Eigen::Index k = 0; k < one.steps.size(); ++k) {
    constexpr double kStep = 1e-6;
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(one.steps.size(), k);
    for (std::size_t t = 0; t < kTargets; ++t) {
      const Eigen::Vector3d by_step = (inLoading(frames::moved(one.geometry, step, one.centre), one.q, t) -
                                       inLoading(frames::moved(one.geometry, -step, one.centre), one.q, t)) /
                                      (2.0 * kStep);
      // Rounding of some metres over a step of 1e-6.
      EXPECT_LT((one.geometry.r0_from_loading->linear() * by_step - one.computed(t).col(k)).norm(), 4e-9) << k;
    }
  }
}

}  // namespace arm_parameters_test
}  // namespace stiffscope
