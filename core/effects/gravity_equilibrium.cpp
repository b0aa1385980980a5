#include "core/effects/gravity_equilibrium.h"

#include <Eigen/Geometry>
#include <utility>

#include "metrology/rigid_motion.h"

namespace stiffscope::effects {

namespace {

/// Inner bodies first, so that an outer motion turns about where the inner ones have brought its pivot.
BodyMotions motionsOf(const LinearizationPoint& at, const PostureStates& rest) {
  const int bodies = rest.front().bodies();
  // Rotation vector, and displacement of the R0 origin.
  PerBody<Vector6d> by_body(static_cast<std::size_t>(bodies) + 1, Vector6d(Vector6d::Zero()));
  for (const PresentEffect& one : at.present) {
    if (!one.model->twists) continue;
    const std::vector<BodyTwist> twists = one.model->twists(at, rest, 0);
    for (std::size_t k = 0; k < twists.size(); ++k) {
      const BodyTwist& twist = twists[k];
      Vector6d at_origin;
      at_origin << twist.rotation, twist.shift - twist.rotation.cross(twist.pivot);
      by_body[static_cast<std::size_t>(twist.first_body)] += at_origin * one.parameters[static_cast<Eigen::Index>(k)];
    }
  }
  BodyMotions all = noBodyMotions(bodies);
  for (std::size_t first = 1; first < by_body.size(); ++first) {
    all[first] = all[first - 1];
    const Vector6d& twist = by_body[first];
    if (twist.isZero(0.0)) continue;
    // A screw: the rotation about its own axis, not about the origin, so that large arms do not bend it.
    const Eigen::Vector3d turn = twist.head<3>(), shift = twist.tail<3>();
    const double square = turn.squaredNorm();
    const Eigen::Vector3d centre =
        square > 0.0 ? Eigen::Vector3d(turn.cross(shift) / square) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    Vector6d about_centre;
    about_centre << turn, shift + turn.cross(centre);
    all[first] = metrology::motionAbout(centre, about_centre) * all[first];
  }
  return all;
}

JointVector turnOf(const LinearizationPoint& at, const PostureStates& rest) {
  JointVector turn = JointVector::Zero(rest.front().joints());
  for (const PresentEffect& one : at.present) {
    if (one.model->angles) turn += one.model->angles(at, rest, 0) * one.parameters;
  }
  return turn;
}

}  // namespace

JointVector presentTurn(const LinearizationPoint& at, const ArmState& state) { return turnOf(at, {state}); }

ArmState gravityEquilibrium(const frames::LoadingGeometry& geometry, const LinearizationPoint& at, const JointVector& q,
                            double carriage) {
  const JointVector sagged = geometry.sagged(q);
  PostureStates rest;
  ArmState& state = rest.emplace_back(stateMoved(geometry, q, sagged, noBodyMotions(geometry.arm.axes())));
  state.carriage = carriage;
  if (at.present.empty()) return std::move(state);
  const bool turns = at.jointsTurn(), bodies = at.bodiesMove();
  constexpr int kRounds = 5;  // torques change with turns and motions by a hundredth with a strong effect
  for (int round = 0; round < kRounds; ++round) {
    const JointVector turn = turns ? turnOf(at, rest) : JointVector(JointVector::Zero(q.size()));
    if (!bodies) {
      moveTo(geometry, sagged + turn, noBodyMotions(geometry.arm.axes()), state);
      continue;
    }
    const JointVector sag = geometry.springTurns(state.weight_torque);
    const Eigen::Matrix4d before = state.flange.matrix();
    moveTo(geometry, q + sag + turn, motionsOf(at, rest), state);
    constexpr double kSettled = 1e-10;  // m and rad
    if ((state.flange.matrix() - before).cwiseAbs().maxCoeff() < kSettled) break;
  }
  return std::move(state);
}

Eigen::Isometry3d lastBodyNear(const frames::LoadingGeometry& geometry, const LinearizationPoint& at,
                               const ArmState& near) {
  PostureStates rest;
  rest.push_back(stateMoved(geometry, near.q, near.turned, near.moved));
  rest.front().carriage = near.carriage;
  JointVector turned = near.q + geometry.springTurns(rest.front().weight_torque);
  if (at.jointsTurn()) turned += turnOf(at, rest);
  return movedPosture(geometry.arm, turned, motionsOf(at, rest)).motion.back();
}

namespace {

/// Joint angles in place of displacements.
JointAngles anglesByBody(const LinearizationPoint& at, const ArmState& state) {
  const int bodies = state.bodies();
  JointAngles angles = JointAngles::Zero(state.joints(), bodies);
  for (int body = 1; body <= bodies; ++body) {
    const auto b = static_cast<std::size_t>(body);
    robot::Wrench own = state.weight_from_body[b];
    if (body < bodies) {
      own.force -= state.weight_from_body[b + 1].force;
      own.moment -= state.weight_from_body[b + 1].moment;
    }
    JointVector about_axes = JointVector::Zero(bodies);
    for (int j = 0; j < body; ++j) {
      const metrology::Line& axis = state.axes[static_cast<std::size_t>(j)];
      about_axes[j] = axis.direction.dot(own.about(axis.point).moment);
    }
    angles.col(body - 1) = at.compliance.cwiseProduct(state.axes.torques(about_axes));
  }
  return angles;
}

}  // namespace

Eigen::MatrixXd gravityDeflectionByBody(const LinearizationPoint& at, const ArmState& state) {
  return byJoints(state, anglesByBody(at, state));
}

}  // namespace stiffscope::effects
