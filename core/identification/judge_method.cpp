#include "core/identification/judge_method.h"

#include <optional>
#include <utility>

#include "core/identification/posture_influence.h"

namespace stiffscope {

namespace {

Compensation compensationBy(const StiffnessEstimate& estimate, const DeflectionJudge& judge,
                            const SubsetJudgement& subsets) {
  return {judge.compensated(estimate.compliance), subsets.compensated};
}

/// Mean over a case's points of what is left of the displacement; `by_posture` judges the same, which with one load step
/// is a case each.
std::vector<double> residualByCase(const std::vector<CaseEquations>& rows, const DeflectionJudge& by_posture,
                                   const Vector6d& compliance) {
  std::optional<DeflectionJudge> by_case;
  const DeflectionJudge& judge = by_posture.postures() == rows.size() ? by_posture : by_case.emplace(rows);
  std::vector<double> left = judge.residual(compliance);
  for (std::size_t i = 0; i < left.size(); ++i) left[i] /= judge.pointsOf(i);
  return left;
}

}  // namespace

void judgeMethod(const LoadingGeometry& geometry, PointEquations equations, std::vector<NormalEquations> normal,
                 bool decoupled, const IdentifyOptions& options, MethodResult& out) {
  out.available = true;
  out.geometry = geometry;
  out.wrist_rows = std::move(equations.wrist);
  out.target_rows = std::move(equations.reflectors);
  SubsetMethod subset;
  subset.unknown = out.estimate.identifiable;
  subset.normal = std::move(normal);
  if (decoupled) subset.reflectors = normalByPosture(out.target_rows);
  if (!out.wrist_rows.empty()) subset.at_wrist = DeflectionJudge::byPosture(out.wrist_rows);
  subset.at_targets = DeflectionJudge::byPosture(out.target_rows);
  out.subsets = studySubsets(subset, options.subsets);

  out.bootstrap = bootstrapPostures(subset, options.bootstrap);

  if (!out.wrist_rows.empty()) {
    out.at_wrist = compensationBy(out.estimate, subset.at_wrist, out.subsets.at_wrist);
    out.wrist_residual = residualByCase(out.wrist_rows, subset.at_wrist, out.estimate.compliance);
  }
  out.at_targets = compensationBy(out.estimate, subset.at_targets, out.subsets.at_targets);
  out.target_residual = residualByCase(out.target_rows, subset.at_targets, out.estimate.compliance);
}

}  // namespace stiffscope
