#include "core/comparison/without_each_posture.h"

#include "core/identification/decoupled_partial_pose.h"

namespace stiffscope {

namespace {

using Normals = std::vector<NormalEquations>;

Normals normalOf(const std::vector<CaseEquations>& equations) {
  Normals normal;
  for (const CaseEquations& one : equations) normal.push_back(normalEquations(one));
  return normal;
}

/// Complete Pose's equations, which its result does not keep, from the load cases.
Normals completePoseNormals(const Identification& result) {
  const MethodResult& method = result.of(Method::complete_pose);
  const auto torques =
      result.finite_deflection
          ? jointTorquesWithGeometricStiffness(method.geometry, result.cases, method.estimate.compliance)
          : jointTorques(result.cases);
  Normals normal;
  for (std::size_t i = 0; i < result.cases.size(); ++i) {
    const CaseEquations pose =
        completePoseEquations(result.cases[i], result.frames.tcp_in_flange, torques[i]);
    normal.push_back(normalEquations(normalised(pose, result.characteristic_length.length)));
  }
  return normal;
}

NormalEquations without(const NormalEquations& sum, const NormalEquations& one) {
  return {sum.matrix - one.matrix, sum.right - one.right};
}

std::vector<Vector6d> movesOf(const Normals& normals, const JointMask& unknown) {
  const NormalEquations sum = sumOf(normals);
  const Vector6d all = solveNormal(sum, unknown);
  std::vector<Vector6d> moves;
  for (const NormalEquations& one : normals) moves.push_back(all - solveNormal(without(sum, one), unknown));
  return moves;
}

std::vector<Vector6d> decoupledMoves(const Normals& wrist, const Normals& reflectors,
                                     const JointMask& unknown) {
  const NormalEquations wrist_sum = sumOf(wrist), reflector_sum = sumOf(reflectors);
  const Vector6d all = solveDecoupled(wrist_sum, reflector_sum, unknown);
  std::vector<Vector6d> moves;
  for (std::size_t p = 0; p < wrist.size(); ++p) {
    moves.push_back(
        all - solveDecoupled(without(wrist_sum, wrist[p]), without(reflector_sum, reflectors[p]), unknown));
  }
  return moves;
}

}  // namespace

std::vector<Vector6d> moveByEachPosture(const Identification& result, Method method) {
  const MethodResult& solved = result.of(method);
  if (!solved.available) return {};
  const JointMask& unknown = solved.estimate.identifiable;
  switch (method) {
    case Method::complete_pose:
      return movesOf(completePoseNormals(result), unknown);
    case Method::partial_pose:
      return movesOf(normalOf(solved.target_rows), unknown);
    case Method::decoupled_partial_pose:
      return decoupledMoves(normalOf(solved.wrist_rows), normalOf(solved.target_rows), unknown);
  }
  return {};
}

}  // namespace stiffscope
