#include "core/extended_model/method_equations.h"

#include <map>
#include <utility>

#include "core/extended_model/effect_offsets.h"
#include "core/identification/complete_pose.h"
#include "core/identification/decoupled_partial_pose.h"
#include "core/identification/estimate.h"
#include "core/numerics/parallel.h"

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

/// `machine`: what the effects of the machine do in this posture.
CaseEffects effectsIn(const EffectFit& effects, const Eigen::MatrixXd& steps, const effects::PostureStates& posture,
                      const PostureOffsets& machine, const Eigen::Isometry3d& fit_from_r0, const LoadCase& load_case) {
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

/// Where the elements of each posture begin, and after the last their end: those of one follow each other.
template <class Element, class Share>
std::vector<std::size_t> posturesOf(const std::vector<Element>& elements, const Share& share_posture) {
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (i == 0 || !share_posture(elements[i - 1], elements[i])) first.push_back(i);
  }
  first.push_back(elements.size());
  return first;
}

std::vector<std::size_t> posturesOf(const std::vector<identification::CaseEquations>& rows) {
  return posturesOf(rows, identification::sharePosture);
}

ExtendedNormal normalOf(const identification::CaseEquations& springs, const Eigen::MatrixXd& by_steps) {
  return {identification::normalEquations(springs), springs.matrix.transpose() * by_steps};
}

/// One point's or the reflectors' equations, a posture each; `by_steps(i)` of a case.
template <class BySteps>
std::vector<ExtendedEquations> equationsOf(const std::vector<identification::CaseEquations>& rows,
                                           const BySteps& by_steps) {
  const std::vector<std::size_t> first = posturesOf(rows);
  std::vector<ExtendedEquations> equations(first.size() - 1);
  numerics::smallWorkOnAllCores(equations.size(), [&](std::size_t p) {
    ExtendedEquations& own = equations[p];
    if (first[p + 1] == first[p] + 1) {
      own.springs = rows[first[p]];
      own.by_steps = by_steps(first[p]);
    } else {
      Eigen::Index count = 0, at = 0;
      for (std::size_t i = first[p]; i < first[p + 1]; ++i) count += rows[i].right.size();
      own.springs = {JointRows(count, rows[first[p]].matrix.cols()), Eigen::VectorXd(count), rows[first[p]].posture};
      for (std::size_t i = first[p]; i < first[p + 1]; ++i) {
        const Eigen::MatrixXd here = by_steps(i);
        own.by_steps.conservativeResize(count, here.cols());
        own.springs.matrix.middleRows(at, here.rows()) = rows[i].matrix;
        own.springs.right.segment(at, here.rows()) = rows[i].right;
        own.by_steps.middleRows(at, here.rows()) = here;
        at += here.rows();
      }
    }
    own.normal = normalOf(own.springs, own.by_steps);
  });
  return equations;
}

std::map<int, const diagnosis::GapPosture*> fittedPostures(const diagnosis::GapFit& fit) {
  std::map<int, const diagnosis::GapPosture*> postures;
  for (const diagnosis::GapPosture& one : fit.data->postures) postures[one.pose] = &one;
  return postures;
}

}  // namespace

std::vector<CaseEffects> caseEffects(const diagnosis::GapStudy& study, const EffectColumns& columns,
                                     const identification::Identification& result) {
  const std::map<int, const diagnosis::GapPosture*> postures = fittedPostures(study.fit);
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
  const std::vector<std::size_t> first =
      posturesOf(result.cases, [](const LoadCase& a, const LoadCase& b) { return a.pose == b.pose; });
  std::vector<CaseEffects> all(result.cases.size());
  numerics::onAllCores(first.size() - 1, [&](std::size_t p) {
    const effects::PostureStates states = effects.statesOf(result.cases[first[p]].pose);
    const PostureOffsets machine(effects, states, {true, false});
    for (std::size_t i = first[p]; i < first[p + 1]; ++i) {
      const LoadCase& load_case = result.cases[i];
      all[i] = effectsIn(effects, steps, states, machine, fit_from_r0, load_case);
      if (result.wrist.empty()) continue;
      all[i].wrist_machine =
          identification::wristByReflectors(load_case, result.frames.wrist.radii, result.wrist[i]) * all[i].by_machine;
    }
  });
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
    if (own.target_rows[i].right.size() != effects[i].by_steps.rows()) return equations;
  }
  equations.reflectors =
      equationsOf(own.target_rows, [&](std::size_t i) -> const Eigen::MatrixXd& { return effects[i].by_steps; });
  if (!own.wrist_rows.empty() && !result.wrist.empty()) {
    equations.wrist = equationsOf(own.wrist_rows, [&](std::size_t i) -> Eigen::MatrixXd {
      return identification::wristByReflectors(result.cases[i], result.frames.wrist.radii, result.wrist[i]) *
             effects[i].by_steps;
    });
  }
  if (method == Method::complete_pose)
    equations.pose = poseNormals(result, effects, result.characteristic_length.length);
  return equations;
}

std::vector<ExtendedNormal> poseNormals(const identification::Identification& result,
                                        const std::vector<CaseEffects>& effects, double length) {
  const identification::MethodResult& own = result.of(Method::complete_pose);
  const std::vector<std::size_t> first = posturesOf(own.pose_rows);
  std::vector<ExtendedNormal> normals(first.size() - 1);
  numerics::smallWorkOnAllCores(normals.size(), [&](std::size_t p) {
    for (std::size_t i = first[p]; i < first[p + 1]; ++i) {
      Eigen::MatrixXd by_steps =
          identification::poseByReflectors(own.geometry, result.cases[i], result.frames.tcp_in_flange) *
          effects[i].by_steps;
      by_steps.topRows<3>() /= length;
      ExtendedNormal one = normalOf(identification::normalised(own.pose_rows[i], length), by_steps);
      if (i == first[p]) {
        normals[p] = std::move(one);
      } else {
        normals[p].springs += one.springs;
        normals[p].by_steps += one.by_steps;
      }
    }
  });
  return normals;
}

namespace {

ExtendedNormal nothingOf(std::size_t joints) {
  return {identification::NormalEquations(static_cast<Eigen::Index>(joints))};
}

ExtendedNormal sumOf(const std::vector<ExtendedEquations>& postures, const std::vector<double>& weights,
                     std::size_t joints) {
  ExtendedNormal sum = nothingOf(joints);
  for (std::size_t p = 0; p < postures.size(); ++p) postures[p].normal.addTo(weights[p], sum);
  return sum;
}

/// What a method solves, summed over postures with weights.
class SummedEquations {
 public:
  SummedEquations(const MethodEquations& equations, Method method, const robot::JointMask& unknown,
                  const std::vector<double>& weights)
      : decoupled_(method == Method::decoupled_partial_pose), unknown_(unknown), first_(nothingOf(unknown.size())) {
    if (method == Method::complete_pose) {
      for (std::size_t p = 0; p < equations.pose.size(); ++p) equations.pose[p].addTo(weights[p], first_);
      return;
    }
    first_ = sumOf(decoupled_ ? equations.wrist : equations.reflectors, weights, unknown.size());
    if (decoupled_) second_ = sumOf(equations.reflectors, weights, unknown.size());
  }

  JointVector compliance(const Eigen::VectorXd& steps) const {
    return decoupled_ ? identification::solveDecoupled(first_.at(steps), second_.at(steps), unknown_)
                      : identification::solveNormal(first_.at(steps), unknown_);
  }

 private:
  bool decoupled_;
  const robot::JointMask& unknown_;
  ExtendedNormal first_, second_;
};

}  // namespace

void ExtendedNormal::addTo(double weight, ExtendedNormal& sum) const {
  if (weight == 0.0) return;
  sum.springs.matrix += weight * springs.matrix;
  sum.springs.right += weight * springs.right;
  if (sum.by_steps.cols() == 0) sum.by_steps.setZero(by_steps.rows(), by_steps.cols());
  sum.by_steps += weight * by_steps;
}

identification::NormalEquations ExtendedNormal::at(const Eigen::VectorXd& steps) const {
  identification::NormalEquations normal = springs;
  if (by_steps.cols() > 0) normal.right -= by_steps * steps;
  return normal;
}

JointVector solvedCompliance(const MethodEquations& equations, Method method, const robot::JointMask& unknown,
                             const std::vector<double>& weights, const Eigen::VectorXd& steps) {
  return SummedEquations(equations, method, unknown, weights).compliance(steps);
}

JointsByColumn complianceBySteps(const MethodEquations& equations, Method method, const robot::JointMask& unknown,
                                 Eigen::Index count) {
  const SummedEquations summed(equations, method, unknown, std::vector<double>(equations.reflectors.size(), 1.0));
  const JointVector here = summed.compliance(Eigen::VectorXd::Zero(count));
  JointsByColumn by_steps(here.size(), count);
  for (Eigen::Index k = 0; k < count; ++k) by_steps.col(k) = summed.compliance(Eigen::VectorXd::Unit(count, k)) - here;
  return by_steps;
}

}  // namespace stiffscope::extended_model
