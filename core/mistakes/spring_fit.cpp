#include "core/mistakes/spring_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/identification/load_point.h"
#include "core/robot/kinematics.h"
#include "metrology/linear_algebra.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::mistakes {

CellReading asDeclared(const campaign::LoadCell& cell) {
  CellReading reading;
  reading.parent = cell.parent;
  reading.parent_from_cell = cell.parent_from_cell;
  reading.axes_link = cell.axes_link;
  return reading;
}

LoadsOfDay::LoadsOfDay(const ReadingsOfDay& day, const NominalFit& arm)
    : robot_(day.robot), down_(day.weight.gravity_in_base.normalized()) {
  if (!arm.done) return;
  for (const LoadedReading& reading : day.loaded) {
    State state;
    state.pose = reading.pose;
    state.step = reading.step;
    if (poses_.empty() || poses_.back() != reading.pose) {
      const auto known = std::find(poses_.begin(), poses_.end(), reading.pose);
      if (known == poses_.end()) poses_.push_back(reading.pose);
    }
    state.at = static_cast<std::size_t>(std::find(poses_.begin(), poses_.end(), reading.pose) - poses_.begin());
    state.posture = robot::postureAt(robot_, reading.q);
    state.axes = robot::axesAt(robot_, state.posture);
    state.flange = robot::flangeAt(robot_, state.posture);
    state.wrench = reading.wrench;
    for (const ReflectorMove& move : reading.moves) {
      const Eigen::Vector3d at = state.flange * arm.reflectors_in_flange[static_cast<std::size_t>(move.target)];
      state.moves.push_back(
          {robot::pointJacobianAt(state.axes, at), arm.scale * (arm.base_from_points.linear() * move.displacement)});
    }
    states_.push_back(std::move(state));
  }
}

const LoadsOfDay::State* LoadsOfDay::find(int pose, int step) const {
  for (const State& state : states_) {
    if (state.pose == pose && state.step == step) return &state;
  }
  return nullptr;
}

Eigen::Isometry3d LoadsOfDay::linkOf(const State& state, const std::string& name) const {
  for (const robot::LinkFrame& link : robot_.links) {
    if (link.name == name)
      return state.posture.motion[static_cast<std::size_t>(link.body)] * link.base_from_link_at_zero;
  }
  return state.flange;
}

Eigen::Isometry3d LoadsOfDay::parentOf(const State& state, const CellReading& cell) const {
  return linkOf(state, cell.parent);
}

JointVector LoadsOfDay::torqueOf(const State& state, const Applied& load) {
  JointVector torque(static_cast<Eigen::Index>(state.axes.size()));
  for (std::size_t j = 0; j < state.axes.size(); ++j) {
    const metrology::Line& axis = state.axes[j];
    torque[static_cast<Eigen::Index>(j)] =
        axis.direction.dot(load.moment + (load.point - axis.point).cross(load.force));
  }
  return state.axes.torques(torque);
}

Eigen::Matrix3d LoadsOfDay::axesOf(const State& state, const CellReading& cell) const {
  return cell.axes_link ? linkOf(state, *cell.axes_link).linear()
                        : Eigen::Matrix3d(parentOf(state, cell).linear() * cell.parent_from_cell.linear());
}

LoadsOfDay::Applied LoadsOfDay::applied(const State& state, const CellReading& cell, const Vector6d& wrench) const {
  const Eigen::Isometry3d at = parentOf(state, cell) * cell.parent_from_cell;
  const Eigen::Matrix3d axes = axesOf(state, cell);
  const Eigen::Vector3d force = cell.moments_first ? wrench.tail<3>() : wrench.head<3>(),
                        moment = cell.moments_first ? wrench.head<3>() : wrench.tail<3>();
  return {axes * (cell.on_force * force), axes * (cell.on_moment * moment), at.translation()};
}

std::optional<Eigen::Matrix3d> LoadsOfDay::turnToGravity(const CellReading& cell) const {
  if (cell.axes_link) return std::nullopt;
  // Wahba: the turn of the readings onto gravity as the cell's axes stand.
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const State& state : states_) {
    const Eigen::Vector3d there = (parentOf(state, cell).linear() * cell.parent_from_cell.linear()).transpose() * down_;
    sum += there * (cell.on_force * state.wrench.head<3>()).transpose();
  }
  return metrology::nearestRotation(sum).rotation;
}

/// Joint torques by three parameters of the cell.
using ByThree = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, kMostJoints, 3>;

/// Bilinear in springs and three parameters of the cell: Gauss-Newton in both. `by_parameters(state, load)` are the
/// torques' derivatives, a row a joint; `take` takes a step up.
template <class ByParameters, class Take>
void LoadsOfDay::fitCell(CellReading& cell, const ByParameters& by_parameters, const Take& take) const {
  JointVector c = fit(cell).compliance;
  const Eigen::Index joints = c.size(), size = joints + 3;
  using Normal =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostJoints + 3, kMostJoints + 3>;
  using Right = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostJoints + 3, 1>;
  constexpr int kRounds = 12;
  for (int round = 0; round < kRounds; ++round) {
    Normal normal = Normal::Zero(size, size);
    Right right = Right::Zero(size);
    for (const State& state : states_) {
      const Applied load = applied(state, cell, state.wrench);
      const JointVector torque = torqueOf(state, load);
      const ByThree columns = by_parameters(state, load);
      for (const Move& move : state.moves) {
        Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kMostJoints + 3> rows(3, size);
        rows << move.jacobian * torque.asDiagonal(), move.jacobian * c.asDiagonal() * columns;
        const Eigen::Vector3d left = move.displacement - rows.leftCols(joints) * c;
        normal += rows.transpose() * rows;
        right += rows.transpose() * left;
      }
    }
    // Compliances are a millionth of lengths: held each in parts of its own column.
    const Right scale = normal.diagonal().cwiseMax(1e-30).cwiseSqrt();
    normal = scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
    normal.diagonal().array() += 1e-6;
    const Right step = normal.ldlt().solve(right.cwiseQuotient(scale)).cwiseQuotient(scale);
    c += step.head(joints);
    take(Eigen::Vector3d(step.tail<3>()));
  }
}

namespace {

/// Rows a joint, by rows an axis.
ByThree ofJoints(const robot::ArmAxes& axes, const ByThree& by_axes) {
  return axes.couplings ? ByThree(axes.couplings->turns.transpose() * by_axes) : by_axes;
}

}  // namespace

Eigen::Vector3d LoadsOfDay::bestPoint(const CellReading& cell) const {
  CellReading moved = cell;
  const auto columns = [&](const State& state, const Applied& load) {
    const Eigen::Matrix3d parent = parentOf(state, moved).linear();
    ByThree by_point(static_cast<Eigen::Index>(state.axes.size()), 3);
    for (std::size_t j = 0; j < state.axes.size(); ++j) {
      // z . (d x F) = d . (F x z)
      by_point.row(static_cast<Eigen::Index>(j)) = load.force.cross(state.axes[j].direction).transpose() * parent;
    }
    return ofJoints(state.axes, by_point);
  };
  fitCell(moved, columns, [&](const Eigen::Vector3d& step) { moved.parent_from_cell.translation() += step; });
  return moved.parent_from_cell.translation();
}

Eigen::Matrix3d LoadsOfDay::bestTurn(const CellReading& cell) const {
  CellReading turned = cell;
  const auto columns = [&](const State& state, const Applied& load) {
    // A small turn d in the cell's axes: z . (A d x M + r x (A d x F)) = d . A^T (M x z + F x (z x r)), r from the
    // axis.
    const Eigen::Matrix3d axes = axesOf(state, turned);
    ByThree by_turn(static_cast<Eigen::Index>(state.axes.size()), 3);
    for (std::size_t j = 0; j < state.axes.size(); ++j) {
      const Eigen::Vector3d z = state.axes[j].direction, r = load.point - state.axes[j].point;
      by_turn.row(static_cast<Eigen::Index>(j)) =
          (load.moment.cross(z) + load.force.cross(z.cross(r))).transpose() * axes;
    }
    return ofJoints(state.axes, by_turn);
  };
  fitCell(turned, columns, [&](const Eigen::Vector3d& step) {
    constexpr double kMostStep = 0.5;  // rad
    const double angle = std::min(step.norm(), kMostStep);
    if (angle <= 0.0) return;
    const Eigen::Matrix3d by = Eigen::AngleAxisd(angle, step.normalized()).toRotationMatrix();
    turned.on_force = by * turned.on_force;
    turned.on_moment = by * turned.on_moment;
  });
  return turned.on_force;
}

namespace {

struct Sums {
  JointMatrix normal;  // none before the first
  JointVector right;
  double squares = 0.0;

  Sums& operator+=(const Sums& other) {
    if (other.right.size() == 0) return *this;
    if (right.size() == 0) return *this = other;
    normal += other.normal;
    right += other.right;
    squares += other.squares;
    return *this;
  }
};

/// min |A c - d| over c >= 0: joints whose compliance comes out negative are left out, the most negative first.
JointVector positiveSolution(const Sums& sums) {
  const Eigen::Index joints = sums.right.size();
  robot::JointMask used(static_cast<std::size_t>(joints), true);
  for (Eigen::Index round = 0; round < joints; ++round) {
    JointMatrix normal = sums.normal;
    JointVector right = sums.right;
    for (Eigen::Index j = 0; j < joints; ++j) {
      // A column of a thousandth of the others' weight is what tilt and noise put there: it explains nothing.
      normal(j, j) += 1e-6 * sums.normal.diagonal().maxCoeff();
      if (used[static_cast<std::size_t>(j)]) continue;
      normal.row(j).setZero();
      normal.col(j).setZero();
      normal(j, j) = 1.0;
      right[j] = 0.0;
    }
    const JointVector found = solvePositive(normal, right);
    Eigen::Index worst = 0;
    const double least = (found.array() * sums.normal.diagonal().array().sqrt()).minCoeff(&worst);
    if (least >= 0.0) return found;
    used[static_cast<std::size_t>(worst)] = false;
  }
  return JointVector::Zero(joints);
}

double leftOf(const Sums& sums, const JointVector& c) {
  if (sums.right.size() == 0) return 0.0;
  return std::max(0.0, sums.squares - 2.0 * c.dot(sums.right) + c.dot(sums.normal * c));
}

}  // namespace

template <class WrenchOf>
SpringFit LoadsOfDay::fitBy(const WrenchOf& wrench_of) const {
  SpringFit fit;
  fit.compliance = JointVector::Zero(robot_.joints());
  std::vector<Sums> by_pose(poses_.size());
  std::map<int, Sums> by_step;
  std::vector<std::size_t> pose_of;
  Sums all;
  std::vector<identification::ToolLoad> loads;
  std::vector<Applied> in_base;
  double largest = 0.0;
  for (const State& state : states_) {
    const std::optional<Applied> load = wrench_of(state);
    if (!load) continue;
    in_base.push_back(*load);
    pose_of.push_back(state.at);
    largest = std::max(largest, load->force.norm());
    const Eigen::Matrix3d to_tool = state.flange.linear().transpose();
    loads.push_back({to_tool * load->force, to_tool * load->moment});
    const JointVector torque = torqueOf(state, *load);
    Sums sums{JointMatrix::Zero(torque.size(), torque.size()), JointVector::Zero(torque.size())};
    for (const Move& move : state.moves) {
      const PointJacobian rows = move.jacobian * torque.asDiagonal();
      sums.normal += rows.transpose() * rows;
      sums.right += rows.transpose() * move.displacement;
      sums.squares += move.displacement.squaredNorm();
    }
    by_pose[state.at] += sums;
    by_step[state.step] += sums;
  }
  for (const Sums& sums : by_pose) all += sums;
  if (all.squares <= 0.0 || largest <= 0.0) {  // nothing moves or nothing pulls: nothing is explained
    fit.pose_left.assign(poses_.size(), 1.0);
    fit.pose_off_gravity.assign(poses_.size(), std::numbers::pi);
    fit.pose_along_lever.assign(poses_.size(), 0.0);
    return fit;
  }
  fit.compliance = positiveSolution(all);
  fit.left = std::sqrt(leftOf(all, fit.compliance) / all.squares);
  for (const Sums& sums : by_pose)
    fit.pose_left.push_back(sums.squares > 0.0 ? std::sqrt(leftOf(sums, fit.compliance) / sums.squares) : 0.0);
  for (const auto& [step, sums] : by_step) {
    const double modelled = fit.compliance.dot(sums.normal * fit.compliance);
    if (modelled > 1e-4 * all.squares) fit.step_moves[step] = fit.compliance.dot(sums.right) / modelled;
  }
  const identification::LoadPointFit lever(loads);
  const Eigen::Vector3d point = lever.point(1e-9 * largest * largest);
  fit.lever = point.norm();
  struct Figures {
    double angles = 0.0, count = 0.0, moments = 0.0, off = 0.0;
    // Of forces too small to have a direction: any.
    double angle() const { return count > 0.0 ? std::sqrt(angles / count) : std::numbers::pi; }
    double lever() const { return moments > 0.0 ? std::sqrt(off / moments) : 0.0; }
  };
  std::vector<Figures> figures(poses_.size() + 1);  // the last of all
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const double off = (loads[i].moment - identification::momentByPoint(loads[i].force) * point).squaredNorm();
    for (const std::size_t at : {pose_of[i], poses_.size()}) {
      figures[at].moments += loads[i].moment.squaredNorm();
      figures[at].off += off;
    }
    constexpr double kClear = 0.2;  // of the largest force: smaller ones have no direction to speak of
    if (in_base[i].force.norm() < kClear * largest) continue;
    const double angle = std::atan2(in_base[i].force.cross(down_).norm(), in_base[i].force.dot(down_));
    for (const std::size_t at : {pose_of[i], poses_.size()}) {
      figures[at].angles += angle * angle;
      figures[at].count += 1.0;
    }
  }
  for (std::size_t at = 0; at < poses_.size(); ++at) {
    fit.pose_off_gravity.push_back(figures[at].angle());
    fit.pose_along_lever.push_back(figures[at].lever());
  }
  fit.off_gravity = figures.back().angle();
  fit.along_lever = figures.back().lever();
  return fit;
}

SpringFit LoadsOfDay::fit(const CellReading& cell) const {
  return fitBy([&](const State& state) -> std::optional<Applied> {
    const State* from = &state;
    switch (cell.row) {
      case WrenchRow::own:
        break;
      case WrenchRow::previous_step:
        from = find(state.pose, state.step - 1);
        break;
      case WrenchRow::next_step:
        from = find(state.pose, state.step + 1);
        break;
      case WrenchRow::previous_posture:
        from = state.at > 0 ? find(poses_[state.at - 1], state.step) : nullptr;
        break;
      case WrenchRow::next_posture:
        from = state.at + 1 < poses_.size() ? find(poses_[state.at + 1], state.step) : nullptr;
        break;
    }
    if (from == nullptr) return std::nullopt;
    return applied(state, cell, from->wrench);
  });
}

SpringFit LoadsOfDay::fitExchanged(const CellReading& cell, int pose, int other) const {
  return fitBy([&](const State& state) -> std::optional<Applied> {
    const State* from = &state;
    if (state.pose == pose) from = find(other, state.step);
    if (state.pose == other) from = find(pose, state.step);
    if (from == nullptr) return std::nullopt;
    return applied(state, cell, from->wrench);
  });
}

SpringFit LoadsOfDay::fitScaled(const CellReading& cell, int step, double factor) const {
  return fitBy([&](const State& state) -> std::optional<Applied> {
    return applied(state, cell, state.step == step ? Vector6d(factor * state.wrench) : state.wrench);
  });
}

SpringFit LoadsOfDay::fitAtPose(const CellReading& cell, int pose, const CellReading& there) const {
  return fitBy([&](const State& state) -> std::optional<Applied> {
    return applied(state, state.pose == pose ? there : cell, state.wrench);
  });
}

}  // namespace stiffscope::mistakes
