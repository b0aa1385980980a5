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

/// From a geometry's R0 to that of the fit of the effects, both of the same readings.
Eigen::Isometry3d fitFrom(const frames::LoadingGeometry& from, const frames::LoadingGeometry& fit) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (from.r0_from_loading && fit.r0_from_loading) {
    motion = *fit.r0_from_loading * from.r0_from_loading->inverse();
  } else if (from.displacements_in_r0 && fit.displacements_in_r0) {
    motion.linear() = *fit.displacements_in_r0 * from.displacements_in_r0->transpose();
  }
  return motion;
}

/// Rows by three turned.
void turn(const Eigen::Matrix3d& rotation, Eigen::MatrixXd& rows) {
  for (Eigen::Index at = 0; at < rows.rows(); at += 3)
    rows.middleRows<3>(at) = rotation * rows.middleRows<3>(at).eval();
}

CaseEffects effectsIn(const EffectFit& effects, const Eigen::MatrixXd& steps, const effects::PostureStates& posture,
                      const Eigen::Isometry3d& fit_from_r0, const LoadCase& load_case) {
  const PostureOffsets machine(effects, posture, {true, false});
  const Eigen::Matrix3d back = fit_from_r0.linear().transpose();
  const std::size_t state = stateOf(posture, load_case.step);
  std::vector<int> targets;
  std::vector<Eigen::Vector3d> places;
  CaseEffects here;
  here.by_machine.resize(static_cast<Eigen::Index>(3 * load_case.targets.size()));
  Eigen::Index row = 0;
  for (const identification::TargetMove& move : load_case.targets) {
    // The offsets are those where the reflector was read: the corrected place and what the correction took off.
    const Eigen::Vector3d corrected = fit_from_r0 * move.unloaded;
    const Eigen::Vector3d place = corrected + machine.of(move.target, corrected).front();
    const std::vector<Eigen::Vector3d> offsets = machine.of(move.target, place);
    targets.push_back(move.target);
    places.push_back(place);
    here.by_machine.segment<3>(row) = back * (offsets[state] - offsets[0]);
    row += 3;
  }
  here.by_steps =
      displacementByEffects(*effects.input, effects.fit, columnsOf(effects), posture, state, targets, places) * steps;
  turn(back, here.by_steps);
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

std::map<int, const diagnosis::GapPosture*> posturesOf(const diagnosis::GapFit& fit) {
  std::map<int, const diagnosis::GapPosture*> postures;
  for (const diagnosis::GapPosture& one : fit.data.postures) postures[one.pose] = &one;
  return postures;
}

}  // namespace

std::vector<CaseEffects> caseEffects(const diagnosis::GapStudy& study, const EffectColumns& columns,
                                     const identification::Identification& result) {
  const std::map<int, const diagnosis::GapPosture*> postures = posturesOf(study.fit);
  const Eigen::Isometry3d fit_from_r0 = fitFrom(result.geometry, study.fit.state.geometry);
  std::vector<CaseEffects> all(result.cases.size());
  for (std::size_t i = 0; i < result.cases.size(); ++i) {
    const LoadCase& load_case = result.cases[i];
    std::vector<int> targets;
    std::vector<Eigen::Vector3d> places;
    for (const identification::TargetMove& move : load_case.targets) {
      targets.push_back(move.target);
      places.push_back(fit_from_r0 * move.unloaded);
    }
    const auto found = postures.find(load_case.pose);
    if (found == postures.end()) {
      all[i].by_steps.setZero(static_cast<Eigen::Index>(3 * targets.size()),
                              static_cast<Eigen::Index>(columns.parameters.size()));
      continue;
    }
    const effects::PostureStates& states = found->second->states;
    all[i].by_steps = displacementByEffects(*study.input, study.fit, columns, states, stateOf(states, load_case.step),
                                            targets, places);
    turn(fit_from_r0.linear().transpose(), all[i].by_steps);
  }
  return all;
}

std::vector<CaseEffects> caseEffects(const EffectFit& effects, const Eigen::MatrixXd& steps,
                                     const identification::Identification& result) {
  const Eigen::Isometry3d fit_from_r0 = fitFrom(result.geometry, effects.fit.state.geometry);
  std::vector<CaseEffects> all;
  for (std::size_t i = 0; i < result.cases.size(); ++i) {
    const LoadCase& load_case = result.cases[i];
    all.push_back(effectsIn(effects, steps, effects.day.at(load_case.pose).states, fit_from_r0, load_case));
    if (result.wrist.empty()) continue;
    all.back().wrist_machine =
        identification::wristByReflectors(load_case, result.frames.wrist.radii, result.wrist[i]) *
        all.back().by_machine;
  }
  return all;
}

MethodEquations methodEquations(const identification::Identification& result, Method method,
                                const std::vector<CaseEffects>& effects, std::optional<double> length) {
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
    const double divisor = length.value_or(result.characteristic_length.length);
    Eigen::MatrixXd pose =
        identification::poseByReflectors(own.geometry, load_case, result.frames.tcp_in_flange) * effects[i].by_steps;
    pose.topRows<3>() /= divisor;
    append(identification::normalised(own.pose_rows[i], divisor), pose, equations.solved);
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
