#include "core/audit/redundancies.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/audit/remarks.h"
#include "core/campaign/row_names.h"
#include "core/identification/identifiability.h"
#include "core/identification/load_point.h"
#include "core/identification/warnings.h"
#include "core/mistakes/load_search.h"
#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"
#include "core/preparation/remarks.h"
#include "core/robot/kinematics.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::audit {

namespace {

preparation::AuditCheck tareCheck(const AuditInput& input) {
  const campaign::LoadCell& cell = *input.campaign.load_cell;
  Vector6d sum = Vector6d::Zero();
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(cell.force_sigma), Eigen::Vector3d::Constant(cell.moment_sigma);
  double worst = 0.0;
  const campaign::State* worst_state = nullptr;
  int count = 0;
  for (const campaign::State& state : input.campaign.states->rows) {
    if (state.step != 0) continue;
    sum += state.wrench_in_cell;
    ++count;
    const double chi2 = state.wrench_in_cell.cwiseQuotient(sigma).squaredNorm();
    if (worst_state == nullptr || chi2 > worst) worst = chi2, worst_state = &state;
  }
  if (worst_state == nullptr) return preparation::notTestable("tare", Remark(MissingId::no_unloaded_states));
  const Vector6d mean = sum / count;
  const double of_mean = count * mean.cwiseQuotient(sigma).squaredNorm();
  preparation::AuditCheck check;
  check.id = "tare";
  check.value = std::sqrt(of_mean / 6.0);
  check.limit = std::sqrt(numerics::chiSquareLimit(0.5 * preparation::kLevel, 6.0) / 6.0);
  check.limit_source = preparation::byChance(Remark(LimitId::chi_square_of_tare));
  const auto says = [&mean](std::vector<Remark> more) {
    return Remark(RemarkId::unloaded_reading, std::vector<double>(mean.begin(), mean.end()), std::move(more));
  };
  check.message = says({});
  const bool one_off = worst > numerics::chiSquareLimit(0.5 * preparation::kLevel / count, 6.0);
  if (*check.value <= *check.limit && !one_off) return check;
  check.verdict = preparation::AuditVerdict::warn;
  check.where = preparation::atRow(input.campaign.states->file, worst_state->line);
  const mistakes::CellZero& zero = input.zero;
  check.message = says({zero.drifts ? Remark(RemarkId::zero_drifts, zero.drift_force, zero.drift_moment, zero.hours)
                        : *check.value > *check.limit
                            ? Remark(RemarkId::not_tared)
                            : Remark(RemarkId::one_pose_off, campaign::poseName(input.campaign, worst_state->pose),
                                     std::sqrt(worst / 6.0))});
  return check;
}

preparation::AuditCheck gravityCheck(const AuditInput& input) {
  const identification::LoadedArm& arm = input.arm;
  if (arm.cases.empty()) return preparation::notTestable("gravity_direction", Remark(MissingId::no_compared_postures));
  const identification::Identifiability judged = identification::evaluateIdentifiability(
      arm.geometry, arm.cases, *input.campaign.load_cell, identification::reflectorEquations(arm));
  if (!judged.load_hangs) return preparation::notTestable("gravity_direction", Remark(MissingId::load_does_not_hang));
  const Eigen::Vector3d down = arm.geometry.weight.gravity_in_base.normalized();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double least_force = INFINITY, farthest = -1.0;
  const identification::LoadCase* worst = nullptr;
  for (const identification::LoadCase& load_case : arm.cases) {
    const Eigen::Vector3d force = load_case.wrench.force;
    mean += force.normalized() / static_cast<double>(arm.cases.size());
    least_force = std::min(least_force, force.norm());
    const double angle = std::atan2(force.cross(down).norm(), force.dot(down));
    if (angle > farthest) farthest = angle, worst = &load_case;
  }
  preparation::AuditCheck check;
  check.id = "gravity_direction";
  check.value = judged.gravity_angle_rms;
  // Two directions: the load cell's turn as identification trusts it, and what its noise adds to one reading.
  check.limit =
      std::hypot(identification::TrustLimits().direction, input.campaign.load_cell->force_sigma / least_force) *
      std::sqrt(numerics::chiSquareLimit(preparation::kLevel, 2.0));
  check.limit_source = Remark(LimitId::load_cell_axes);
  const std::string& pose = campaign::poseName(input.campaign, worst->pose);
  const auto says = [&](std::vector<Remark> more) {
    return Remark(RemarkId::force_off_gravity, *check.value, std::atan2(mean.cross(down).norm(), mean.dot(down)),
                  farthest, pose, std::move(more));
  };
  check.message = says({});
  if (*check.value <= *check.limit) return check;
  check.verdict = preparation::AuditVerdict::warn;
  check.where = Remark(RemarkId::at_pose, pose);
  check.message = says({Remark(RemarkId::cell_rope_or_base)});
  return check;
}

preparation::AuditCheck leverCheck(const AuditInput& input) {
  const LoadPointFit fit = fitLoadPoint(input.campaign);
  if (!fit.done) return preparation::notTestable("moment_lever", fit.reason);
  preparation::AuditCheck check;
  check.id = "moment_lever";
  check.value = std::sqrt(fit.chi2 / fit.dof);
  check.limit = std::sqrt(numerics::chiSquareLimit(0.5 * preparation::kLevel, fit.dof) / fit.dof);
  check.limit_source = preparation::byChance(Remark(LimitId::chi_square_and_states, fit.dof));
  const auto says = [&fit](std::vector<Remark> more) {
    return Remark(RemarkId::moments_of_force, std::vector<double>(fit.lever.begin(), fit.lever.end()), fit.rms,
                  std::move(more));
  };
  check.message = says({});
  if (fit.lever.norm() > kLongestLever && mistakes::forcesStandOut(input.campaign)) {
    check.verdict = preparation::AuditVerdict::fail;
    check.impossible = true;
    check.message = says({Remark(RemarkId::lever_too_long)});
    return check;
  }
  if (*check.value <= *check.limit && fit.worst_chi2 <= fit.worst_limit) return check;
  check.verdict = fit.chi2 / fit.dof > preparation::kFailVarianceRatio ? preparation::AuditVerdict::fail
                                                                       : preparation::AuditVerdict::warn;
  const std::string row = campaign::rowName(input.campaign.states->file, fit.worst_line);
  check.where = Remark(preparation::RemarkId::at_name, row);
  std::vector<Remark> more{
      Remark(RemarkId::worst_state, row, campaign::poseName(input.campaign, fit.worst_pose), fit.worst_step)};
  if (!fit.mending_signs.empty()) more.push_back(Remark(RemarkId::signs_mend, fit.mending_signs, fit.mends_all_states));
  check.message = says(std::move(more));
  return check;
}

}  // namespace

Findings checkLoadCell(const AuditInput& input) {
  const campaign::Campaign& campaign = input.campaign;
  if (!campaign.load_cell || !campaign.states || campaign::isUnloadedDay(campaign)) {
    Findings missing;
    for (const char* id : {"tare", "gravity_direction", "moment_lever"}) {
      missing.push_back(preparation::notTestable(id, Remark(MissingId::no_load_cell_readings)));
    }
    return missing;
  }
  const bool stated = campaign.load_cell->force_sigma > 0.0 && campaign.load_cell->moment_sigma > 0.0;
  const auto notStated = [](const char* id) {
    return preparation::notTestable(id, Remark(MissingId::load_cell_noise_not_stated));
  };
  return {stated ? tareCheck(input) : notStated("tare"), gravityCheck(input),
          stated ? leverCheck(input) : notStated("moment_lever")};
}

Findings checkLoadSize(const AuditInput& input) {
  const auto apparent = identification::apparentStiffness(input.arm.cases);
  if (!apparent) return {preparation::notTestable("load_size", Remark(MissingId::no_displacement_under_force))};
  const double value = apparent->value();
  const Remark found = identification::implausibleLoad(*apparent);
  preparation::AuditCheck check;
  check.id = "load_size";
  check.value = value;
  check.limit = value > identification::kStiffArm ? identification::kStiffArm : identification::kSoftArm;
  check.limit_source = Remark(LimitId::arms_stiffness, identification::kSoftArm, identification::kStiffArm);
  check.message = found.empty() ? Remark(RemarkId::load_moves, apparent->force, apparent->displacement) : found;
  if (found.empty()) return {check};
  check.impossible = (value < identification::kSofterThanAnyArm || value > identification::kStifferThanAnyArm) &&
                     mistakes::forcesStandOut(input.campaign);
  check.verdict = check.impossible ? preparation::AuditVerdict::fail : preparation::AuditVerdict::warn;
  return {check};
}

namespace {

struct Loaded {
  const campaign::State* state = nullptr;
  identification::ToolLoad load;  ///< about the cell's point
  Eigen::Matrix3d tool_from_cell = Eigen::Matrix3d::Identity();
};

/// Turns a reading into axes of the flange where the cell's own do not turn with it.
Eigen::Matrix3d toolFromCell(const campaign::Campaign& campaign, const JointVector& q) {
  const campaign::LoadCell& cell = *campaign.load_cell;
  const std::string& link = cell.axes_link ? *cell.axes_link : cell.parent;
  const Eigen::Matrix3d turned =
      cell.axes_link ? Eigen::Matrix3d::Identity() : Eigen::Matrix3d(cell.parent_from_cell.linear());
  for (const robot::LinkFrame& frame : campaign.robot.links) {
    if (frame.name != link || frame.body == campaign.robot.axes()) continue;
    const robot::ArmPosture posture = robot::postureAt(campaign.robot, q);
    const Eigen::Matrix3d base_from_link =
        posture.motion[static_cast<std::size_t>(frame.body)].linear() * frame.base_from_link_at_zero.linear();
    return robot::flangeAt(campaign.robot, posture).linear().transpose() * base_from_link * turned;
  }
  return Eigen::Matrix3d::Identity();  // fixed to the flange: one constant turn changes nothing
}

identification::LoadPointFit loadPointOf(const std::vector<Loaded>& states) {
  std::vector<identification::ToolLoad> loads;
  for (const Loaded& one : states) loads.push_back(one.load);
  return identification::LoadPointFit(loads);
}

double misfit(const campaign::LoadCell& cell, const Loaded& one, const Eigen::Vector3d& at) {
  const Eigen::Matrix3d through = identification::momentByPoint(Eigen::Vector3d::UnitX()) * at.x() +
                                  identification::momentByPoint(Eigen::Vector3d::UnitY()) * at.y() +
                                  identification::momentByPoint(Eigen::Vector3d::UnitZ()) * at.z();
  const Eigen::Matrix3d covariance = cell.moment_sigma * cell.moment_sigma * Eigen::Matrix3d::Identity() +
                                     cell.force_sigma * cell.force_sigma * through * through.transpose();
  const Eigen::Vector3d residual = one.load.moment - identification::momentByPoint(one.load.force) * at;
  return mahalanobisSquared(residual, covariance);
}

double total(const campaign::LoadCell& cell, const std::vector<Loaded>& states, const Eigen::Vector3d& at) {
  double sum = 0.0;
  for (const Loaded& one : states) sum += misfit(cell, one, at);
  return sum;
}

/// Every way to turn signs round, the fewest first.
std::array<Eigen::Vector3d, 7> signChoices() {
  return {{{-1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, -1}}};
}

Loaded withSigns(Loaded one, const Eigen::Vector3d& signs) {
  one.load.moment = one.tool_from_cell * signs.asDiagonal() * one.tool_from_cell.transpose() * one.load.moment;
  return one;
}

std::vector<std::string> namesOf(const Eigen::Vector3d& signs) {
  std::vector<std::string> names;
  const std::array<const char*, 3> kNames{"mx", "my", "mz"};
  for (std::size_t k = 0; k < 3; ++k) {
    if (signs[static_cast<int>(k)] < 0.0) names.push_back(kNames[k]);
  }
  return names;
}

/// Finds signs that mend the fit: of the worst state alone, or of all.
void findMendingSigns(const campaign::LoadCell& cell, const std::vector<Loaded>& states, std::size_t worst,
                      double limit, LoadPointFit& fit) {
  for (const bool all : {false, true}) {
    for (const Eigen::Vector3d& signs : signChoices()) {
      std::vector<Loaded> turned = states;
      for (std::size_t i = 0; i < turned.size(); ++i) {
        if (all || i == worst) turned[i] = withSigns(turned[i], signs);
      }
      if (total(cell, turned, loadPointOf(turned).point()) <= limit) {
        fit.mending_signs = namesOf(signs);
        fit.mends_all_states = all;
        return;
      }
    }
  }
}

}  // namespace

LoadPointFit fitLoadPoint(const campaign::Campaign& campaign) {
  LoadPointFit fit;
  const campaign::LoadCell& cell = *campaign.load_cell;
  std::vector<Loaded> states;
  states.reserve(campaign.states->rows.size());
  double most = 0.0;
  for (const campaign::State& state : campaign.states->rows)
    most = std::max(most, state.wrench_in_cell.head<3>().norm());
  bool any_moment = false;
  for (const campaign::State& state : campaign.states->rows) {
    if (state.step == 0 || state.wrench_in_cell.head<3>().norm() < campaign::kReturnShare * most) continue;
    const Eigen::Matrix3d turn = toolFromCell(campaign, state.q);
    states.push_back({&state, {turn * state.wrench_in_cell.head<3>(), turn * state.wrench_in_cell.tail<3>()}, turn});
    any_moment |= !state.wrench_in_cell.tail<3>().isZero(0.0);
  }
  constexpr std::size_t kLeast = 4;
  if (states.size() < kLeast) fit.reason = Remark(MissingId::few_loaded_states);
  if (!any_moment) fit.reason = Remark(MissingId::no_moments);
  if (!fit.reason.empty()) return fit;
  const identification::LoadPointFit load_point = loadPointOf(states);
  constexpr double kOneLine = 1e-4;  // squared sine of the forces' spread in the tool
  const Eigen::Vector3d seen = symmetricEigenvalues(load_point.normal());
  if (seen[0] < kOneLine * seen[2]) {
    fit.reason = Remark(MissingId::forces_on_one_line);
    return fit;
  }
  fit.lever = load_point.point();
  std::size_t worst = 0;
  double squares = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double chi2 = misfit(cell, states[i], fit.lever);
    fit.chi2 += chi2;
    squares += (states[i].load.moment - identification::momentByPoint(states[i].load.force) * fit.lever).squaredNorm();
    if (chi2 > fit.worst_chi2) fit.worst_chi2 = chi2, worst = i;
  }
  const double count = static_cast<double>(states.size());
  fit.dof = static_cast<int>(3 * states.size()) - 3;
  fit.rms = std::sqrt(squares / (3.0 * count));
  fit.worst_limit = numerics::chiSquareLimit(0.5 * preparation::kLevel / count, 3.0);
  fit.worst_line = states[worst].state->line;
  fit.worst_pose = states[worst].state->pose;
  fit.worst_step = states[worst].state->step;
  const double limit = numerics::chiSquareLimit(preparation::kLevel, fit.dof);
  if (fit.chi2 > limit || fit.worst_chi2 > fit.worst_limit) findMendingSigns(cell, states, worst, limit, fit);
  fit.done = true;
  return fit;
}

}  // namespace stiffscope::audit
