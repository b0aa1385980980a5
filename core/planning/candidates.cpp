#include "core/planning/candidates.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <random>

#include "core/identification/cell_wrench.h"
#include "core/input/input_error.h"
#include "core/statics/joint_torque.h"

namespace stiffscope {

namespace {

/// Uniform in [low, high); 53 bits of one draw, so that a seed means the same everywhere.
double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
}

std::string whyNone(const CandidateDraw& draw) {
  std::string text =
      fmt::format("expected limits within which some posture keeps the rules; of {} drawn", draw.drawn);
  for (std::size_t rule = 1; rule < kPostureRules; ++rule) {
    if (draw.broken[rule] == 0) continue;
    text += fmt::format("; {}: {}", wordsFor(static_cast<PostureRule>(rule)), draw.broken[rule]);
  }
  return text;
}

}  // namespace

std::vector<Eigen::Vector3d> loadDirections(const PlanningArm& arm) {
  const Eigen::Vector3d& gravity = arm.geometry.weight.gravity_in_base;
  const Eigen::Matrix3d r0_from_base = arm.geometry.r0_from_base_link.linear();
  const Eigen::Vector3d down =
      gravity.norm() > 0.0 ? Eigen::Vector3d(gravity.normalized()) : Eigen::Vector3d(-r0_from_base.col(2));
  if (!arm.pull) return {down};
  std::vector<Eigen::Vector3d> directions{down};
  for (const int axis : {0, 1}) {
    for (const double sign : {1.0, -1.0}) {
      const Eigen::Vector3d level = sign * r0_from_base.col(axis);
      directions.push_back(level);
      directions.push_back((level + down).normalized());
    }
  }
  return directions;
}

Candidate candidateAt(const PlanningArm& arm, const Vector6d& q, const Eigen::Vector3d& direction) {
  Candidate candidate;
  candidate.q = q;
  candidate.direction = direction;
  LoadCase& load_case = candidate.load_case;
  load_case.q = q;
  load_case.q_sagged = arm.geometry.sagged(q);
  const ArmPosture posture = unloadedPosture(arm.geometry.arm, load_case);
  load_case.axes = axesAt(arm.geometry.arm, posture);
  const Eigen::Isometry3d flange = flangeAt(arm.geometry.arm, posture);
  load_case.wrench = {flange * arm.hook_in_flange, arm.load * direction, Eigen::Vector3d::Zero()};
  const Vector6d torque = jointTorque(load_case.axes, load_case.wrench);
  for (const Eigen::Vector3d& target : arm.targets_in_flange) {
    const Eigen::Vector3d point = flange * target;
    const Matrix36d rows = pointRows(load_case.axes, point, torque);
    candidate.information += rows.transpose() * arm.displacementCovariance(point).llt().solve(rows);
  }
  return candidate;
}

CandidateDraw drawCandidates(const PlanningArm& arm, const PostureRules& rules, int count,
                             std::uint64_t seed) {
  const std::array<JointLimits, 6> box = postureBox(arm.geometry.arm, rules);
  const std::vector<Eigen::Vector3d> directions = loadDirections(arm);
  std::mt19937_64 random(seed);
  CandidateDraw draw;
  constexpr int kTriesEach = 400;
  while (static_cast<int>(draw.kept.size()) < count && draw.drawn < kTriesEach * count) {
    Vector6d q;
    for (std::size_t j = 0; j < 6; ++j)
      q[static_cast<Eigen::Index>(j)] = uniform(random, box[j].lower, box[j].upper);
    const Eigen::Vector3d& direction = directions[random() % directions.size()];
    ++draw.drawn;
    const PostureRule broken =
        brokenRule(arm, rules, postureAt(arm.geometry.arm, arm.geometry.sagged(q)), direction);
    ++draw.broken[static_cast<std::size_t>(broken)];
    if (broken == PostureRule::none) draw.kept.push_back(candidateAt(arm, q, direction));
  }
  if (draw.kept.empty()) throw InputError({"plan"}, "", whyNone(draw));
  return draw;
}

Vector6d expectedReading(const PlanningArm& arm, const Candidate& candidate) {
  // Readings of unit size show the cell's axes and point.
  const ArmPosture posture = unloadedPosture(arm.geometry.arm, candidate.load_case);
  Eigen::Matrix3d axes;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Wrench unit = cellWrench(arm.cell, arm.geometry, posture, {}, {}, Vector6d::Unit(axis));
    axes.col(axis) = unit.force;
    point = unit.point;
  }
  const Wrench at_cell = candidate.load_case.wrench.about(point);
  return (Vector6d() << axes.transpose() * at_cell.force, axes.transpose() * at_cell.moment).finished();
}

}  // namespace stiffscope
