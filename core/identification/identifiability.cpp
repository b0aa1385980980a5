#include "core/identification/identifiability.h"

#include <Eigen/Dense>
#include <cmath>

#include "core/identification/remarks.h"
#include "core/numerics/parallel.h"
#include "core/robot/kinematics.h"
#include "core/robot/wrench.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::identification {

namespace {

double square(double x) { return x * x; }

/// The load as it were if it hung exactly: the force along gravity, no moment about it.
robot::Wrench hangingPart(const robot::Wrench& wrench, const Eigen::Vector3d& down) {
  robot::Wrench part = wrench;
  part.force = down * down.dot(wrench.force);
  part.moment -= down * down.dot(wrench.moment);
  return part;
}

/// Variance of each joint's torque by the uncertainties of wrench, direction and place.
JointVector torqueVariance(const robot::ArmAxes& axes, const robot::Wrench& wrench, const campaign::LoadCell& cell,
                           const TrustLimits& limits) {
  const Jacobian by_joints = robot::jacobianAt(axes, wrench.point);
  JointVector variance(by_joints.cols());
  for (Eigen::Index j = 0; j < by_joints.cols(); ++j) {
    const Eigen::Vector3d lever = by_joints.col(j).head<3>(), axis = by_joints.col(j).tail<3>();
    const Eigen::Vector3d by_turn = wrench.force.cross(lever) + wrench.moment.cross(axis);
    variance[j] = square(cell.force_sigma) * lever.squaredNorm() + square(cell.moment_sigma) * axis.squaredNorm() +
                  square(limits.direction) * by_turn.squaredNorm() +
                  square(limits.position) * axis.cross(wrench.force).squaredNorm();
  }
  return variance;
}

void evaluateHanging(const frames::LoadingGeometry& geometry, const std::vector<LoadCase>& cases,
                     const TrustLimits& limits, Identifiability& result) {
  if (geometry.weight.gravity_in_base.squaredNorm() == 0.0) return;
  const Eigen::Vector3d down = geometry.weight.gravity_in_base.normalized();
  double sum = 0.0;
  int forces = 0;
  for (const LoadCase& load_case : cases) {
    const Eigen::Vector3d& force = load_case.wrench.force;
    if (force.norm() == 0.0) continue;
    sum += square(std::atan2(force.cross(down).norm(), force.dot(down)));
    ++forces;
  }
  if (forces == 0) return;
  result.gravity_angle_rms = std::sqrt(sum / forces);
  result.load_hangs = result.gravity_angle_rms < limits.hanging_within;
}

/// Of all load cases, joint by joint.
struct TorqueSquares {
  JointVector torque, trusted, variance;  // none before the first

  TorqueSquares& operator+=(const TorqueSquares& other) {
    if (other.torque.size() == 0) return *this;
    if (torque.size() == 0) return *this = other;
    torque += other.torque, trusted += other.trusted, variance += other.variance;
    return *this;
  }
};

/// Of all equations: their columns, and the torque at each point.
struct LeverSquares {
  JointVector columns, torques;  // none before the first

  LeverSquares& operator+=(const LeverSquares& other) {
    if (other.columns.size() == 0) return *this;
    if (columns.size() == 0) return *this = other;
    columns += other.columns, torques += other.torques;
    return *this;
  }
};

/// Marks joints about whose axis the measured points hardly move: their distance from it is no more than the
/// place of the axis is trusted to. A column of the equations is that distance times the torque.
void evaluateLever(const std::vector<CaseEquations>& equations, const std::vector<JointVector>& torques,
                   const TrustLimits& limits, Identifiability& result) {
  const auto sum = numerics::sumInBlocks<LeverSquares>(equations.size(), [&](std::size_t i, LeverSquares& all) {
    const auto points = static_cast<double>(equations[i].matrix.rows() / 3);
    all += LeverSquares{equations[i].matrix.colwise().squaredNorm().transpose(), torques[i].cwiseAbs2() * points};
  });
  for (int j = 0; j < static_cast<int>(result.joints.size()); ++j) {
    JointIdentifiability& joint = result.joints[static_cast<std::size_t>(j)];
    const double lever = sum.torques[j] > 0.0 ? std::sqrt(sum.columns[j] / sum.torques[j]) : 0.0;
    if (!joint.identifiable || lever > limits.least_ratio * limits.position) continue;
    joint.identifiable = false;
    joint.reason = Remark(RemarkId::points_on_axis, j + 1, lever);
  }
}

constexpr double kTakesPart = 0.05;  // share of a joint in an unseen combination

/// `unseen`: of the columns at unit length, the combination that moves no measured point; `lengths` of the
/// columns. Two joints whose columns are parallel: what is seen is c_a + ratio c_b.
Remark combinationReason(const JointVector& unseen, const JointVector& lengths) {
  std::vector<int> joints;
  for (int j = 0; j < static_cast<int>(unseen.size()); ++j) {
    if (std::abs(unseen[j]) > kTakesPart) joints.push_back(j);
  }
  if (joints.size() == 2) {
    const int a = joints[0], b = joints[1];
    const double ratio = -(unseen[a] / lengths[a]) / (unseen[b] / lengths[b]);
    return Remark(RemarkId::two_joints_combined, a + 1, b + 1, ratio);
  }
  std::vector<int> numbers;
  std::vector<double> steps;
  for (const int j : joints) {
    numbers.push_back(j + 1);
    steps.push_back(unseen[j] / lengths[j] / (unseen[joints[0]] / lengths[joints[0]]));
  }
  return Remark(RemarkId::joints_combined, numbers, steps);
}

/// Marks joints that take part in a combination which the equations do not see.
void evaluateRank(const std::vector<CaseEquations>& equations, Identifiability& result) {
  const auto sum = numerics::sumInBlocks<NormalEquations>(
      equations.size(), [&](std::size_t i, NormalEquations& all) { all += normalEquations(equations[i]); });
  const robot::JointMask mask = result.mask();
  const auto count = static_cast<Eigen::Index>(mask.size());
  JointMatrix scaled = JointMatrix::Identity(count, count);
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < count; ++b) {
      if (mask[static_cast<std::size_t>(a)] && mask[static_cast<std::size_t>(b)]) {
        scaled(a, b) = sum.matrix(a, b) / std::sqrt(sum.matrix(a, a) * sum.matrix(b, b));
      }
    }
  }
  const SymmetricEigen eigen = symmetricEigen(scaled);
  constexpr double kUnseen = 1e-8;  // squared singular value of unit columns: a condition number of 1e4
  for (Eigen::Index k = 0; k < count; ++k) {
    if (eigen.values[k] > kUnseen) break;
    const JointVector unseen = eigen.vectors.col(k);
    const Remark reason = combinationReason(unseen, sum.matrix.diagonal().cwiseSqrt());
    for (Eigen::Index j = 0; j < count; ++j) {
      if (std::abs(unseen[j]) <= kTakesPart) continue;
      JointIdentifiability& joint = result.joints[static_cast<std::size_t>(j)];
      joint.identifiable = false;
      joint.reason = reason;
    }
  }
}

}  // namespace

robot::JointMask Identifiability::mask() const {
  robot::JointMask unknown;
  for (const JointIdentifiability& joint : joints) unknown.push_back(joint.identifiable);
  return unknown;
}

Identifiability evaluateTorques(const frames::LoadingGeometry& geometry, const std::vector<LoadCase>& cases,
                                const campaign::LoadCell& cell, const TrustLimits& limits) {
  Identifiability result;
  result.joints.resize(static_cast<std::size_t>(geometry.arm.joints()));
  if (cases.empty()) return result;
  evaluateHanging(geometry, cases, limits, result);
  const Eigen::Vector3d down = geometry.weight.gravity_in_base.normalized();
  const auto sum = numerics::sumInBlocks<TorqueSquares>(cases.size(), [&](std::size_t i, TorqueSquares& all) {
    const LoadCase& load_case = cases[i];
    const robot::ArmAxes& axes = load_case.axes;
    const JointVector torque = robot::jointTorque(axes, load_case.wrench);
    const JointVector hanging =
        result.load_hangs ? robot::jointTorque(axes, hangingPart(load_case.wrench, down)) : torque;
    all += TorqueSquares{torque.cwiseAbs2(), hanging.cwiseAbs2(), torqueVariance(axes, load_case.wrench, cell, limits)};
  });
  const double n = static_cast<double>(cases.size());
  for (int j = 0; j < geometry.arm.joints(); ++j) {
    JointIdentifiability& joint = result.joints[static_cast<std::size_t>(j)];
    joint.torque_rms = std::sqrt(sum.torque[j] / n);
    joint.trusted_rms = std::sqrt(sum.trusted[j] / n);
    joint.uncertainty_rms = std::sqrt(sum.variance[j] / n);
    joint.identifiable = joint.trusted_rms > 0.0 && joint.trusted_rms > limits.least_ratio * joint.uncertainty_rms;
    if (joint.identifiable) continue;
    joint.reason = result.load_hangs && joint.torque_rms > joint.trusted_rms
                       ? Remark(RemarkId::load_hangs, j + 1, joint.torque_rms, joint.trusted_rms)
                       : Remark(RemarkId::load_turns_too_little, j + 1, joint.trusted_rms, limits.least_ratio,
                                joint.uncertainty_rms);
  }
  return result;
}

Identifiability evaluateIdentifiability(const frames::LoadingGeometry& geometry, const std::vector<LoadCase>& cases,
                                        const campaign::LoadCell& cell, const std::vector<CaseEquations>& equations,
                                        const TrustLimits& limits) {
  Identifiability result = evaluateTorques(geometry, cases, cell, limits);
  if (cases.empty()) return result;
  evaluateLever(equations, jointTorques(cases), limits, result);
  evaluateRank(equations, result);
  return result;
}

}  // namespace stiffscope::identification
