#include "core/comparison/paired_days.h"

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>

#include "metrology/linear_algebra.h"

namespace stiffscope::comparison {

FitEquations::FitEquations(const calibration::UnloadedDay& day, const calibration::ArmFit& fit)
    : joints(day.arm.joints()) {
  std::size_t reading = 0;
  for (std::size_t i = 0; i < day.postures.size(); ++i) {
    calibration::PostureEquations of = calibration::equationsOf(day, fit, i, reading);
    reading += day.postures[i].readings.size();
    if (of.residual.size() == 0) continue;
    postures.push_back(i);
    equations.push_back(std::move(of));
  }
  // As the fit has it, without what it takes the errors to be.
  const double scale = std::max(1.0, fit.chi2_per_dof) * (fit.model_sd > 0.0 ? fit.design_effect : 1.0);
  normal_inverse = fit.covariance / scale;
}

ErrorComponents errorComponents(const FitEquations& fit, const std::vector<Eigen::VectorXd>& residuals) {
  const int joints = fit.joints, count = 1 + joints;  // coordinates, then joints
  const Eigen::Index unknowns = fit.normal_inverse.rows();
  // Q^T A of an orthonormal basis Q of the fit's columns: by a root of the inverse normal matrix.
  const Eigen::MatrixXd root = covarianceRoot(fit.normal_inverse);
  PerJoint<Eigen::MatrixXd> gram(static_cast<std::size_t>(joints),
                                 Eigen::MatrixXd::Zero(unknowns, unknowns));  // of Q^T a, over postures
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  double basis = 0.0;
  for (std::size_t p = 0; p < fit.equations.size(); ++p) {
    const calibration::PostureEquations& of = fit.equations[p];
    const Eigen::MatrixXd in_basis = root.transpose() * of.by_parameters.transpose();
    const Eigen::MatrixXd turns = in_basis * of.by_angles;
    const JointMatrix products = of.by_angles.transpose() * of.by_angles, inside = turns.transpose() * turns;
    basis += in_basis.squaredNorm();
    normal(0, 0) += static_cast<double>(of.residual.size());
    right[0] += residuals[p].squaredNorm();
    const JointVector along = of.by_angles.transpose() * residuals[p];
    for (int k = 0; k < joints; ++k) {
      normal(0, k + 1) += products(k, k) - inside(k, k);
      right[k + 1] += along[k] * along[k];
      gram[static_cast<std::size_t>(k)].noalias() += turns.col(k) * turns.col(k).transpose();
      for (int l = 0; l < joints; ++l)
        normal(k + 1, l + 1) += products(k, l) * products(k, l) - 2.0 * products(k, l) * inside(k, l);
    }
  }
  normal(0, 0) -= basis;
  for (int k = 0; k < joints; ++k) {
    normal(k + 1, 0) = normal(0, k + 1);
    for (int l = 0; l < joints; ++l) {
      normal(k + 1, l + 1) += gram[static_cast<std::size_t>(k)].cwiseProduct(gram[static_cast<std::size_t>(l)]).sum();
    }
  }
  std::vector<int> kept(static_cast<std::size_t>(count));
  std::iota(kept.begin(), kept.end(), 0);
  ErrorComponents errors(joints);
  while (true) {
    const Eigen::MatrixXd own = normal(kept, kept);
    const Eigen::VectorXd scale = own.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::VectorXd found = scale.cwiseProduct(leastSquaresSolution(
        scale.asDiagonal() * own * scale.asDiagonal(), scale.cwiseProduct(Eigen::VectorXd(right(kept)))));
    Eigen::Index worst = 0;
    const double least = found.cwiseQuotient(scale).minCoeff(&worst);
    if (least < 0.0 && kept.size() > 1) {
      kept.erase(kept.begin() + worst);
      continue;
    }
    errors.coordinate = 0.0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const double value = std::max(0.0, found[static_cast<Eigen::Index>(i)]);
      (kept[i] == 0 ? errors.coordinate : errors.angle[kept[i] - 1]) = value;
    }
    return errors;
  }
}

Eigen::MatrixXd covarianceBy(const FitEquations& fit, const ErrorComponents& errors) {
  const Eigen::Index unknowns = fit.normal_inverse.rows();
  Eigen::MatrixXd plain = Eigen::MatrixXd::Zero(unknowns, unknowns), turned = plain;
  for (const calibration::PostureEquations& of : fit.equations) {
    plain.noalias() += of.by_parameters.transpose() * of.by_parameters;
    const Eigen::MatrixXd turns = of.by_parameters.transpose() * of.by_angles * errors.angle.cwiseSqrt().asDiagonal();
    turned.noalias() += turns * turns.transpose();
  }
  const Eigen::MatrixXd& inverse = fit.normal_inverse;
  const Eigen::MatrixXd by_errors = inverse * (errors.coordinate * plain + turned) * inverse;
  return by_errors + (inverse - inverse * plain * inverse);
}

}  // namespace stiffscope::comparison
