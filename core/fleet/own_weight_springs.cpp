#include "core/fleet/own_weight_springs.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/comparison/paired_days.h"
#include "core/identification/estimate.h"

namespace stiffscope::fleet {

namespace {

/// Geometry and the compliances of all joints, of whatever sign: one that was refused on one day and not on another
/// would make two models of them.
calibration::ArmFit fitOfAllJoints(const calibration::Calibration& calibration) {
  std::vector<calibration::EffectPart> parts = calibration::jointCompliances(calibration.day);
  for (calibration::EffectPart& part : parts) {
    for (calibration::EffectTerm& term : part.terms) term.positive = false;
  }
  const calibration::ArmFit& geometry = calibration.geometry().fit;
  return calibration::fitArm(calibration.day, geometry.place, parts,
                             {.robust = false, .weights = calibration.best().fit.weights}, &geometry);
}

}  // namespace

SpringsOfDay ownWeightSprings(const calibration::Calibration& calibration) {
  const calibration::UnloadedDay& day = calibration.day;
  SpringsOfDay springs(day.arm.joints());
  if (!calibration.reason.empty() || !day.masses_known) return springs;
  const calibration::ArmFit fit = fitOfAllJoints(calibration);
  if (!fit.done) return springs;
  std::vector<Eigen::Index> joints, columns;  // of the terms, in the unknowns
  Eigen::Index size = 0;
  for (const calibration::EffectPart& part : fit.parts) {
    for (const calibration::EffectTerm& term : part.terms) {
      const auto found = std::find(fit.free.begin(), fit.free.end(), static_cast<int>(fit.steps.size() + size));
      if (found != fit.free.end()) {
        joints.push_back(term.compliance_of), columns.push_back(found - fit.free.begin());
        springs.compliance[term.compliance_of] = fit.sizes[size];
      }
      ++size;
    }
  }
  const comparison::FitEquations fitted(day, fit);
  const auto postures = static_cast<Eigen::Index>(fitted.postures.size());
  const Eigen::Index unknowns = fitted.normal_inverse.rows();
  if (postures == 0 || joints.empty()) return springs;
  springs.influences.assign(day.postures.size(), JointVector::Zero(day.arm.joints()));
  std::vector<identification::InfluenceCovariance> covariances(
      joints.size(), {Eigen::VectorXd(postures), Eigen::MatrixXd(unknowns, postures), -fitted.normal_inverse});
  for (Eigen::Index p = 0; p < postures; ++p) {
    const auto at = static_cast<std::size_t>(p);
    const Eigen::MatrixXd& rows = fitted.equations[at].by_parameters;
    const Eigen::MatrixXd gain = rows * fitted.normal_inverse;
    const Eigen::MatrixXd root = identification::inverseRootOfRest(gain * rows.transpose());
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const Eigen::VectorXd along = root * gain.col(columns[k]);
      springs.influences[fitted.postures[at]][joints[k]] = along.dot(fitted.equations[at].residual);
      covariances[k].own[p] = along.squaredNorm();
      covariances[k].through.col(p) = rows.transpose() * along;
    }
  }
  springs.available = true;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Eigen::Index joint = joints[k];
    springs.dof[joint] = identification::matchedDof(covariances[k]);
    double variance = 0.0;
    for (const JointVector& one : springs.influences) variance += one[joint] * one[joint];
    springs.identifiable[static_cast<std::size_t>(joint)] =
        springs.dof[joint] > 1.0 && springs.compliance[joint] > kSeen * std::sqrt(variance);
  }
  return springs;
}

}  // namespace stiffscope::fleet
