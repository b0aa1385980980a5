#include "core/identification/gear_states.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/metrology/simulated_points.h"

// Lines of wind-up over torque that are made here, against dense least squares with a level for each posture.

namespace stiffscope {
namespace gear_line_test {

using identification::JointStates;

constexpr double kCompliance = 2e-7;   // rad/Nm
constexpr double kLostMotion = 30e-6;  // rad

/// Postures of a joint whose torque turns round in each, levels of their own.
JointStates statesOf(int postures, int steps, double lost_motion, double scatter, Noise& noise) {
  JointStates joint;
  for (int posture = 0; posture < postures; ++posture) {
    const double level = 1e-3 * noise.normal(), rest = 400.0 * noise.normal();
    for (int step = 0; step < steps; ++step) {
      const double torque = rest + 1000.0 * (2.0 * step / (steps - 1.0) - 1.0), side = torque > 0.0 ? 0.5 : -0.5;
      joint.state.push_back(joint.size());
      joint.torque.push_back(torque);
      joint.side.push_back(side);
      joint.windup.push_back(level + kCompliance * torque + lost_motion * side + scatter * noise.normal());
      joint.reported.push_back(level);
      joint.used.push_back(true);
    }
    joint.posture_end.push_back(joint.size());
  }
  return joint;
}

/// Coefficients of torque and side beside a level for each posture, of the states that are used.
Eigen::VectorXd denseFit(const JointStates& joint) {
  const auto postures = static_cast<Eigen::Index>(joint.posture_end.size());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(joint.size()), 2 + postures);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(columns.rows());
  std::size_t posture = 0;
  for (std::size_t i = 0; i < joint.size(); ++i) {
    if (i == joint.posture_end[posture]) ++posture;
    if (!joint.used[i]) continue;
    const auto row = static_cast<Eigen::Index>(i);
    columns(row, 0) = joint.torque[i], columns(row, 1) = joint.side[i];
    columns(row, 2 + static_cast<Eigen::Index>(posture)) = 1.0;
    right[row] = joint.windup[i];
  }
  return columns.completeOrthogonalDecomposition().solve(right);
}

TEST(GearLine, LevelsAndLostMotionTakenOffGiveTheSlopeOfTheWholeFit) {
  Noise noise(41);
  JointStates joint = statesOf(12, 5, kLostMotion, 4e-6, noise);
  joint.used[7] = joint.used[30] = false;
  const identification::JointColumns columns = identification::columnsOf(joint);
  ASSERT_FALSE(columns.side.empty());
  const identification::Slope slope = identification::slopeOf(joint, columns.torque, columns.windup);
  const Eigen::VectorXd whole = denseFit(joint);
  EXPECT_NEAR(slope.value, whole[0], 1e-9 * whole[0]);
  EXPECT_NEAR(slope.value, kCompliance, 4.0 * slope.sd);
}

TEST(GearLine, NoLostMotionIsSoughtWhereTheTorqueKeepsItsSign) {
  Noise noise(42);
  JointStates joint = statesOf(12, 5, 0.0, 1e-6, noise);
  std::fill(joint.side.begin(), joint.side.end(), 0.5);
  EXPECT_TRUE(identification::columnsOf(joint).side.empty());
}

// 400 days: the standard deviation that is stated against the scatter of the slopes. 20 postures leave 17 % of a
// standard deviation to chance, of which the mean over the days keeps a hundredth; 400 slopes know their scatter to 4
// %.
TEST(GearLine, TheStatedUncertaintyIsTheScatterOfDays) {
  Noise noise(43);
  double sum = 0.0, squares = 0.0, stated = 0.0;
  constexpr int kDays = 400;
  for (int day = 0; day < kDays; ++day) {
    const JointStates joint = statesOf(20, 4, 0.0, 5e-6, noise);
    const identification::JointColumns columns = identification::columnsOf(joint);
    const identification::Slope slope = identification::slopeOf(joint, columns.torque, columns.windup);
    const double off = slope.value - kCompliance;
    sum += off, squares += off * off, stated += slope.sd * slope.sd / kDays;
  }
  const double scatter = std::sqrt(squares / kDays);
  EXPECT_NEAR(std::sqrt(stated) / scatter, 1.0, 0.15);
  EXPECT_LT(std::abs(sum / kDays), 4.0 * scatter / std::sqrt(kDays));
}

// One state of 60 off by 0.1 mrad, where the others scatter by 4 urad.
TEST(GearLine, OneWrongReadingIsLeftOutAndNoOther) {
  Noise noise(44);
  JointStates joint = statesOf(12, 5, kLostMotion, 4e-6, noise);
  joint.windup[23] += 1e-4;
  identification::leaveOutWrongReadings(joint);
  for (std::size_t i = 0; i < joint.size(); ++i) EXPECT_EQ(joint.used[i], i != 23) << i;
}

TEST(GearLine, ColumnsHaveNoMeanInAnyPostureAndNothingAlongAnother) {
  Noise noise(45);
  JointStates joint = statesOf(6, 5, kLostMotion, 4e-6, noise);
  joint.used[2] = false;
  const std::vector<double> torque = identification::withinPostures(joint, joint.torque);
  joint.byPosture([&](std::size_t from, std::size_t to) {
    double sum = 0.0;
    for (std::size_t i = from; i < to; ++i) sum += torque[i];
    EXPECT_NEAR(sum, 0.0, 1e-9);
  });
  EXPECT_EQ(torque[2], 0.0);
  const std::vector<double> side = identification::withinPostures(joint, joint.side);
  EXPECT_NEAR(identification::dot(identification::acrossOf(torque, side), side), 0.0, 1e-9);
}

}  // namespace gear_line_test
}  // namespace stiffscope
