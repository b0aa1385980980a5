#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/audit/checks.h"
#include "core/audit/limits.h"
#include "core/audit/remarks.h"
#include "core/campaign/row_names.h"
#include "core/identification/identifiability.h"
#include "core/identification/warnings.h"
#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"
#include "core/preparation/remarks.h"

namespace stiffscope::audit {

namespace {

/// Largest distance of a reflector from any joint axis over the load cases: how far a turn carries it per
/// radian.
double longestLever(const identification::LoadedArm& arm) {
  double longest = 0.0;
  for (const identification::LoadCase& load_case : arm.cases) {
    for (const identification::TargetMove& move : load_case.targets) {
      const PointJacobian jacobian = robot::pointJacobianAt(load_case.axes, move.unloaded);
      longest = std::max(longest, jacobian.colwise().norm().maxCoeff());
    }
  }
  return longest;
}

/// One-sigma noise of one reading of a reflector, per coordinate, m: the largest of all states.
double readingNoise(const AuditInput& input) {
  double variance = input.noise->covarianceAt(input.noise->station).trace() / 3.0;
  for (const campaign::StatePoints& state : input.states) {
    for (const campaign::ReflectorMean& mean : state.reflectors) {
      variance = std::max(variance, mean.readings * mean.covariance(*input.noise).trace() / 3.0);
    }
  }
  return std::sqrt(variance);
}

}  // namespace

Findings checkServo(const AuditInput& input) {
  const campaign::Campaign& campaign = input.campaign;
  if (input.arm.cases.empty()) {
    return {preparation::notTestable("servo_change", Remark(MissingId::no_compared_postures_in_geometry))};
  }
  if (!input.noise) {
    return {preparation::notTestable("servo_change", Remark(preparation::RemarkId::tracker_noise_not_declared))};
  }
  const double lever = longestLever(input.arm);
  preparation::AuditCheck check;
  check.id = "servo_change";
  check.value = 0.0;
  check.limit_source = Remark(LimitId::turn_at_lever, lever);
  std::vector<const campaign::State*> unloaded(campaign.pose_ids.size(), nullptr);
  for (const campaign::State& state : campaign.states->rows) {
    if (state.step == 0) unloaded[static_cast<std::size_t>(state.pose)] = &state;
  }
  check.limit = 2.0 * readingNoise(input) / lever;
  check.message = Remark(RemarkId::no_angle_changes);
  for (const campaign::State& state : campaign.states->rows) {
    const campaign::State* before = unloaded[static_cast<std::size_t>(state.pose)];
    if (before == nullptr) continue;
    int joint = 0;
    const double change = (state.q - before->q).cwiseAbs().maxCoeff(&joint);
    if (change <= *check.value) continue;
    check.value = change;
    check.where = preparation::atRow(campaign.states->file, state.line);
    check.message = Remark(RemarkId::angle_changes, joint + 1, campaign::poseName(campaign, state.pose), state.step,
                           change > *check.limit);
  }
  if (*check.value > *check.limit) check.verdict = preparation::AuditVerdict::warn;
  return {check};
}

namespace {

/// Geometry errors put more than noise into the positions; the shift must stand out of those too.
double misfit(const AbsoluteFit& fit) { return std::max(1.0, fit.chi2 / fit.dof); }

/// While loading went on. The largest is the check's figure.
preparation::AuditCheck movedMeanwhileCheck(const campaign::Campaign& campaign, const AbsoluteFit& fit) {
  preparation::AuditCheck check;
  check.id = "frame_moved";
  check.value = 0.0;
  check.limit_source = Remark(LimitId::chi_square_of_motion);
  std::vector<Remark> moves;
  const MovedMeanwhile* largest = &fit.moves.front();
  for (const MovedMeanwhile& move : fit.moves) {
    const Eigen::Vector3d displacement = move.motion.tail<3>();
    if (displacement.norm() > *check.value) {
      largest = &move;
      check.value = displacement.norm();
      check.limit = move.by_chance;
    }
    const std::string pose = campaign::poseName(campaign, move.pose);
    const double turn = move.motion.head<3>().norm();
    const std::vector<double> along(displacement.begin(), displacement.end());
    if (move.body == MovedMeanwhile::Body::tool) {
      moves.push_back(Remark(RemarkId::tool_moved_meanwhile, pose, displacement.norm(), turn, move.explained));
    } else if (move.steady) {
      moves.push_back(Remark(RemarkId::station_drifts_meanwhile, along, turn, move.explained));
    } else {
      moves.push_back(Remark(RemarkId::station_moved_meanwhile, pose, along, turn, move.explained));
    }
  }
  const double trusted = identification::TrustLimits().position;
  check.verdict = *check.value > 2.0 * trusted ? preparation::AuditVerdict::fail : preparation::AuditVerdict::warn;
  check.where =
      largest->steady ? Remark(RemarkId::at_loading) : preparation::atRow(campaign.loading->file, largest->line);
  check.message = Remark(RemarkId::moved_meanwhile, std::move(moves));
  return check;
}

preparation::AuditCheck frameCheck(const campaign::Campaign& campaign, const AbsoluteFit& fit) {
  if (!fit.moves.empty()) return movedMeanwhileCheck(campaign, fit);
  preparation::AuditCheck check;
  check.id = "frame_moved";
  const double ratio = fit.shift_chi2 / misfit(fit), by_chance = numerics::chiSquareLimit(preparation::kLevel, 6.0);
  const Eigen::Vector3d displacement = fit.shift.tail<3>();
  // The shift where the arm is read, or where it stands (R0's origin), whichever is larger.
  const double at_base = (displacement - fit.shift.head<3>().cross(fit.centre)).norm();
  check.value = std::max(displacement.norm(), at_base);
  check.limit =
      std::max(identification::TrustLimits().position, ratio > 0.0 ? *check.value * std::sqrt(by_chance / ratio) : 0.0);
  check.limit_source = Remark(LimitId::places_or_chance, preparation::byChance(Remark(LimitId::chi_square_of_shift)));
  // A shift that leaves most of the misfit goes along with another fault (geometry, sag) and is not its
  // cause.
  const double explained = fit.shift_chi2 / (fit.shift_chi2 + fit.chi2);
  const auto says = [&](std::vector<Remark> more) {
    return Remark(RemarkId::loading_shifted, std::vector<double>(displacement.begin(), displacement.end()),
                  fit.shift.head<3>().norm(), explained, std::move(more));
  };
  check.message = says({});
  if (*check.value <= *check.limit || explained < kExplains) return check;
  check.verdict = *check.value > 2.0 * *check.limit ? preparation::AuditVerdict::fail : preparation::AuditVerdict::warn;
  check.where = Remark(RemarkId::at_loading);
  check.message = says({Remark(RemarkId::tracker_or_robot_moved)});
  return check;
}

preparation::AuditCheck positionsCheck(const AbsoluteFit& fit) {
  preparation::AuditCheck check;
  check.id = "unloaded_positions";
  const double by_chance =
      fit.chi2 > 0.0 ? fit.rms_after * std::sqrt(numerics::chiSquareLimit(preparation::kLevel, fit.dof) / fit.chi2)
                     : 0.0;
  check.value = fit.rms_after;
  check.limit = std::max(kShareOfTolerance * identification::TrustLimits().position, by_chance);
  check.limit_source =
      Remark(LimitId::third_of_places_or_chance, preparation::byChance(Remark(LimitId::chi_square, fit.dof)));
  const auto says = [&fit](std::vector<Remark> more) {
    return Remark(RemarkId::positions_miss, fit.positions, fit.rms_before, fit.rms_after, std::sqrt(fit.chi2 / fit.dof),
                  std::move(more));
  };
  check.message = says({});
  if (*check.value <= *check.limit) return check;
  if (fit.rms_after > identification::kMissedGeometry) {
    check.verdict = preparation::AuditVerdict::fail;
    check.impossible = true;
    check.message = says({Remark(RemarkId::positions_impossible)});
    return check;
  }
  check.verdict = preparation::AuditVerdict::warn;
  check.message = says({Remark(RemarkId::geometry_does_not_carry)});
  if (!fit.zero) return check;
  const ZeroSinceSweeps& zero = *fit.zero;
  if (zero.displacement > 2.0 * identification::TrustLimits().position) check.verdict = preparation::AuditVerdict::fail;
  check.where = Remark(RemarkId::at_loading);
  check.message = says({Remark(RemarkId::zero_since_sweeps, zero.joint + 1, zero.correction, zero.explained)});
  return check;
}

const campaign::State* unloadedState(const campaign::Campaign& campaign, int pose) {
  for (const campaign::State& state : campaign.states->rows) {
    if (state.pose == pose && state.step == 0) return &state;
  }
  return nullptr;
}

preparation::AuditCheck readBackCheck(const AuditInput& input) {
  const AbsoluteFit& fit = input.absolute;
  preparation::AuditCheck check;
  check.id = "joint_read_back";
  check.limit = fit.score_limit;
  check.value = 0.0;
  check.limit_source = preparation::byChance(Remark(LimitId::student_between_postures));
  std::vector<Remark> found;
  double worst = 0.0;
  for (const PostureReadBack& posture : fit.postures) {
    check.value = std::max(*check.value, posture.score);
    // A posture whose misfit no joint angles explain has another fault, such as exchanged reflectors.
    constexpr double kMostly = 0.9;
    if (!posture.outlier || posture.explained < kMostly) continue;
    const campaign::State* state = unloadedState(input.campaign, posture.pose);
    const std::string row = campaign::rowName(input.campaign.states->file, state->line);
    if (posture.score > worst) worst = posture.score, check.where = Remark(preparation::RemarkId::at_name, row);
    found.push_back(Remark(RemarkId::joint_off, row, campaign::poseName(input.campaign, posture.pose),
                           posture.joint + 1, posture.joint_correction));
  }
  check.message = Remark(RemarkId::angles_agree);
  if (found.empty()) {
    check.value = std::min(*check.value, *check.limit);
    return check;
  }
  check.verdict = preparation::AuditVerdict::fail;
  check.message = Remark(RemarkId::angles_stale, std::move(found));
  return check;
}

}  // namespace

Findings checkUnloadedPositions(const AuditInput& input) {
  const AbsoluteFit& fit = input.absolute;
  Findings findings;
  const Remark no_sag(MissingId::sag_not_known);
  for (const char* id : {"frame_moved", "unloaded_positions"}) {
    if (!fit.done || !fit.sag_known) findings.push_back(preparation::notTestable(id, fit.done ? no_sag : fit.reason));
  }
  if (findings.empty()) findings = {frameCheck(input.campaign, fit), positionsCheck(fit)};
  constexpr std::size_t kToCompare = 6;  // the median needs a majority of sound postures to tell outliers from
  if (!fit.done) {
    findings.push_back(preparation::notTestable("joint_read_back", fit.reason));
  } else if (fit.postures.size() < kToCompare) {
    findings.push_back(
        preparation::notTestable("joint_read_back", Remark(MissingId::few_postures_to_compare, kToCompare)));
  } else {
    findings.push_back(readBackCheck(input));
  }
  return findings;
}

}  // namespace stiffscope::audit
