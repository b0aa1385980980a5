#include "core/diagnosis/next_measurement.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/diagnosis/confounding.h"
#include "core/robot/wrench.h"

namespace stiffscope::diagnosis {

namespace {

constexpr double kClearOfFloor = 0.3;  // m, of the flange above base_link's origin

Vector6d somePosture(const robot::Robot& arm, std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0.05, 0.95);
  Vector6d q;
  for (Eigen::Index j = 0; j < 6; ++j) {
    const robot::JointLimits& limits = arm.limits[static_cast<std::size_t>(j)];
    const double low = std::max(limits.lower, -std::numbers::pi), high = std::min(limits.upper, std::numbers::pi);
    q[j] = low + share(random) * (high - low);
  }
  return q;
}

/// Whitened normal equations of one more posture: unloaded, and under one force.
Eigen::MatrixXd normalOf(const SystemInput& input, const GapFit& fit, const Vector6d& q, const Eigen::Vector3d& force) {
  const GapPosture& like = fit.data.postures.front();
  const effects::ArmState& seen = like.states[effects::heaviestState(like.states)];
  effects::ArmState rest = effects::stateAt(fit.state.geometry, q, Vector6d::Zero());
  rest.pose = like.pose;
  rest.targets = like.states.front().targets;
  for (const int target : rest.targets) {
    rest.points.push_back(
        rest.posture.motion[6] *
        fit.state.geometry.targets_at_zero[static_cast<std::size_t>(target)].value_or(Eigen::Vector3d::Zero()));
  }
  effects::ArmState loaded = rest;
  loaded.loaded = true;
  loaded.step = 1;
  loaded.cell_axes = rest.flange.linear() * seen.flange.linear().transpose() * seen.cell_axes;
  loaded.load = {rest.flange * (seen.flange.inverse() * seen.load.point), force, Eigen::Vector3d::Zero()};
  loaded.load_torque = robot::jointTorque(fit.state.geometry.arm, rest.posture, loaded.load);
  const effects::PostureStates states{rest, loaded};
  const Eigen::Index rows = rest.rows();
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(rows, fit.data.layout.end + 1);
  columns.leftCols<6>() = effects::byEachJoint(rest, loaded.load_torque);
  for (std::size_t m = 0; m < input.models.size(); ++m) {
    const Eigen::MatrixXd field =
        input.models[m].columns(fit.state.at, states, 1) - input.models[m].columns(fit.state.at, states, 0);
    columns.middleCols(fit.data.layout.model_at[m], field.cols()) = field;
  }
  const double sd = std::hypot(fit.data.state_noise, fit.state.model_error);
  columns /= sd > 0.0 ? sd : 1.0;
  return columns.transpose() * columns;
}

double leastSeparation(const SystemInput& input, const GapFit& fit, const std::vector<bool>& allowed, const Tie& tie,
                       const Projection& projection) {
  const ChosenModel& chosen = fit.set.models[tie.chosen];
  const Eigen::Index at = fit.data.layout.model_at[chosen.model] - fit.data.layout.effects;
  const auto size = static_cast<Eigen::Index>(input.models[chosen.model].parameters());
  Eigen::VectorXd field = Eigen::VectorXd::Zero(fit.set.effects.size());
  field.segment(at, size) = fit.set.effects.segment(at, size);
  std::vector<ChosenModel> others = fit.set.models;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(tie.chosen));
  const Projection made = withField(projection, field);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t m = 0; m < input.models.size(); ++m) {
    const effects::Effect effect = input.models[m].effect;
    const bool tied = std::find(tie.effects.begin() + 1, tie.effects.end(), effect) != tie.effects.end();
    if (tied && allowed[m]) least = std::min(least, separation(input, fit, made, others, m, allowed));
  }
  return least;
}

}  // namespace

std::optional<NextMeasurement> nextFor(const SystemInput& input, const GapFit& fit, const std::vector<bool>& allowed,
                                       const Tie& tie, std::uint64_t seed) {
  const Eigen::MatrixXd now = sumOf(fit.data, std::vector<double>(fit.data.postures.size(), 1.0));
  const double before = leastSeparation(input, fit, allowed, tie, project(now, fit.data.layout.effects));
  std::mt19937_64 random(seed);
  const double force = fit.state.at.largest_force;
  const double floor = fit.state.at.r0_from_base_link.translation().z() + kClearOfFloor;
  double best = before;
  NextMeasurement next;
  constexpr int kPostures = 40;
  for (int k = 0; k < kPostures; ++k) {
    const Vector6d q = somePosture(input.campaign.robot, random);
    if (effects::stateAt(fit.state.geometry, q, Vector6d::Zero()).flange.translation().z() < floor) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::MatrixXd more = now + normalOf(input, fit, q, force * Eigen::Vector3d::Unit(axis));
      const double apart = leastSeparation(input, fit, allowed, tie, project(more, fit.data.layout.effects));
      if (apart <= best) continue;
      best = apart;
      next.what = Remark(RemarkId::posture_that_separates, std::vector<double>(q.begin(), q.end()), force, axis,
                         kSeparated, before, apart);
    }
  }
  if (best <= before) return std::nullopt;
  next.separates = tie.effects;
  next.gain = best - before;
  return next;
}

}  // namespace stiffscope::diagnosis
