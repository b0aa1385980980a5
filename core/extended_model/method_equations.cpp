#include "core/extended_model/method_equations.h"

#include <map>
#include <utility>

#include "core/extended_model/effect_offsets.h"
#include "core/identification/complete_pose.h"
#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/estimate.h"

namespace stiffscope::extended_model {

namespace {

using identification::LoadCase;
using identification::Method;

std::size_t stateOf(const effects::PostureStates& posture, int step) {
  for (std::size_t s = 1; s < posture.size(); ++s) {
    if (posture[s].step == step) return s;
  }
  return 0;
}

/// From R0 as the fit of the effects has it to that of another geometry of the same readings.
Eigen::Matrix3d turnFromFit(const EffectFit& effects, const frames::LoadingGeometry& to) {
  const frames::LoadingGeometry& fit = effects.fit.state.geometry;
  if (to.r0_from_loading && fit.r0_from_loading)
    return to.r0_from_loading->linear() * fit.r0_from_loading->linear().transpose();
  if (to.displacements_in_r0 && fit.displacements_in_r0)
    return *to.displacements_in_r0 * fit.displacements_in_r0->transpose();
  return Eigen::Matrix3d::Identity();
}

CaseEffects effectsIn(const EffectFit& effects, const Eigen::MatrixXd& steps, const effects::PostureStates& posture,
                      const PostureOffsets& machine, const LoadCase& load_case) {
  const std::size_t state = stateOf(posture, load_case.step);
  std::vector<int> targets;
  std::vector<Eigen::Vector3d> places;
  CaseEffects here;
  here.by_machine.resize(static_cast<Eigen::Index>(3 * load_case.targets.size()));
  Eigen::Index row = 0;
  for (const identification::TargetMove& move : load_case.targets) {
    targets.push_back(move.target);
    places.push_back(move.unloaded);
    const std::vector<Eigen::Vector3d> offsets = machine.of(move.target, move.unloaded);
    here.by_machine.segment<3>(row) = offsets[state] - offsets[0];
    row += 3;
  }
  here.by_steps = displacementByEffects(effects, posture, state, targets, places) * steps;
  return here;
}

/// Appends a case's equations to those of its posture.
void append(const identification::CaseEquations& springs, const Eigen::MatrixXd& by_steps,
            std::vector<ExtendedEquations>& postures) {
  if (postures.empty() || !identification::sharePosture(postures.back().springs, springs)) {
    postures.push_back({springs, by_steps, {}, {}});
    return;
  }
  ExtendedEquations& whole = postures.back();
  const Eigen::Index before = whole.springs.right.size(), rows = springs.right.size();
  whole.springs.matrix.conservativeResize(before + rows, Eigen::NoChange);
  whole.springs.right.conservativeResize(before + rows);
  whole.by_steps.conservativeResize(before + rows, Eigen::NoChange);
  whole.springs.matrix.bottomRows(rows) = springs.matrix;
  whole.springs.right.tail(rows) = springs.right;
  whole.by_steps.bottomRows(rows) = by_steps;
}

void fillNormal(std::vector<ExtendedEquations>& postures) {
  for (ExtendedEquations& one : postures) {
    one.normal = identification::normalEquations(one.springs);
    one.normal_by_steps = one.springs.matrix.transpose() * one.by_steps;
  }
}

}  // namespace

std::vector<CaseEffects> caseEffects(const EffectFit& effects, const Eigen::MatrixXd& steps,
                                     const identification::Identification& result) {
  std::map<int, const diagnosis::GapPosture*> postures;
  for (const diagnosis::GapPosture& one : effects.fit.data.postures) postures[one.pose] = &one;
  const Eigen::Matrix3d turn = turnFromFit(effects, result.geometry);
  std::vector<CaseEffects> all;
  for (std::size_t i = 0; i < result.cases.size(); ++i) {
    const LoadCase& load_case = result.cases[i];
    const effects::PostureStates& states = postures.at(load_case.pose)->states;
    const PostureOffsets machine(effects, states, {true, false});
    all.push_back(effectsIn(effects, steps, states, machine, load_case));
    for (Eigen::Index row = 0; row < all.back().by_machine.size(); row += 3) {
      all.back().by_machine.segment<3>(row) = turn * all.back().by_machine.segment<3>(row).eval();
      all.back().by_steps.middleRows<3>(row) = turn * all.back().by_steps.middleRows<3>(row).eval();
    }
    if (result.wrist.empty()) continue;
    all.back().wrist_machine =
        identification::wristByReflectors(load_case, result.frames.wrist.radii, result.wrist[i]) *
        all.back().by_machine;
  }
  return all;
}

MethodEquations methodEquations(const identification::Identification& result, Method method,
                                const std::vector<CaseEffects>& effects) {
  const identification::MethodResult& own = result.of(method);
  MethodEquations equations;
  const bool alike = own.target_rows.size() == result.cases.size() &&
                     (own.wrist_rows.empty() || own.wrist_rows.size() == result.cases.size()) &&
                     (method != Method::complete_pose || own.pose_rows.size() == result.cases.size());
  if (!alike) return equations;
  for (std::size_t i = 0; i < result.cases.size(); ++i) {
    const LoadCase& load_case = result.cases[i];
    if (own.target_rows[i].right.size() != effects[i].by_steps.rows()) return {};
    append(own.target_rows[i], effects[i].by_steps, equations.reflectors);
    if (!own.wrist_rows.empty() && !result.wrist.empty()) {
      append(own.wrist_rows[i],
             identification::wristByReflectors(load_case, result.frames.wrist.radii, result.wrist[i]) *
                 effects[i].by_steps,
             equations.wrist);
    }
    if (method != Method::complete_pose) continue;
    const double length = result.characteristic_length.length;
    Eigen::MatrixXd pose =
        identification::poseByReflectors(own.geometry, load_case, result.frames.tcp_in_flange) * effects[i].by_steps;
    pose.topRows<3>() /= length;
    append(identification::normalised(own.pose_rows[i], length), pose, equations.solved);
  }
  for (auto* postures : {&equations.solved, &equations.reflectors, &equations.wrist}) fillNormal(*postures);
  if (method == Method::partial_pose) equations.solved = equations.reflectors;
  if (method == Method::decoupled_partial_pose) equations.solved = equations.wrist;
  return equations;
}

Vector6d solvedCompliance(const MethodEquations& equations, Method method, const robot::JointMask& unknown,
                          const std::vector<double>& weights, const Eigen::VectorXd& steps) {
  const auto sum = [&](const std::vector<ExtendedEquations>& postures) {
    identification::NormalEquations whole;
    for (std::size_t p = 0; p < postures.size(); ++p) {
      if (weights[p] == 0.0) continue;
      whole.matrix += weights[p] * postures[p].normal.matrix;
      whole.right += weights[p] * (postures[p].normal.right - postures[p].normal_by_steps * steps);
    }
    return whole;
  };
  return method == Method::decoupled_partial_pose
             ? identification::solveDecoupled(sum(equations.solved), sum(equations.reflectors), unknown)
             : identification::solveNormal(sum(equations.solved), unknown);
}

}  // namespace stiffscope::extended_model
