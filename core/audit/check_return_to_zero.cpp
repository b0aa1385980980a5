#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "core/audit/chance.h"
#include "core/audit/checks.h"
#include "core/audit/finding.h"
#include "core/audit/rows.h"

namespace stiffscope {

namespace {

/// One posture unloaded again: squared distance of its reflectors from step 0 in parts of the noise.
struct Return {
  int pose = 0;
  int step = 0;
  double chi2 = 0.0;
  int dof = 0;
  double largest = 0.0;  ///< of its reflectors, m
  std::size_t line = 0;  ///< of the reflector that went farthest
};

struct PoseStates {
  std::map<int, const State*> states;
  std::map<int, const StatePoints*> points;
};

/// The load left in `state`, in parts of that in `loaded`.
double loadLeft(const State& state, const State& loaded) {
  const Eigen::Vector3d force = loaded.wrench_in_cell.head<3>();
  return state.wrench_in_cell.head<3>().dot(force) / force.squaredNorm();
}

Return compare(const StatePoints& before, const StatePoints& after, const StatePoints* loaded, double left,
               const TrackerNoise& noise) {
  Return result{after.pose, after.step};
  for (const ReflectorMean& mean : after.reflectors) {
    const ReflectorMean* first = before.of(mean.target);
    if (first == nullptr) continue;
    Eigen::Vector3d off = mean.point - first->point;
    // A small load that is left displaces in proportion.
    const ReflectorMean* under_load = loaded != nullptr ? loaded->of(mean.target) : nullptr;
    if (under_load != nullptr) off -= left * (under_load->point - first->point);
    result.chi2 += off.dot((mean.covariance(noise) + first->covariance(noise)).ldlt().solve(off));
    result.dof += 3;
    if (off.norm() <= result.largest) continue;
    result.largest = off.norm();
    result.line = mean.line;
  }
  return result;
}

std::vector<Return> returnsOf(const Evidence& evidence) {
  std::map<int, PoseStates> poses;
  for (const State& state : evidence.campaign.states->rows) poses[state.pose].states[state.step] = &state;
  for (const StatePoints& points : evidence.states) {
    if (points.pose >= 0) poses[points.pose].points[points.step] = &points;
  }
  std::vector<Return> found;
  for (const auto& [pose, one] : poses) {
    const State* most = nullptr;
    for (const auto& [step, state] : one.states) {
      if (step == 0) continue;
      if (most == nullptr || state->wrench_in_cell.head<3>().norm() > most->wrench_in_cell.head<3>().norm())
        most = state;
    }
    if (most == nullptr || !one.points.contains(0)) continue;
    const double force = most->wrench_in_cell.head<3>().norm();
    for (const auto& [step, state] : one.states) {
      if (step <= most->step || !one.points.contains(step)) continue;
      if (state->wrench_in_cell.head<3>().norm() >= kReturnShare * force) continue;
      const auto loaded = one.points.find(most->step);
      const Return back =
          compare(*one.points.at(0), *one.points.at(step),
                  loaded == one.points.end() ? nullptr : loaded->second, loadLeft(*state, *most), *evidence.noise);
      if (back.dof > 0) found.push_back(back);
    }
  }
  return found;
}

}  // namespace

Findings checkReturnToZero(const Evidence& evidence) {
  const Campaign& campaign = evidence.campaign;
  if (!campaign.loading || !campaign.states) {
    return {
        notTestable("return_to_zero", "no absolute readings of load states: measure `loading` and `states`")};
  }
  if (!evidence.noise) {
    return {notTestable("return_to_zero",
                        "the tracker's noise is not declared: state `tracker` in campaign.xml")};
  }
  const std::vector<Return> returns = returnsOf(evidence);
  if (returns.empty())
    return {notTestable("return_to_zero", "no posture was unloaded again: add a last step without load")};
  AuditCheck check;
  check.id = "return_to_zero";
  check.unit = "of noise";
  double chi2 = 0.0;
  int dof = 0;
  std::vector<std::string> beyond;
  const Return* worst = &returns.front();
  for (const Return& one : returns) {
    chi2 += one.chi2;
    dof += one.dof;
    if (one.chi2 > chiSquareLimit(kLevel / static_cast<double>(returns.size()), one.dof)) {
      beyond.push_back(fmt::format("{} by {:.0f} um", poseName(campaign, one.pose), 1e6 * one.largest));
    }
    if (one.chi2 / one.dof > worst->chi2 / worst->dof) worst = &one;
  }
  check.value = std::sqrt(chi2 / dof);
  check.limit = std::sqrt(chiSquareLimit(kLevel, dof) / dof);
  check.limit_source = byChance(fmt::format("chi-square of {} degrees of freedom, and of each posture", dof));
  check.message = fmt::format(
      "unloaded again, reflectors stand {:.2f} times as far from step 0 as noise alone; farthest "
      "{:.0f} um at pose {}, step {}",
      *check.value, 1e6 * worst->largest, poseName(campaign, worst->pose), worst->step);
  if (*check.value <= *check.limit && beyond.empty()) return {check};
  check.verdict = chi2 / dof > kFailVarianceRatio ? AuditVerdict::fail : AuditVerdict::warn;
  check.where = rowName(campaign.loading->file, worst->line);
  check.message += fmt::format("; {} of {} postures do not come back", beyond.size(), returns.size());
  if (!beyond.empty()) check.message += fmt::format(": {}", fmt::join(beyond, ", "));
  check.message += "; friction, backlash, a slipping part, or drift that nests do not show";
  return {check};
}

}  // namespace stiffscope
