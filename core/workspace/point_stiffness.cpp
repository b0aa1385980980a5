#include "core/workspace/point_stiffness.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/numerics/resampling.h"
#include "core/robot/cartesian_stiffness.h"
#include "core/robot/kinematics.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::workspace {

namespace {

/// The force under which the arm's secant is taken, N: the day's largest, at which play and friction have their day's
/// share; a robot's usual load where that is not known.
double probeOf(const DeflectingArm& arm) {
  constexpr double kUsual = 500.0;
  return arm.certainty->range.force > 0.0 ? arm.certainty->range.force : kUsual;
}

constexpr double kNoMove = 1e-9;  // m per rad: no joint of an arm in a laboratory moves a point by so little

/// Where P_TCP stands under a force there, R0; empty where the arm does not come to rest.
std::optional<Eigen::Vector3d> loadedPoint(const effects::RestingFlange& flange, const DeflectingArm& arm,
                                           const JointVector& q, const Eigen::Vector3d& force) {
  const auto resting = flange(q, {arm.tcp_in_flange, force, Eigen::Vector3d::Zero()});
  return resting ? std::optional<Eigen::Vector3d>(*resting * arm.tcp_in_flange) : std::nullopt;
}

/// Half the difference of the deflections under a force and its opposite, over the force: one column of the compliance.
std::optional<Eigen::Vector3d> probed(const effects::RestingFlange& flange, const DeflectingArm& arm,
                                      const JointVector& q, const Eigen::Vector3d& direction) {
  const double probe = probeOf(arm);
  const auto there = loadedPoint(flange, arm, q, probe * direction),
             back = loadedPoint(flange, arm, q, -probe * direction);
  if (!there || !back) return std::nullopt;
  return (*there - *back) / (2.0 * probe);
}

/// Orthonormal columns at right angles to what the joints move.
Eigen::Matrix3Xd unmovedBy(const PointJacobian& jacobian, const std::vector<int>& joints) {
  if (joints.empty()) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3Xd moved(3, static_cast<Eigen::Index>(joints.size()));
  for (std::size_t k = 0; k < joints.size(); ++k)
    moved.col(static_cast<Eigen::Index>(k)) = jacobian.col(joints[k]).normalized();
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(moved.transpose());
  if (lu.dimensionOfKernel() == 0) return Eigen::Matrix3Xd(3, 0);
  const Eigen::MatrixXd kernel = lu.kernel();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(kernel);
  return qr.householderQ() * Eigen::MatrixXd::Identity(3, kernel.cols());
}

/// Displacement of P_TCP by a unit force with a unit of each uncertain parameter of what gives besides joint springs.
Eigen::MatrixXd byParameters(const DeflectingArm& arm, const JointVector& q, const Eigen::Vector3d& tcp,
                             const Eigen::Vector3d& direction, const Eigen::Vector3d& as_it_is) {
  const compensation::DeflectionDraws& draws = arm.certainty->draws;
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(3, draws.parameters.rows());
  if (by.cols() == 0) return by;
  if (draws.by) {
    const double probe = probeOf(arm);
    by = draws.by(q, {arm.tcp_in_flange, probe * direction, Eigen::Vector3d::Zero()}, {tcp}) / probe;
  } else if (arm.with != nullptr) {
    for (std::size_t v = 0; v < arm.with->varied.size(); ++v) {
      const auto varied = probed(arm.with->varied[v], arm, q, direction);
      if (varied) by.col(static_cast<Eigen::Index>(v)) = *varied - as_it_is;
    }
  }
  return by;
}

/// Variance of a direction's compliance, (m/N)^2, by the fit of the joints' springs.
double varianceOfSprings(const identification::StiffnessEstimate& springs, const PointJacobian& jacobian,
                         const Eigen::Vector3d& direction) {
  const JointMatrix covariance = identification::coveringCovariance(springs);
  const JointVector moves = (jacobian.transpose() * direction).cwiseAbs2();
  double variance = 0.0;
  const auto joints = static_cast<int>(moves.size());
  for (int i = 0; i < joints; ++i) {
    for (int j = 0; j < joints; ++j) {
      // The direction is at right angles to what joints of unknown stiffness move.
      if (hasUsableStiffness(springs, i) && hasUsableStiffness(springs, j))
        variance += moves[i] * moves[j] * covariance(i, j);
    }
  }
  return std::max(0.0, variance);
}

/// The same of springs and named effects together.
double varianceOfFit(const DeflectingArm& arm, const JointVector& q, const PointJacobian& jacobian,
                     const Eigen::Vector3d& direction, double compliance) {
  if (arm.with == nullptr) return varianceOfSprings(arm.estimate, jacobian, direction);
  identification::StiffnessEstimate springs = arm.estimate;
  springs.covariance -= springs.parts.effects;
  double variance = varianceOfSprings(springs, jacobian, direction);
  for (const effects::RestingFlange& flange : arm.with->varied) {
    const auto varied = probed(flange, arm, q, direction);
    if (varied) variance += std::pow(direction.dot(*varied) - compliance, 2);
  }
  return std::max(0.0, variance);
}

/// What 68.27 % of the errors do not exceed, the standard uncertainty of normal ones: of a few draws of a large effect
/// their root mean square would speak, which is no scale of the others.
double middleError(const Eigen::VectorXd& errors) {
  constexpr double kOneSigma = 0.6827;
  std::vector<double> sizes(errors.begin(), errors.end());
  for (double& size : sizes) size = std::abs(size);
  return numerics::quantileOf(std::move(sizes), kOneSigma);
}

/// `by`: of the effects' parameters along the direction; no columns: joint springs alone. `of_fit`: variance by the
/// fit, zero where the draws have it.
DirectionalCompliance withInterval(const DeflectingArm& arm, const PointJacobian& jacobian,
                                   const Eigen::Vector3d& direction, double compliance, const Eigen::RowVectorXd& by,
                                   double of_fit) {
  const compensation::DeflectionDraws& draws = arm.certainty->draws;
  const JointVector moves = jacobian.transpose() * direction;
  Eigen::VectorXd errors = draws.compliance.transpose() * moves.cwiseAbs2();
  if (by.cols() > 0) draws.addByParameters(by, errors);
  errors.tail(draws.springs_alone).array() -= compliance;
  identification::CoverageInterval off = compensation::intervalOf(errors);
  if (std::isfinite(off.low)) {
    const double of_draws = by.cols() > 0 ? std::pow(middleError(errors), 2) : 0.0;
    const double half = identification::kNormalFactor * std::sqrt(of_draws + of_fit);
    off = {std::min(off.low, -half), std::max(off.high, half)};
  }
  return {direction, compliance, {compliance + off.low, compliance + off.high}};
}

struct LinearArm {
  robot::ArmPosture posture;
  Eigen::Vector3d tcp;
  Jacobian jacobian;
};

LinearArm linearArm(const DeflectingArm& arm, const JointVector& q) {
  LinearArm at{robot::postureAt(arm.geometry.arm, arm.geometry.sagged(q)), {}, {}};
  at.tcp = robot::flangeAt(arm.geometry.arm, at.posture) * arm.tcp_in_flange;
  at.jacobian = robot::jacobianAt(arm.geometry.arm, at.posture, at.tcp);
  return at;
}

}  // namespace

bool hasUsableStiffness(const identification::StiffnessEstimate& estimate, int joint) {
  return estimate.identifiable[static_cast<std::size_t>(joint)] && estimate.compliance[joint] >= 0.0;
}

identification::CoverageInterval DirectionalCompliance::stiffnessInterval() const {
  return identification::stiffnessInterval(interval);
}

std::optional<PointStiffness> pointStiffness(const DeflectingArm& arm, const JointVector& q) {
  const LinearArm at = linearArm(arm, q);
  PointStiffness place;
  place.q = q;
  place.tcp = at.tcp;
  const Eigen::VectorXd singular = singularValues(at.jacobian);
  place.conditioning = singular[singular.size() - 1] / singular[0];
  JointVector compliance = arm.estimate.compliance;
  const PointJacobian moves = at.jacobian.topRows<3>();
  for (int joint = 0; joint < compliance.size(); ++joint) {
    if (hasUsableStiffness(arm.estimate, joint)) continue;
    compliance[joint] = 0.0;
    if (moves.col(joint).norm() > kNoMove) place.unknown.push_back(joint);
  }
  place.springs = robot::cartesianStiffness(at.tcp, at.jacobian, compliance).compliance.topLeftCorner<3, 3>();
  place.model = place.springs;
  if (arm.with != nullptr) {
    for (int k = 0; k < 3; ++k) {
      const auto column = probed(arm.with->flange, arm, q, Eigen::Vector3d::Unit(k));
      if (!column) return std::nullopt;
      place.model.col(k) = *column;
    }
    place.model = 0.5 * (place.model + place.model.transpose()).eval();
  }
  const Eigen::Matrix3Xd known = unmovedBy(moves, place.unknown);
  const compensation::DeflectionDraws& draws = arm.certainty->draws;
  const bool drawn_of_fit = !draws.by;
  for (const robot::PrincipalStiffness& one : robot::principalStiffnessWithin(place.springs, known)) {
    place.of_springs.push_back(
        withInterval(arm, moves, one.direction, one.direction.dot(place.springs * one.direction), {},
                     drawn_of_fit ? 0.0 : varianceOfSprings(arm.estimate, moves, one.direction)));
  }
  if (arm.with == nullptr && draws.parameters.rows() == 0) {
    place.of_model = place.of_springs;
    return place;
  }
  for (const robot::PrincipalStiffness& one : robot::principalStiffnessWithin(place.model, known)) {
    const Eigen::Vector3d move = place.model * one.direction;
    const Eigen::RowVectorXd by = one.direction.transpose() * byParameters(arm, q, at.tcp, one.direction, move);
    const double compliance = one.direction.dot(move);
    place.of_model.push_back(
        withInterval(arm, moves, one.direction, compliance, by,
                     drawn_of_fit ? 0.0 : varianceOfFit(arm, q, moves, one.direction, compliance)));
  }
  return place;
}

}  // namespace stiffscope::workspace
