#include "app/fleet/fleet_work.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/model.h"
#include "app/output.h"
#include "core/accuracy/diagnose_accuracy.h"
#include "core/audit/audit.h"
#include "core/campaign/state_points.h"
#include "core/comparison/geometry_change.h"
#include "core/fleet/own_weight_springs.h"
#include "core/identification/load_case.h"
#include "core/preparation/prepare.h"
#include "reports/words/geometry_change_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

namespace {

using fleet::CampaignResult;
using fleet::Stated;
using identification::Identification;

template <class Entries>
void keepEffects(const Entries& entries, CampaignResult& result) {
  result.diagnosed = true;
  for (const auto& entry : entries) {
    fleet::EffectFound found;
    for (const auto effect : entry.effects) found.effects.emplace_back(idOf(effect));
    if (found.effects.empty()) found.effects.emplace_back("unknown");
    found.detail = entry.detail;
    result.effects.push_back(std::move(found));
  }
}

void keepAudit(const audit::AuditReport& report, CampaignResult& result) {
  result.audit = report.verdict;
  for (const preparation::AuditCheck& check : report.checks) {
    using preparation::AuditVerdict;
    if (check.verdict != AuditVerdict::fail && check.verdict != AuditVerdict::warn) continue;
    auto& ids = check.verdict == AuditVerdict::fail ? result.failed_checks : result.warned_checks;
    if (std::find(ids.begin(), ids.end(), check.id) == ids.end()) ids.push_back(check.id);
  }
}

fleet::SpringsOfDay springsOf(const Identification& springs, identification::Method method) {
  const identification::MethodResult& own = springs.of(method);
  const identification::StiffnessEstimate& estimate = own.estimate;
  fleet::SpringsOfDay kept(estimate.joints());
  if (!own.available || estimate.influences.size() != springs.cases.size() || !estimate.covariance.allFinite())
    return kept;
  kept.available = true;
  kept.compliance = estimate.compliance, kept.identifiable = estimate.identifiable;
  kept.shared = (estimate.covariance - estimate.parts.scatter).diagonal().cwiseMax(0.0);
  kept.dof = estimate.scatter_dof, kept.influences = estimate.influences;
  return kept;
}

/// What the day's model says, and what its joint springs alone do, which later days are held against.
void keepIdentification(const campaign::Campaign& campaign, const Identification& model, const Identification& springs,
                        CampaignResult& result) {
  result.postures = static_cast<int>(model.cases.size());
  result.deflection = model.target_displacement.empty() ? fleet::kUnknown : reports::mean(model.target_displacement);
  result.method = reports::shownMethod(model);
  if (result.method) {
    const identification::MethodResult& shown = model.of(*result.method);
    for (std::size_t j = 0; j < result.stiffness.size(); ++j) {
      if (!shown.estimate.identifiable[j]) continue;
      const auto interval = identification::stiffnessInterval(shown.estimate, static_cast<int>(j));
      result.stiffness[j] = {shown.estimate.stiffness(static_cast<int>(j)), interval.low, interval.high};
    }
    if (shown.at_targets && !shown.subsets.compliances.empty()) {
      const double share = shown.at_targets->subsets.held_out, u = reports::expanded(shown.at_targets->held_out_sd);
      result.compensated = {share, share - u, share + u};
    }
  }
  for (const identification::Method method : identification::kMethods)
    result.springs[static_cast<std::size_t>(method)] = springsOf(springs, method);
  result.springs_method = reports::shownMethod(springs);
  for (const identification::LoadCase& one : springs.cases) {
    result.loaded_postures.push_back({campaign.pose_ids[static_cast<std::size_t>(one.pose)], one.q, one.wrench.force});
  }
}

/// rms per coordinate of what is held out, its interval by the scatter of the postures' mean squares.
Stated heldOutError(const calibration::Calibration& calibration, calibration::CalibratedModel model) {
  const std::vector<Eigen::Vector3d>& residuals = calibration.of(model).held_out_residuals;
  std::vector<double> squares;
  std::size_t next = 0;
  for (const calibration::Posture& posture : calibration.day.postures) {
    double sum = 0.0, count = 0.0;
    for (std::size_t r = 0; r < posture.readings.size() && next < residuals.size(); ++r, ++next) {
      if (residuals[next].allFinite()) sum += residuals[next].squaredNorm(), count += 3.0;
    }
    if (count > 0.0) squares.push_back(sum / count);
  }
  if (squares.size() < 2) return {};
  const double n = static_cast<double>(squares.size()), mean = reports::mean(squares);
  double scatter = 0.0;
  for (const double one : squares) scatter += (one - mean) * (one - mean);
  const double u =
      std::sqrt(scatter / (n - 1.0) / n) * identification::studentFactor(n - 1.0, identification::kStatedCoverage);
  return {std::sqrt(mean), std::sqrt(std::max(0.0, mean - u)), std::sqrt(mean + u)};
}

/// Compliances by own weight, and of those that it can tell the stiffnesses.
void keepOwnWeight(const calibration::Calibration& calibration, CampaignResult& result) {
  result.own_weight = fleet::ownWeightSprings(calibration);
  for (const calibration::Posture& posture : calibration.day.postures) {
    result.loaded_postures.push_back(
        {calibration.day.pose_ids[static_cast<std::size_t>(posture.pose)], posture.q, Eigen::Vector3d::Zero()});
  }
  const fleet::SpringsOfDay& springs = result.own_weight;
  for (std::size_t j = 0; j < result.stiffness.size(); ++j) {
    const auto joint = static_cast<Eigen::Index>(j);
    if (!springs.identifiable[j]) continue;
    double variance = springs.shared[joint];
    for (const JointVector& one : springs.influences) variance += one[joint] * one[joint];
    const double c = springs.compliance[joint];
    const double u =
        std::sqrt(variance) * identification::studentFactor(springs.dof[joint], identification::kStatedCoverage);
    constexpr double kOpen = std::numeric_limits<double>::infinity();
    result.stiffness[j] = {1.0 / c, 1.0 / (c + u), u < c ? 1.0 / (c - u) : kOpen};
  }
}

void keepAccuracy(const preparation::PreparedCampaign& prepared, CampaignResult& result) {
  const accuracy::AccuracyDiagnosis diagnosis = accuracy::diagnoseAccuracy(prepared);
  result.kind = fleet::DayKind::unloaded;
  result.postures = diagnosis.postures;
  if (!diagnosis.calibration.reason.empty()) return;
  keepOwnWeight(diagnosis.calibration, result);
  result.nominal = heldOutError(diagnosis.calibration, calibration::CalibratedModel::nominal);
  result.calibrated = heldOutError(diagnosis.calibration, diagnosis.calibration.best().model);
  if (!diagnosis.usable) return;
  result.gap_before = diagnosis.gap.before, result.gap_noise = diagnosis.gap.noise;
  result.gap_after = diagnosis.gap.after;
  keepEffects(diagnosis.verdict, result);
}

}  // namespace

CampaignResult fleetDay(const std::string& folder, bool springs_only) {
  const preparation::PreparedCampaign prepared =
      preparation::prepareCampaign(openCampaign(folder, campaign::Hashes::left));
  const campaign::Campaign& campaign = prepared.campaign;
  CampaignResult result(campaign.robot.joints());
  result.name = campaign.name, result.date = campaign.date, result.robot = campaign.robot.name;
  result.encoders = campaign.double_encoder;
  const robot::ArmAxes& axes = campaign.robot.axes_in_base_at_zero;
  result.axes.assign(axes.begin(), axes.end());
  keepAudit(audit::audit(prepared), result);
  if (identification::whatLoadsLack(campaign).empty()) {
    ModelChoice choice;
    choice.springs_only = springs_only;
    const auto model = modelOf(prepared, choice, {}, extended_model::Followed::by_diagnosis);
    diagnosis::DiagnoseOptions options;
    options.resamples = 0;  // how far the gap shrinks is not kept, and takes half of the time
    const diagnosis::Diagnosis diagnosis = diagnosisOf(prepared, model, options);
    std::optional<Identification> own;
    if (!model) own = identification::identify(campaign);
    keepIdentification(campaign, model ? model->with : *own, model ? model->without : *own, result);
    if (diagnosis.usable) {
      result.gap_before = diagnosis.gap.before, result.gap_noise = diagnosis.gap.noise;
      result.gap_after = diagnosis.gap.after;
      keepEffects(diagnosis.verdict.entries, result);
    }
  } else if (campaign::isUnloadedDay(campaign)) {
    keepAccuracy(prepared, result);
  } else {
    result.kind = fleet::DayKind::sweeps;
  }
  return result;
}

fleet::PairResult fleetPair(const std::string& before, const std::string& after) {
  const auto prepared = [](const std::string& folder) {
    return preparation::prepareCampaign(openCampaign(folder, campaign::Hashes::left));
  };
  const preparation::PreparedCampaign first = prepared(before), second = prepared(after);
  const comparison::GeometryChange change = comparison::compareGeometry(first.campaign, second.campaign);
  fleet::PairResult result(second.campaign.robot.joints());
  result.kind = fleet::DayKind::unloaded;
  result.reason = reports::words(change.reason);
  if (!result.reason.empty()) return result;
  result.same_postures = change.same_postures, result.postures = static_cast<int>(change.postures_common);
  result.machine_p = change.machine_p;
  result.at_targets = change.at_targets, result.at_targets_sd = change.at_targets_sd;
  if (change.machine_changed && change.explained()) result.cause = reports::causeWords(change.causes.front());
  return result;
}

}  // namespace stiffscope::app
