#include "core/diagnosis/system_rows.h"

#include <Eigen/Dense>
#include <algorithm>

#include "core/effects/gravity_equilibrium.h"
#include "core/robot/balancer.h"
#include "core/robot/geometric_stiffness.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::diagnosis {

namespace {

using frames::ArmParameters;

/// What each axis carries: mass, and its first moment about the origin.
struct Carried {
  PerJoint<double> mass;
  PerJoint<Eigen::Vector3d> moment;
};

Carried carriedBy(const robot::GravityLoad& weight, const robot::ArmPosture& posture) {
  const std::size_t axes = weight.bodies.size() - 1;
  Carried carried{PerJoint<double>(axes), PerJoint<Eigen::Vector3d>(axes)};
  double mass = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (std::size_t axis = axes; axis-- > 0;) {
    const robot::BodyMass& body = weight.bodies[axis + 1];
    mass += body.mass_kg;
    moment += body.mass_kg * (posture.motion[axis + 1] * body.com_in_base_at_zero);
    carried.mass[axis] = mass;
    carried.moment[axis] = moment;
  }
  return carried;
}

/// How the joints' torques change with parameter k of the axes; about axis j it is z_j . ((S_j - m_j p_j) x g).
JointVector torqueChange(const effects::ArmState& state, const Carried& carried, const Eigen::Vector3d& gravity,
                         const frames::PlacedPosture& posture, std::size_t k) {
  const std::size_t moved = k / 4;
  const frames::SmallMotion& beyond = posture.beyondAxis(k);
  JointVector change(state.bodies());
  for (std::size_t j = 0; j < state.axes.size(); ++j) {
    const metrology::Line& axis = state.axes[j];
    const std::size_t first = std::max(j, moved);
    const frames::SmallMotion of_axis = j < moved ? frames::SmallMotion{} : (j == moved ? posture.ofAxis(k) : beyond);
    const Eigen::Vector3d arm = carried.moment[j] - carried.mass[j] * axis.point;
    const Eigen::Vector3d arm_change = beyond.rotation.cross(carried.moment[first]) +
                                       carried.mass[first] * beyond.shift - carried.mass[j] * of_axis.at(axis.point);
    change[static_cast<Eigen::Index>(j)] =
        of_axis.rotation.cross(axis.direction).dot(arm.cross(gravity)) + axis.direction.dot(arm_change.cross(gravity));
  }
  return state.axes.torques(change);
}

/// The same of a balancer; about axis j it is z_j . ((x - p_j) x f), f the force on the outer body's end x.
JointVector torqueChange(const effects::ArmState& state, const robot::PlacedBalancer& at,
                         const frames::PlacedPosture& posture, std::size_t k) {
  const int moved = static_cast<int>(k / 4);
  const frames::SmallMotion& beyond = posture.beyondAxis(k);
  const auto changeOf = [&](const Eigen::Vector3d& end, int body) {
    return moved < body ? Eigen::Vector3d(beyond.at(end)) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  };
  const Eigen::Vector3d end_change = changeOf(at.outer_end, at.outer);
  const Eigen::Vector3d apart_change = end_change - changeOf(at.inner_end, at.inner);
  const double longer = at.direction.dot(apart_change);
  const Eigen::Vector3d turned = (apart_change - longer * at.direction) / at.length;
  const Eigen::Vector3d force = at.onOuter();
  const Eigen::Vector3d force_change =
      -(at.tension.slope_n_per_m * longer * at.direction + at.tension.force_n * turned);
  JointVector change = JointVector::Zero(state.bodies());
  for (int j = at.inner; j < at.outer; ++j) {
    const metrology::Line& axis = state.axes[static_cast<std::size_t>(j)];
    const frames::SmallMotion of_axis = j < moved ? frames::SmallMotion{} : (j == moved ? posture.ofAxis(k) : beyond);
    const Eigen::Vector3d arm = at.outer_end - axis.point;
    change[j] = of_axis.rotation.cross(axis.direction).dot(arm.cross(force)) +
                axis.direction.dot((end_change - of_axis.at(axis.point)).cross(force) + arm.cross(force_change));
  }
  return state.axes.torques(change);
}

/// What the effects in the model turn the joints by: by the own weight's torques and by the angles.
struct TurnSlopes {
  JointMatrix by_torque, by_angle;
};

/// By differences: play turns by all of it within a small part of the largest torque, however smooth the
/// rest.
TurnSlopes turnSlopes(const effects::LinearizationPoint& at, const effects::ArmState& state) {
  const int joints = state.joints();
  const JointMatrix none = JointMatrix::Zero(joints, joints);
  TurnSlopes slopes{none, none};
  if (!at.jointsTurn()) return slopes;
  constexpr double kTorqueStep = 1e-6, kLeast = 1e-9;  // of the joint's largest torque; Nm
  constexpr double kAngleStep = 1e-7;                  // rad
  const JointVector here = effects::presentTurn(at, state);
  effects::ArmState there = state;
  for (Eigen::Index j = 0; j < joints; ++j) {
    const double step = std::max(kTorqueStep * at.largest_torque[j], kLeast);
    there.weight_torque[j] += step;
    slopes.by_torque.col(j) = (effects::presentTurn(at, there) - here) / step;
    there.weight_torque[j] = state.weight_torque[j];
    there.turned[j] += kAngleStep;
    slopes.by_angle.col(j) = (effects::presentTurn(at, there) - here) / kAngleStep;
    there.turned[j] = state.turned[j];
  }
  return slopes;
}

/// Joint angles by joint torques: d theta = (C + T) (d tau + K_c d theta) + U d theta.
JointMatrix anglesByTorque(const frames::LoadingGeometry& geometry, const effects::LinearizationPoint& at,
                           const effects::ArmState& state) {
  const TurnSlopes slopes = turnSlopes(at, state);
  const Eigen::Index joints = state.joints();
  const JointMatrix yielding =
      JointMatrix(geometry.springTurns(JointVector::Ones(joints)).asDiagonal()) + slopes.by_torque;
  const JointMatrix stiffening = robot::geometricStiffness(state.axes, state.posture, geometry.weight);
  return solveLu(JointMatrix(JointMatrix::Identity(joints, joints) - yielding * stiffening - slopes.by_angle),
                 yielding);
}

/// Its reflectors where the arm has them, which may be centimetres from where they were read.
effects::ArmState asModelled(const frames::LoadingGeometry& geometry, const effects::ArmState& state) {
  effects::ArmState modelled = state;
  for (std::size_t i = 0; i < state.targets.size(); ++i) {
    modelled.points[i] =
        state.posture.motion.back() * *geometry.targets_at_zero[static_cast<std::size_t>(state.targets[i])];
  }
  return modelled;
}

}  // namespace

PositionByGeometry::PositionByGeometry(const frames::LoadingGeometry& geometry, const effects::LinearizationPoint& at,
                                       const Eigen::Vector3d& centre)
    : geometry_(geometry),
      at_(at),
      layout_(geometry.arm.axes()),
      arm_(frames::axesAtStart(geometry.arm.axes_in_base_at_zero), centre) {
  if (!at.bodiesMove()) return;
  const Eigen::Index steps = layout_.count(geometry.targets_at_zero.size());
  for (Eigen::Index k = 0; k < layout_.axes(); ++k)
    stepped_.push_back(frames::moved(geometry, ArmParameters::kSmall * Eigen::VectorXd::Unit(steps, k), centre));
}

void PositionByGeometry::addSag(const effects::ArmState& modelled, const frames::PlacedPosture& posture,
                                Eigen::MatrixXd& columns) const {
  if (!geometry_.weight.links_known || (geometry_.compliance.isZero() && !at_.jointsTurn())) return;
  const Carried carried = carriedBy(geometry_.weight, modelled.posture);
  effects::JointAngles torques(modelled.joints(), layout_.axes());
  for (Eigen::Index k = 0; k < layout_.axes(); ++k)
    torques.col(k) =
        torqueChange(modelled, carried, geometry_.weight.gravity_in_base, posture, static_cast<std::size_t>(k));
  for (const robot::Balancer& balancer : geometry_.weight.balancers) {
    const robot::PlacedBalancer at = robot::placedAt(balancer, modelled.posture);
    for (Eigen::Index k = 0; k < layout_.axes(); ++k)
      torques.col(k) += torqueChange(modelled, at, posture, static_cast<std::size_t>(k));
  }
  columns.leftCols(layout_.axes()) += effects::byJoints(modelled, anglesByTorque(geometry_, at_, modelled) * torques);
}

void PositionByGeometry::addAxesByDifferences(const effects::ArmState& modelled, Eigen::MatrixXd& columns) const {
  const Eigen::Isometry3d here = effects::lastBodyNear(geometry_, at_, modelled);
  for (std::size_t k = 0; k < stepped_.size(); ++k) {
    const Eigen::Isometry3d there = effects::lastBodyNear(stepped_[k], at_, modelled);
    for (std::size_t i = 0; i < modelled.targets.size(); ++i) {
      const Eigen::Vector3d& at_zero = *geometry_.targets_at_zero[static_cast<std::size_t>(modelled.targets[i])];
      columns.col(static_cast<Eigen::Index>(k)).segment<3>(3 * static_cast<Eigen::Index>(i)) =
          (there * at_zero - here * at_zero) / ArmParameters::kSmall;
    }
  }
}

Eigen::MatrixXd PositionByGeometry::of(const effects::ArmState& state) const {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(state.rows(), layout_.count(geometry_.targets_at_zero.size()));
  const effects::ArmState modelled = asModelled(geometry_, state);
  const frames::PlacedPosture posture(arm_, state.posture);
  for (std::size_t i = 0; i < state.targets.size(); ++i) {
    auto rows = columns.middleRows<3>(3 * static_cast<Eigen::Index>(i));
    if (stepped_.empty()) rows.leftCols(layout_.axes()) = posture.byAxes(modelled.points[i]);
    // The readings' motion moves what was read.
    if (geometry_.r0_from_loading)
      rows.middleCols<ArmParameters::kBase>(layout_.baseAt()) = posture.byBase(state.points[i]);
    rows.middleCols<3>(layout_.targetAt(static_cast<std::size_t>(state.targets[i]))) = posture.byTarget();
  }
  if (stepped_.empty()) {
    addSag(modelled, posture, columns);
  } else {
    addAxesByDifferences(modelled, columns);
  }
  return columns;
}

}  // namespace stiffscope::diagnosis
