#include "core/effects/gravity_equilibrium.h"

#include <Eigen/Geometry>
#include <array>

#include "metrology/rigid_motion.h"

namespace stiffscope::effects {

std::vector<Eigen::Vector3d> probesAt(const Eigen::Vector3d& first) {
  return {first, first + Eigen::Vector3d::UnitX(), first + Eigen::Vector3d::UnitY(),
          first + Eigen::Vector3d::UnitZ()};
}

Vector6d probedMotion(const Eigen::VectorXd& moved) {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    turn += 0.5 * Eigen::Vector3d::Unit(k).cross(moved.segment<3>(3 * (k + 1)) - moved.head<3>());
  return (Vector6d() << turn, moved.head<3>()).finished();
}

namespace {

/// Rotation vector and displacement at the origin of each parameter's motion, per unit.
Eigen::Matrix<double, 6, Eigen::Dynamic> twistsOf(const PresentMotion& motion, const WorkingPoint& at,
                                                  const ArmState& rest) {
  ArmState probe = rest;
  probe.targets = {0, 0, 0, 0};
  probe.points = probesAt(Eigen::Vector3d::Zero());
  const Eigen::MatrixXd offset = motion.offset(at, {probe}, 0);
  Eigen::Matrix<double, 6, Eigen::Dynamic> twists(6, offset.cols());
  for (Eigen::Index k = 0; k < offset.cols(); ++k) twists.col(k) = probedMotion(offset.col(k));
  return twists;
}

/// Inner bodies first, so that an outer motion turns about where the inner ones have brought its pivot.
BodyMotions motionsOf(const WorkingPoint& at, const ArmState& rest) {
  std::array<Vector6d, 7> by_body;
  by_body.fill(Vector6d::Zero());
  for (const PresentMotion& motion : at.motions) {
    const auto twists = twistsOf(motion, at, rest);
    for (Eigen::Index k = 0; k < twists.cols(); ++k) {
      const auto first = static_cast<std::size_t>(motion.first_body[static_cast<std::size_t>(k)]);
      by_body[first] += twists.col(k) * motion.parameters[k];
    }
  }
  BodyMotions all = noBodyMotions();
  for (std::size_t first = 1; first < by_body.size(); ++first) {
    const Vector6d& twist = by_body[first];
    if (twist.isZero(0.0)) continue;
    // A screw: the rotation about its own axis, not about the origin, so that large arms do not bend it.
    const Eigen::Vector3d turn = twist.head<3>(), shift = twist.tail<3>();
    const double square = turn.squaredNorm();
    const Eigen::Vector3d centre =
        square > 0.0 ? Eigen::Vector3d(turn.cross(shift) / square) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    Vector6d about_centre;
    about_centre << turn, shift + turn.cross(centre);
    const Eigen::Isometry3d own = metrology::motionAbout(centre, about_centre);
    for (std::size_t b = first; b < all.size(); ++b) all[b] = own * all[b];
  }
  return all;
}

}  // namespace

Vector6d presentTurn(const WorkingPoint& at, const ArmState& state) {
  Vector6d turn = Vector6d::Zero();
  const PostureStates rest{state};
  for (const PresentTurn& one : at.turns) turn += one.angles(at, rest, 0) * one.parameters;
  return turn;
}

ArmState restState(const frames::LoadingGeometry& geometry, const WorkingPoint& at, const Vector6d& q) {
  ArmState state = stateAt(geometry, q, Vector6d::Zero());
  if (at.turns.empty() && at.motions.empty()) return state;
  constexpr int kRounds = 5;  // torques change with turns and motions by a hundredth with a strong effect
  for (int round = 0; round < kRounds; ++round) {
    const Vector6d turn = presentTurn(at, state);
    if (at.motions.empty()) {
      state = stateAt(geometry, q, turn);
      continue;
    }
    const Vector6d sag = geometry.compliance.cwiseProduct(state.weight_torque);
    const Eigen::Matrix4d before = state.flange.matrix();
    state = stateMoved(geometry, q, q + sag + turn, motionsOf(at, state));
    constexpr double kSettled = 1e-10;  // m and rad
    if ((state.flange.matrix() - before).cwiseAbs().maxCoeff() < kSettled) break;
  }
  return state;
}

namespace {

/// Joint angles in place of displacements.
Matrix6d anglesByBody(const WorkingPoint& at, const ArmState& state) {
  Matrix6d angles = Matrix6d::Zero();
  for (int body = 1; body <= 6; ++body) {
    const auto b = static_cast<std::size_t>(body);
    robot::Wrench own = state.weight_from_body[b];
    if (body < 6) {
      own.force -= state.weight_from_body[b + 1].force;
      own.moment -= state.weight_from_body[b + 1].moment;
    }
    for (int j = 0; j < body; ++j) {
      const metrology::Line& axis = state.axes[static_cast<std::size_t>(j)];
      angles(j, body - 1) = at.compliance[j] * axis.direction.dot(own.about(axis.point).moment);
    }
  }
  return angles;
}

}  // namespace

Eigen::MatrixXd sagByBody(const WorkingPoint& at, const ArmState& state) {
  return byJoints(state, anglesByBody(at, state));
}

}  // namespace stiffscope::effects
