#pragma once

#include <vector>

#include "core/diagnosis/gap_study.h"
#include "core/extended_model/effect_offsets.h"
#include "core/extended_model/fitted_effects.h"
#include "core/identification/identification.h"

namespace stiffscope::extended_model {

/// What the effects do in one load case of an identification from corrected readings (correctedFor). R0, m; three rows
/// a reflector of the case.
struct CaseEffects {
  Eigen::MatrixXd by_steps;       ///< displacement by a unit of each step of the effects' parameters, to first order
  Eigen::VectorXd by_machine;     ///< displacement that the effects of the machine add to that of its springs
  Eigen::VectorXd wrist_machine;  ///< the same of P_wrist; empty where it is not measured
};

/// One a case of `result`. `steps`: of the effects' free parameters, one a column (EffectFit::free the rows).
std::vector<CaseEffects> caseEffects(const EffectFit& effects, const Eigen::MatrixXd& steps,
                                     const identification::Identification& result);

/// Effects of any parameters of a study's equations, a step each of its own unit; `by_machine` empty. In postures that
/// the study does not have (not every reflector read in all load steps) nothing moves.
std::vector<CaseEffects> caseEffects(const diagnosis::GapStudy& study, const EffectColumns& columns,
                                     const identification::Identification& result);

/// A method's normal equations of one posture with the effects in them, A c + E z = b: z the steps by which the
/// effects' parameters leave their fitted values, b the corrected readings' displacement.
struct ExtendedNormal {
  identification::NormalEquations springs;  ///< A^T A and A^T b
  JointsByColumn by_steps = {};             ///< A^T E

  void addTo(double weight, ExtendedNormal& sum) const;
  identification::NormalEquations at(const Eigen::VectorXd& steps) const;
};

/// Equations and normal equations of one posture.
struct ExtendedEquations {
  identification::CaseEquations springs;  ///< A and b
  Eigen::MatrixXd by_steps;               ///< E
  ExtendedNormal normal;

  /// b - E z.
  Eigen::VectorXd rightAt(const Eigen::VectorXd& steps) const { return springs.right - by_steps * steps; }
};

/// Those of one method, a posture each, at its compliances (K_c, middle posture) and in its geometry.
struct MethodEquations {
  std::vector<ExtendedEquations> reflectors;  ///< which the decoupled method solves second
  std::vector<ExtendedEquations> wrist;       ///< P_wrist's; empty where not measured
  std::vector<ExtendedNormal> pose;           ///< Complete Pose's own, normalised; empty for the other methods
};

/// Empty where the method's cases are not those of `result.cases`.
MethodEquations methodEquations(const identification::Identification& result, identification::Method method,
                                const std::vector<CaseEffects>& effects);

/// Complete Pose's own at a characteristic length (m), a posture each.
std::vector<ExtendedNormal> poseNormals(const identification::Identification& result,
                                        const std::vector<CaseEffects>& effects, double length);

/// The method's compliances with the effects moved by `steps`, from postures with weights.
JointVector solvedCompliance(const MethodEquations& equations, identification::Method method,
                             const robot::JointMask& unknown, const std::vector<double>& weights,
                             const Eigen::VectorXd& steps);

/// How the compliances follow each of `count` steps, from all postures: one column a step.
JointsByColumn complianceBySteps(const MethodEquations& equations, identification::Method method,
                                 const robot::JointMask& unknown, Eigen::Index count);

}  // namespace stiffscope::extended_model
