#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "core/audit/checks.h"
#include "core/audit/redundancies.h"
#include "core/audit/remarks.h"
#include "core/campaign/row_names.h"
#include "core/numerics/distributions.h"
#include "core/preparation/finding.h"
#include "core/preparation/remarks.h"

namespace stiffscope::audit {

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
  std::map<int, const campaign::State*> states;
  std::map<int, const campaign::StatePoints*> points;
  std::map<int, std::vector<const campaign::Displacement*>> displacements;  ///< where there are no points
};

/// Of a state that was unloaded again: its load in parts of the heaviest of its posture, one sigma of that by the
/// cell's declared noise.
struct LoadLeft {
  double share = 0.0, sd = 0.0;
};

/// Forces of one posture against what the cell shows in its step 0. That is noise of a tared cell and not taken off;
/// beyond noise it is a weight that was not tared, or a zero that drifts, which the other steps have, too.
class ForcesOfPosture {
 public:
  ForcesOfPosture(const campaign::Campaign& campaign, const campaign::State* unloaded) {
    sigma_ = campaign.load_cell ? campaign.load_cell->force_sigma : 0.0;
    if (unloaded == nullptr || sigma_ <= 0.0) return;
    const Eigen::Vector3d shown = unloaded->wrench_in_cell.head<3>();
    const double level = preparation::kLevel / static_cast<double>(campaign.pose_ids.size());
    not_zero_ = shown.squaredNorm() > sigma_ * sigma_ * numerics::chiSquareLimit(level, 3.0);
    if (not_zero_) zero_ = shown;
  }

  Eigen::Vector3d of(const campaign::State& state) const { return state.wrench_in_cell.head<3>() - zero_; }

  LoadLeft left(const campaign::State& state, const campaign::State& loaded) const {
    const Eigen::Vector3d force = of(loaded);
    const double noise = not_zero_ ? std::sqrt(2.0) * sigma_ : sigma_;
    return {of(state).dot(force) / force.squaredNorm(), noise / force.norm()};
  }

 private:
  double sigma_ = 0.0;  ///< N; 0 where it is not stated
  bool not_zero_ = false;
  Eigen::Vector3d zero_ = Eigen::Vector3d::Zero();
};

/// The reflectors of one posture unloaded again. A load that is left displaces them in proportion, and what the cell's
/// noise puts into it moves all of them at once: the covariance of all is that of the tracker's readings and
/// sd^2 u u^T, u their displacements under the whole load.
class ComeBack {
 public:
  ComeBack(const campaign::State& state, const LoadLeft& left) : back_{state.pose, state.step}, left_(left) {}

  /// `off`: from step 0; `under_load`: the same in the loaded step, zero where it was not read there.
  void add(const Eigen::Vector3d& off, const Eigen::Vector3d& under_load, const Eigen::Matrix3d& covariance,
           std::size_t line) {
    const Eigen::Vector3d rest = off - left_.share * under_load;
    const Eigen::LDLT<Eigen::Matrix3d> inverse(covariance);
    const Eigen::Vector3d weighted = inverse.solve(rest);
    squares_ += rest.dot(weighted);
    along_load_ += under_load.dot(weighted);
    load_squared_ += under_load.dot(inverse.solve(under_load));
    back_.dof += 3;
    if (rest.norm() <= back_.largest) return;
    back_.largest = rest.norm();
    back_.line = line;
  }

  /// Mahalanobis distance over all reflectors (Sherman and Morrison).
  Return result() const {
    Return back = back_;
    const double variance = left_.sd * left_.sd;
    back.chi2 = squares_ - variance * along_load_ * along_load_ / (1.0 + variance * load_squared_);
    return back;
  }

 private:
  Return back_;
  LoadLeft left_;
  double squares_ = 0.0, along_load_ = 0.0, load_squared_ = 0.0;
};

Return compare(const campaign::State& state, const campaign::StatePoints& before, const campaign::StatePoints& after,
               const campaign::StatePoints* loaded, const LoadLeft& left, const metrology::TrackerNoise& noise) {
  ComeBack back(state, left);
  for (const campaign::ReflectorMean& mean : after.reflectors) {
    const campaign::ReflectorMean* first = before.of(mean.target);
    if (first == nullptr) continue;
    const campaign::ReflectorMean* under_load = loaded != nullptr ? loaded->of(mean.target) : nullptr;
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();
    if (under_load != nullptr) moved = under_load->point - first->point;
    back.add(mean.point - first->point, moved, mean.covariance(noise) + first->covariance(noise), mean.line);
  }
  return back.result();
}

/// Of a displacement in its table's axes: two readings where the reflector stands by the model, which is where the load
/// cases have it. None where the table's frame is not known in the robot's.
std::map<std::pair<int, int>, Eigen::Matrix3d> displacementNoise(const AuditInput& input) {
  std::map<std::pair<int, int>, Eigen::Matrix3d> noise;
  const bool in_base = input.campaign.displacements->frame == campaign::PointFrame::base_link;
  if (!in_base && !input.frames.arm.points_placed) return noise;
  const Eigen::Isometry3d r0_from_table =
      in_base ? input.arm.geometry.r0_from_base_link : input.frames.arm.r0_from_points;
  const Eigen::Isometry3d table_from_r0 = r0_from_table.inverse();
  for (const identification::LoadCase& load_case : input.arm.cases) {
    for (const identification::TargetMove& move : load_case.targets)
      noise[{load_case.pose, move.target}] = 2.0 * input.noise->covarianceAt(table_from_r0 * move.unloaded);
  }
  return noise;
}

/// The same of displacements, which are from step 0 already.
Return compare(const campaign::State& state, const PoseStates& pose, const campaign::State& loaded,
               const LoadLeft& left, const std::map<std::pair<int, int>, Eigen::Matrix3d>& noise) {
  ComeBack back(state, left);
  const auto rows = pose.displacements.find(state.step), under_load = pose.displacements.find(loaded.step);
  if (rows == pose.displacements.end()) return back.result();
  for (const campaign::Displacement* row : rows->second) {
    const auto covariance = noise.find({row->pose, row->target});
    if (covariance == noise.end()) continue;
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();
    if (under_load != pose.displacements.end()) {
      for (const campaign::Displacement* other : under_load->second) {
        if (other->target == row->target) moved = other->displacement;
      }
    }
    back.add(row->displacement, moved, covariance->second, row->line);
  }
  return back.result();
}

std::vector<Return> returnsOf(const AuditInput& input) {
  std::map<int, PoseStates> poses;
  for (const campaign::State& state : input.campaign.states->rows) poses[state.pose].states[state.step] = &state;
  const bool displaced = !input.campaign.loading && input.campaign.displacements;
  std::map<std::pair<int, int>, Eigen::Matrix3d> noise;
  if (displaced) {
    noise = displacementNoise(input);
    for (const campaign::Displacement& row : input.campaign.displacements->rows)
      poses[row.pose].displacements[row.step].push_back(&row);
  }
  for (const campaign::StatePoints& points : input.states) {
    if (points.pose >= 0) poses[points.pose].points[points.step] = &points;
  }
  std::vector<Return> found;
  for (const auto& [pose, one] : poses) {
    const auto first = one.states.find(0);
    const ForcesOfPosture forces(input.campaign, first == one.states.end() ? nullptr : first->second);
    const campaign::State* most = nullptr;
    for (const auto& [step, state] : one.states) {
      if (step == 0) continue;
      if (most == nullptr || forces.of(*state).norm() > forces.of(*most).norm()) most = state;
    }
    if (most == nullptr || (!displaced && !one.points.contains(0))) continue;
    const double force = forces.of(*most).norm();
    for (const auto& [step, state] : one.states) {
      if (step <= most->step || (!displaced && !one.points.contains(step))) continue;
      if (forces.of(*state).norm() >= campaign::kReturnShare * force) continue;
      const LoadLeft left = forces.left(*state, *most);
      if (displaced) {
        const Return back = compare(*state, one, *most, left, noise);
        if (back.dof > 0) found.push_back(back);
        continue;
      }
      const auto loaded = one.points.find(most->step);
      const Return back = compare(*state, *one.points.at(0), *one.points.at(step),
                                  loaded == one.points.end() ? nullptr : loaded->second, left, *input.noise);
      if (back.dof > 0) found.push_back(back);
    }
  }
  return found;
}

}  // namespace

NoiseSum scatterOfReturns(const AuditInput& input) {
  NoiseSum sum;
  const bool measured = input.campaign.loading || input.campaign.displacements;
  if (!measured || !input.campaign.states || !input.noise) return sum;
  for (const Return& one : returnsOf(input)) {
    sum.chi2 += one.chi2;
    sum.dof += one.dof;
  }
  return sum;
}

Findings checkReturnToZero(const AuditInput& input) {
  const campaign::Campaign& campaign = input.campaign;
  if ((!campaign.loading && !campaign.displacements) || !campaign.states) {
    return {preparation::notTestable("return_to_zero", Remark(MissingId::no_readings_of_states))};
  }
  if (!input.noise) {
    return {preparation::notTestable("return_to_zero", Remark(preparation::RemarkId::tracker_noise_not_declared))};
  }
  const std::vector<Return> returns = returnsOf(input);
  if (returns.empty()) return {preparation::notTestable("return_to_zero", Remark(MissingId::no_unloading))};
  preparation::AuditCheck check;
  check.id = "return_to_zero";
  double chi2 = 0.0;
  int dof = 0;
  std::vector<Remark> beyond;
  const Return* worst = &returns.front();
  for (const Return& one : returns) {
    chi2 += one.chi2;
    dof += one.dof;
    if (one.chi2 > numerics::chiSquareLimit(preparation::kLevel / static_cast<double>(returns.size()), one.dof)) {
      beyond.push_back(Remark(RemarkId::posture_off, campaign::poseName(campaign, one.pose), one.largest));
    }
    if (one.chi2 / one.dof > worst->chi2 / worst->dof) worst = &one;
  }
  check.value = std::sqrt(chi2 / dof);
  check.limit = std::sqrt(numerics::chiSquareLimit(preparation::kLevel, dof) / dof);
  check.limit_source = preparation::byChance(Remark(LimitId::chi_square_and_postures, dof));
  const auto says = [&](std::vector<Remark> more) {
    return Remark(RemarkId::comes_back, *check.value, worst->largest, campaign::poseName(campaign, worst->pose),
                  worst->step, std::move(more));
  };
  check.message = says({});
  if (*check.value <= *check.limit && beyond.empty()) return {check};
  check.verdict =
      chi2 / dof > preparation::kFailVarianceRatio ? preparation::AuditVerdict::fail : preparation::AuditVerdict::warn;
  check.where =
      preparation::atRow(campaign.loading ? campaign.loading->file : campaign.displacements->file, worst->line);
  check.message = says({Remark(RemarkId::do_not_come_back, std::move(beyond), returns.size())});
  return {check};
}

}  // namespace stiffscope::audit
