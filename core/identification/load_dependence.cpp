#include "core/identification/load_dependence.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/identification/load_case.h"
#include "core/identification/loaded_arm.h"
#include "core/identification/method_solution.h"
#include "core/identification/outliers.h"
#include "metrology/linear_algebra.h"
#include "metrology/tail_probability.h"

namespace stiffscope::identification {

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

/// Empty where the step lacks what the method needs. `arm`: under the step, in the method's geometry.
std::optional<Solved> solveStep(const campaign::Campaign& campaign, const IdentifyOptions& options,
                                const Identification& result, Method method, int step, LoadedArm& arm) {
  if (arm.cases.empty()) return std::nullopt;
  if (method == Method::complete_pose && !arm.hasFlangePoses()) return std::nullopt;
  if (method == Method::decoupled_partial_pose && arm.wrist.empty()) return std::nullopt;
  Solved one;
  one.result.step = step;
  one.result.mean_force = meanForce(arm.cases);
  const MethodSolution how{method, result.frames.tcp_in_flange, result.characteristic_length.length,
                           result.of(method).estimate.identifiable, campaign.tracker ? &*campaign.tracker : nullptr};
  one.result.estimate = how.solvedEstimate(arm, options.finite_deflection);
  for (const LoadCase& load_case : arm.cases) one.poses.push_back(load_case.pose);
  return one;
}

/// Methods that share a geometry, so that the loaded arm is made for them once.
std::vector<std::vector<Method>> byGeometry(const Identification& result) {
  std::vector<Method> swept, calibrated;
  for (const Method method : kMethods) {
    if (!result.of(method).available) continue;
    (method == Method::partial_pose && result.calibration.done ? calibrated : swept).push_back(method);
  }
  return {swept, calibrated};
}

using SolvedByMethod = std::array<std::vector<Solved>, kMethods.size()>;

SolvedByMethod solveSteps(const campaign::Campaign& campaign, const IdentifyOptions& options,
                          const Identification& result) {
  SolvedByMethod solved;
  const LoadReadings readings(campaign, loadedSteps(campaign));
  for (const std::vector<Method>& methods : byGeometry(result)) {
    if (methods.empty()) continue;
    // One at a time, each on all cores: the loaded arms of many postures take megabytes.
    for (const int step : readings.steps()) {
      LoadedArm arm = loadedArm(campaign, readings, result.of(methods.front()).geometry, result.frames.wrist, {step});
      for (const Method method : methods) {
        if (auto one = solveStep(campaign, options, result, method, step, arm))
          solved[static_cast<std::size_t>(method)].push_back(std::move(*one));
      }
    }
  }
  for (std::vector<Solved>& steps : solved) {
    std::stable_sort(steps.begin(), steps.end(),
                     [](const Solved& a, const Solved& b) { return a.result.mean_force < b.result.mean_force; });
  }
  return solved;
}

/// By pose; zero where the step has none.
Eigen::VectorXd influencesOn(int joint, const Solved& solved, int poses) {
  Eigen::VectorXd influences = Eigen::VectorXd::Zero(poses);
  for (std::size_t p = 0; p < solved.poses.size(); ++p) {
    influences[solved.poses[p]] = solved.result.estimate.influences[p][joint];
  }
  return influences;
}

/// Covariance of the differences of every step to the first.
Eigen::MatrixXd differenceCovariance(const std::vector<Solved>& solved, int joint) {
  int poses = 0;
  for (const Solved& one : solved) {
    for (const int pose : one.poses) poses = std::max(poses, pose + 1);
  }
  const Eigen::VectorXd first = influencesOn(joint, solved[0], poses);
  Eigen::MatrixXd moves(poses, static_cast<Eigen::Index>(solved.size()) - 1);
  for (std::size_t s = 1; s < solved.size(); ++s) {
    moves.col(static_cast<Eigen::Index>(s) - 1) = influencesOn(joint, solved[s], poses) - first;
  }
  return moves.transpose() * moves;
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
  result.dof = dof;
  const auto contrasts = static_cast<double>(q);
  if (!(covariance(q - 1, q - 1) > 0.0) || !(dof > contrasts)) return result;
  const double t = result.change / result.change_sd;
  result.p_change = metrology::fTail(t * t, 1, dof);
  const double wald = mahalanobisSquared(differences, covariance);
  const double below = dof - contrasts + 1.0;
  result.p_linear = metrology::fTail(std::max(0.0, wald) * below / (dof * contrasts), static_cast<int>(q), below);
  return result;
}

}  // namespace

StepStudy studySteps(const campaign::Campaign& campaign, const IdentifyOptions& options, const Identification& result) {
  StepStudy study;
  std::optional<campaign::Campaign> rest;
  if (result.robust) rest = withoutPostures(campaign, result.outlying);
  const campaign::Campaign& used = rest ? *rest : campaign;
  SolvedByMethod by_method = solveSteps(used, options, result);
  for (const Method method : kMethods) {
    std::vector<Solved>& solved = by_method[static_cast<std::size_t>(method)];
    if (solved.size() < 2) continue;
    StepsOfMethod& out = study.methods[static_cast<std::size_t>(method)];
    const robot::JointMask& seen = result.of(method).estimate.identifiable;
    out.joints.resize(seen.size());
    for (int joint = 0; joint < static_cast<int>(seen.size()); ++joint) {
      const auto j = static_cast<std::size_t>(joint);
      if (seen[j]) out.joints[j] = dependence(solved, joint);
    }
    for (Solved& one : solved) out.steps.push_back(std::move(one.result));
  }
  return study;
}

}  // namespace stiffscope::identification
