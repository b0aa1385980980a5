#include "core/identification/by_step.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/identification/load_step.h"
#include "core/identification/loaded_arm.h"
#include "core/identification/method_solution.h"
#include "core/identification/without_postures.h"
#include "metrology/tail_probability.h"

namespace stiffscope {

namespace {

/// A step's estimate, and whose influences it has.
struct Solved {
  StepEstimate result;
  std::vector<int> poses;
};

double meanForce(const std::vector<LoadCase>& cases) {
  double sum = 0.0;
  for (const LoadCase& one : cases) sum += one.wrench.force.norm();
  return cases.empty() ? 0.0 : sum / static_cast<double>(cases.size());
}

std::vector<Solved> solveSteps(const Campaign& campaign, const IdentifyOptions& options, const Identification& result,
                               Method method) {
  std::vector<Solved> solved;
  const MethodResult& own = result.of(method);
  if (!own.available) return solved;
  for (const int step : loadedSteps(campaign)) {
    LoadedArm arm = loadedArm(campaign, own.geometry, result.frames.wrist, {step});
    if (arm.cases.empty()) continue;
    if (method == Method::complete_pose && !arm.hasFlangePoses()) continue;
    if (method == Method::decoupled_partial_pose && arm.wrist.empty()) continue;
    Solved one;
    one.result.step = step;
    one.result.mean_force = meanForce(arm.cases);
    const MethodSolution how{method, result.frames.tcp_in_flange, result.characteristic_length.length,
                             own.estimate.identifiable, campaign.tracker ? &*campaign.tracker : nullptr};
    one.result.estimate = solveSettled(arm, options.finite_deflection,
                                       [&](const LoadedArm& now) { return how.estimate(now); });
    for (const LoadCase& load_case : arm.cases) one.poses.push_back(load_case.pose);
    solved.push_back(std::move(one));
  }
  std::stable_sort(solved.begin(), solved.end(),
                   [](const Solved& a, const Solved& b) { return a.result.mean_force < b.result.mean_force; });
  return solved;
}

double influenceOf(const Solved& solved, int pose, int joint) {
  const auto at = std::find(solved.poses.begin(), solved.poses.end(), pose);
  return at == solved.poses.end()
             ? 0.0
             : solved.result.estimate.influences[static_cast<std::size_t>(at - solved.poses.begin())][joint];
}

/// Covariance of the differences of every step to the first.
Eigen::MatrixXd differenceCovariance(const std::vector<Solved>& solved, int joint) {
  std::vector<int> poses;
  for (const Solved& one : solved) poses.insert(poses.end(), one.poses.begin(), one.poses.end());
  std::sort(poses.begin(), poses.end());
  poses.erase(std::unique(poses.begin(), poses.end()), poses.end());
  const auto q = static_cast<Eigen::Index>(solved.size()) - 1;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(q, q);
  for (const int pose : poses) {
    Eigen::VectorXd moves(q);
    for (Eigen::Index s = 0; s < q; ++s) {
      moves[s] = influenceOf(solved[static_cast<std::size_t>(s) + 1], pose, joint) - influenceOf(solved[0], pose, joint);
    }
    covariance += moves * moves.transpose();
  }
  return covariance;
}

LoadDependence dependence(const std::vector<Solved>& solved, int joint) {
  LoadDependence result;
  const auto q = static_cast<Eigen::Index>(solved.size()) - 1;
  Eigen::VectorXd differences(q);
  double dof = solved[0].result.estimate.scatter_dof[joint];
  for (Eigen::Index s = 0; s < q; ++s) {
    const StiffnessEstimate& estimate = solved[static_cast<std::size_t>(s) + 1].result.estimate;
    differences[s] = estimate.compliance[joint] - solved[0].result.estimate.compliance[joint];
    dof = std::min(dof, estimate.scatter_dof[joint]);
  }
  const Eigen::MatrixXd covariance = differenceCovariance(solved, joint);
  const double lightest = solved[0].result.estimate.compliance[joint];
  result.change = differences[q - 1] / lightest;
  result.change_sd = std::sqrt(covariance(q - 1, q - 1)) / std::abs(lightest);
  const auto contrasts = static_cast<double>(q);
  if (!(covariance(q - 1, q - 1) > 0.0) || !(dof > contrasts)) return result;
  const double t = result.change / result.change_sd;
  result.p_change = fTail(t * t, 1, dof);
  const double wald = differences.dot(covariance.ldlt().solve(differences));
  const double below = dof - contrasts + 1.0;
  result.p_linear = fTail(std::max(0.0, wald) * below / (dof * contrasts), static_cast<int>(q), below);
  return result;
}

}  // namespace

StepStudy studySteps(const Campaign& campaign, const IdentifyOptions& options, const Identification& result) {
  StepStudy study;
  const Campaign used = result.robust ? withoutPostures(campaign, result.outlying) : campaign;
  for (const Method method : kMethods) {
    std::vector<Solved> solved = solveSteps(used, options, result, method);
    if (solved.size() < 2) continue;
    StepsOfMethod& out = study.methods[static_cast<std::size_t>(method)];
    const JointMask& seen = result.of(method).estimate.identifiable;
    for (int joint = 0; joint < 6; ++joint) {
      const auto j = static_cast<std::size_t>(joint);
      if (seen[j]) out.joints[j] = dependence(solved, joint);
    }
    for (Solved& one : solved) out.steps.push_back(std::move(one.result));
  }
  return study;
}

}  // namespace stiffscope
