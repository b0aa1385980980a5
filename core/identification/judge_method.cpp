#include "core/identification/judge_method.h"

#include "core/identification/posture_influence.h"

namespace stiffscope {

namespace {

Compensation compensationBy(const StiffnessEstimate& estimate, const DeflectionJudge& judge,
                            const SubsetJudgement& subsets) {
  return {judge.compensated(estimate.compliance), subsets.compensated};
}

/// Mean over a case's points of what is left of the displacement.
std::vector<double> residualByCase(const std::vector<CaseEquations>& rows, const Vector6d& compliance) {
  const DeflectionJudge judge(rows);
  std::vector<double> left = judge.residual(compliance);
  for (std::size_t i = 0; i < left.size(); ++i) left[i] /= judge.pointsOf(i);
  return left;
}

}  // namespace

void judgeMethod(const LoadedArm& arm, std::vector<NormalEquations> normal, bool decoupled,
                 const IdentifyOptions& options, MethodResult& out) {
  out.available = true;
  out.geometry = arm.geometry;
  out.wrist_rows = wristPointEquations(arm);
  out.target_rows = reflectorEquations(arm);
  SubsetMethod subset;
  subset.unknown = out.estimate.identifiable;
  subset.normal = std::move(normal);
  if (decoupled) subset.reflectors = normalByPosture(out.target_rows);
  if (!out.wrist_rows.empty()) subset.at_wrist = DeflectionJudge(byPosture(out.wrist_rows));
  subset.at_targets = DeflectionJudge(byPosture(out.target_rows));
  out.subsets = studySubsets(subset, options.subsets);

  out.bootstrap = bootstrapPostures(subset, options.bootstrap);

  if (!out.wrist_rows.empty()) {
    out.at_wrist = compensationBy(out.estimate, subset.at_wrist, out.subsets.at_wrist);
    out.wrist_residual = residualByCase(out.wrist_rows, out.estimate.compliance);
  }
  out.at_targets = compensationBy(out.estimate, subset.at_targets, out.subsets.at_targets);
  out.target_residual = residualByCase(out.target_rows, out.estimate.compliance);
}

}  // namespace stiffscope
