#include "core/effects/arm_state.h"

#include <algorithm>

#include "core/robot/balancer.h"
#include "core/robot/kinematics.h"

namespace stiffscope::effects {

BodyMotions noBodyMotions(int bodies) {
  return BodyMotions(static_cast<std::size_t>(bodies) + 1, Eigen::Isometry3d::Identity());
}

robot::ArmPosture movedPosture(const robot::Robot& arm, const JointVector& turned, const BodyMotions& moved) {
  robot::ArmPosture posture = robot::postureAt(arm, turned);
  for (std::size_t b = 0; b < moved.size(); ++b) posture.motion[b] = moved[b] * posture.motion[b];
  return posture;
}

CompactPosture::CompactPosture(const PostureStates& posture) {
  const ArmState& rest = posture.front();
  pose_ = rest.pose;
  carriage_ = rest.carriage;
  q_ = rest.q;
  turned_ = rest.turned;
  const auto isMoved = [](const Eigen::Isometry3d& motion) { return motion.matrix() != Eigen::Matrix4d::Identity(); };
  if (std::any_of(rest.moved.begin(), rest.moved.end(), isMoved)) moved_.assign(rest.moved.begin(), rest.moved.end());
  flange_ = rest.flange;
  targets_ = rest.targets;
  points_ = rest.points;
  of_states_.reserve(posture.size());
  for (const ArmState& state : posture)
    of_states_.push_back({state.step, state.time_s, state.loaded, state.cell_axes, state.load, state.load_torque});
}

PostureStates CompactPosture::states(const frames::LoadingGeometry& geometry) const {
  BodyMotions moved = noBodyMotions(geometry.arm.axes());
  std::copy(moved_.begin(), moved_.end(), moved.begin());
  ArmState rest = stateMoved(geometry, q_, turned_, moved);
  rest.pose = pose_;
  rest.carriage = carriage_;
  rest.flange = flange_;
  rest.targets = targets_;
  rest.points = points_;
  PostureStates states(of_states_.size(), rest);
  for (std::size_t s = 0; s < states.size(); ++s) {
    const OfState& own = of_states_[s];
    states[s].step = own.step;
    states[s].time_s = own.time_s;
    states[s].loaded = own.loaded;
    states[s].cell_axes = own.cell_axes;
    states[s].load = own.load;
    states[s].load_torque = own.load_torque;
  }
  return states;
}

ArmState stateAt(const frames::LoadingGeometry& geometry, const JointVector& q, const JointVector& joint_offset) {
  return stateMoved(geometry, q, geometry.sagged(q) + joint_offset, noBodyMotions(geometry.arm.axes()));
}

ArmState stateMoved(const frames::LoadingGeometry& geometry, const JointVector& q, const JointVector& turned,
                    const BodyMotions& moved) {
  ArmState state;
  state.q = q;
  state.load_torque = JointVector::Zero(q.size());
  moveTo(geometry, turned, moved, state);
  return state;
}

void moveTo(const frames::LoadingGeometry& geometry, const JointVector& turned, const BodyMotions& moved,
            ArmState& state) {
  state.turned = turned;
  state.moved = moved;
  state.posture = movedPosture(geometry.arm, turned, moved);
  placeByPosture(geometry, state);
}

void placeByPosture(const frames::LoadingGeometry& geometry, ArmState& state) {
  state.axes = robot::axesAt(geometry.arm, state.posture);
  state.weight_torque = JointVector::Zero(geometry.arm.joints());
  state.weight_from_body.assign(state.posture.motion.size(), robot::Wrench());
  state.balancers_from_body.clear();
  state.flange = robot::flangeAt(geometry.arm, state.posture);
  if (!geometry.weight.links_known) return;
  robot::Wrench sum;
  JointVector about_axes(state.bodies());
  for (std::size_t b = state.axes.size(); b >= 1; --b) {
    const robot::BodyMass& body = geometry.weight.bodies[b];
    const Eigen::Vector3d pull = body.mass_kg * geometry.weight.gravity_in_base;
    sum.force += pull;
    sum.moment += (state.posture.motion[b] * body.com_in_base_at_zero).cross(pull);
    state.weight_from_body[b] = sum;
    const metrology::Line& axis = state.axes[b - 1];
    about_axes[static_cast<Eigen::Index>(b) - 1] = axis.direction.dot(sum.moment - axis.point.cross(sum.force));
  }
  if (!geometry.weight.balancers.empty())
    state.balancers_from_body.assign(state.posture.motion.size(), robot::Wrench());
  for (const robot::Balancer& balancer : geometry.weight.balancers) {
    about_axes += robot::balancerTorque(state.axes, state.posture, balancer);
    robot::addBalancerForces(balancer, state.posture, state.balancers_from_body);
  }
  state.weight_torque = state.axes.torques(about_axes);
  state.weight_from_body[0] = sum;
}

robot::Wrench carried(const ArmState& state, int body, const Eigen::Vector3d& about) {
  robot::Wrench sum = state.load.about(about);
  const robot::Wrench weight = state.weight_from_body[static_cast<std::size_t>(body)].about(about);
  sum.force += weight.force;
  sum.moment += weight.moment;
  if (state.balancers_from_body.empty()) return sum;
  const robot::Wrench balancers = state.balancers_from_body[static_cast<std::size_t>(body)].about(about);
  sum.force += balancers.force;
  sum.moment += balancers.moment;
  return sum;
}

Eigen::MatrixXd byJoints(const ArmState& state, const JointAngles& angles) {
  Eigen::MatrixXd rows(state.rows(), angles.cols());
  for (std::size_t t = 0; t < state.points.size(); ++t) {
    const PointJacobian jacobian = robot::pointJacobianAt(state.axes, state.points[t]);
    rows.middleRows<3>(3 * static_cast<Eigen::Index>(t)) = jacobian * angles;
  }
  return rows;
}

Eigen::MatrixXd byEachJoint(const ArmState& state, const JointVector& angles) {
  return byJoints(state, JointAngles(JointMatrix(angles.asDiagonal())));
}

Eigen::VectorXd byMotion(const ArmState& state, const Eigen::Vector3d& pivot, const Eigen::Vector3d& rotation,
                         const Eigen::Vector3d& shift) {
  Eigen::VectorXd rows(state.rows());
  for (std::size_t t = 0; t < state.points.size(); ++t) {
    rows.segment<3>(3 * static_cast<Eigen::Index>(t)) = rotation.cross(state.points[t] - pivot) + shift;
  }
  return rows;
}

std::size_t heaviestState(const PostureStates& posture) {
  std::size_t heaviest = 0;
  for (std::size_t i = 1; i < posture.size(); ++i) {
    if (posture[i].load.force.norm() > posture[heaviest].load.force.norm()) heaviest = i;
  }
  return heaviest;
}

}  // namespace stiffscope::effects
