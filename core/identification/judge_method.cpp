#include "core/identification/judge_method.h"

namespace stiffscope {

namespace {

Compensation compensationBy(const StiffnessEstimate& estimate, const DeflectionJudge& judge,
                            const SubsetJudgement& subsets) {
  return {judge.compensated(estimate.compliance), subsets.compensated};
}

}  // namespace

void judgeMethod(const LoadedArm& arm, std::vector<NormalEquations> normal, bool decoupled,
                 const SubsetOptions& options, MethodResult& out) {
  out.available = true;
  out.geometry = arm.geometry;
  out.wrist_rows = wristPointEquations(arm);
  out.target_rows = reflectorEquations(arm);
  SubsetMethod subset;
  subset.unknown = out.estimate.identifiable;
  subset.normal = std::move(normal);
  if (decoupled) {
    for (const CaseEquations& one : out.target_rows) subset.reflectors.push_back(normalEquations(one));
  }
  if (!out.wrist_rows.empty()) subset.at_wrist = DeflectionJudge(out.wrist_rows);
  subset.at_targets = DeflectionJudge(out.target_rows);
  out.subsets = studySubsets(subset, options);

  if (!out.wrist_rows.empty()) {
    out.at_wrist = compensationBy(out.estimate, subset.at_wrist, out.subsets.at_wrist);
    out.wrist_residual = subset.at_wrist.residual(out.estimate.compliance);
  }
  out.at_targets = compensationBy(out.estimate, subset.at_targets, out.subsets.at_targets);
  out.target_residual = subset.at_targets.residual(out.estimate.compliance);
  for (std::size_t i = 0; i < out.target_residual.size(); ++i)
    out.target_residual[i] /= subset.at_targets.pointsOf(i);
}

}  // namespace stiffscope
