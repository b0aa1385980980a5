#include "core/audit/hook_fit.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/audit/chance.h"
#include "core/audit/finding.h"
#include "core/robot/kinematics.h"

namespace stiffscope {

namespace {

struct Loaded {
  const State* state = nullptr;
  Eigen::Vector3d force, moment;  ///< in axes that turn with the flange
  Eigen::Matrix3d tool_from_cell = Eigen::Matrix3d::Identity();
};

Eigen::Matrix3d lever(const Eigen::Vector3d& force) {  // lever x F = -F x lever
  Eigen::Matrix3d m;
  m << 0.0, force.z(), -force.y(), -force.z(), 0.0, force.x(), force.y(), -force.x(), 0.0;
  return m;
}

/// Turns a reading into axes of the flange where the cell's own do not turn with it.
Eigen::Matrix3d toolFromCell(const Campaign& campaign, const Vector6d& q) {
  const LoadCell& cell = *campaign.load_cell;
  const std::string& link = cell.axes_link ? *cell.axes_link : cell.parent;
  const Eigen::Matrix3d turned =
      cell.axes_link ? Eigen::Matrix3d::Identity() : Eigen::Matrix3d(cell.parent_from_cell.linear());
  for (const LinkFrame& frame : campaign.robot.links) {
    if (frame.name != link || frame.body == 6) continue;
    const ArmPosture posture = postureAt(campaign.robot, q);
    const Eigen::Matrix3d base_from_link =
        posture.motion[static_cast<std::size_t>(frame.body)].linear() * frame.base_from_link_at_zero.linear();
    return flangeAt(campaign.robot, posture).linear().transpose() * base_from_link * turned;
  }
  return Eigen::Matrix3d::Identity();  // fixed to the flange: one constant turn changes nothing
}

Eigen::Vector3d solve(const std::vector<Loaded>& states) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Loaded& one : states) {
    normal += lever(one.force).transpose() * lever(one.force);
    right += lever(one.force).transpose() * one.moment;
  }
  return normal.ldlt().solve(right);
}

double misfit(const LoadCell& cell, const Loaded& one, const Eigen::Vector3d& at) {
  const Eigen::Matrix3d through = lever(Eigen::Vector3d::UnitX()) * at.x() +
                                  lever(Eigen::Vector3d::UnitY()) * at.y() +
                                  lever(Eigen::Vector3d::UnitZ()) * at.z();
  const Eigen::Matrix3d covariance = cell.moment_sigma * cell.moment_sigma * Eigen::Matrix3d::Identity() +
                                     cell.force_sigma * cell.force_sigma * through * through.transpose();
  const Eigen::Vector3d residual = one.moment - lever(one.force) * at;
  return residual.dot(covariance.ldlt().solve(residual));
}

double total(const LoadCell& cell, const std::vector<Loaded>& states, const Eigen::Vector3d& at) {
  double sum = 0.0;
  for (const Loaded& one : states) sum += misfit(cell, one, at);
  return sum;
}

/// Every way to turn signs round, the fewest first.
std::array<Eigen::Vector3d, 7> signChoices() {
  return {{{-1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, -1}}};
}

Loaded withSigns(Loaded one, const Eigen::Vector3d& signs) {
  one.moment = one.tool_from_cell * signs.asDiagonal() * one.tool_from_cell.transpose() * one.moment;
  return one;
}

std::string namesOf(const Eigen::Vector3d& signs) {
  std::string names;
  const std::array<const char*, 3> kNames{"mx", "my", "mz"};
  for (std::size_t k = 0; k < 3; ++k) {
    if (signs[static_cast<int>(k)] < 0.0) names += (names.empty() ? "" : ", ") + std::string(kNames[k]);
  }
  return names;
}

/// Signs that mend the fit: of the worst state alone, or of all.
std::string mendingSigns(const LoadCell& cell, const std::vector<Loaded>& states, std::size_t worst,
                         double limit) {
  for (const bool all : {false, true}) {
    for (const Eigen::Vector3d& signs : signChoices()) {
      std::vector<Loaded> turned = states;
      for (std::size_t i = 0; i < turned.size(); ++i) {
        if (all || i == worst) turned[i] = withSigns(turned[i], signs);
      }
      if (total(cell, turned, solve(turned)) <= limit) {
        return fmt::format("{}{}", namesOf(signs), all ? " of all states" : " of that state");
      }
    }
  }
  return {};
}

}  // namespace

HookFit fitHook(const Campaign& campaign) {
  HookFit fit;
  const LoadCell& cell = *campaign.load_cell;
  std::vector<Loaded> states;
  states.reserve(campaign.states->rows.size());
  double most = 0.0;
  for (const State& state : campaign.states->rows)
    most = std::max(most, state.wrench_in_cell.head<3>().norm());
  bool any_moment = false;
  for (const State& state : campaign.states->rows) {
    if (state.step == 0 || state.wrench_in_cell.head<3>().norm() < kReturnShare * most)
      continue;
    const Eigen::Matrix3d turn = toolFromCell(campaign, state.q);
    states.push_back(
        {&state, turn * state.wrench_in_cell.head<3>(), turn * state.wrench_in_cell.tail<3>(), turn});
    any_moment |= !state.wrench_in_cell.tail<3>().isZero(0.0);
  }
  constexpr std::size_t kLeast = 4;
  if (states.size() < kLeast) fit.reason = "fewer than four loaded states";
  if (!any_moment) fit.reason = "no moments were measured";
  if (!fit.reason.empty()) return fit;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Loaded& one : states) spread += lever(one.force).transpose() * lever(one.force);
  constexpr double kOneLine = 1e-4;  // squared sine of the forces' spread in the tool
  const Eigen::Vector3d seen = spread.selfadjointView<Eigen::Lower>().eigenvalues();
  if (seen[0] < kOneLine * seen[2]) {
    fit.reason = "the forces lie along one line in the tool: turn the flange between postures";
    return fit;
  }
  fit.lever = solve(states);
  std::size_t worst = 0;
  double squares = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double chi2 = misfit(cell, states[i], fit.lever);
    fit.chi2 += chi2;
    squares += (states[i].moment - lever(states[i].force) * fit.lever).squaredNorm();
    if (chi2 > fit.worst_chi2) fit.worst_chi2 = chi2, worst = i;
  }
  const double count = static_cast<double>(states.size());
  fit.dof = static_cast<int>(3 * states.size()) - 3;
  fit.rms = std::sqrt(squares / (3.0 * count));
  fit.worst_limit = chiSquareLimit(0.5 * kLevel / count, 3.0);
  fit.worst_line = states[worst].state->line;
  fit.worst_pose = states[worst].state->pose;
  fit.worst_step = states[worst].state->step;
  const double limit = chiSquareLimit(kLevel, fit.dof);
  if (fit.chi2 > limit || fit.worst_chi2 > fit.worst_limit)
    fit.mending_signs = mendingSigns(cell, states, worst, limit);
  fit.done = true;
  return fit;
}

}  // namespace stiffscope
