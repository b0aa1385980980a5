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

namespace {

/// Moments of the residuals, and what unit variances make of them: coordinates first, then joints.
struct Moments {
  Eigen::MatrixXd normal;
  Eigen::VectorXd right;
};

class Estimating {
 public:
  Estimating(const FitEquations& fit, const std::vector<Eigen::VectorXd>& residuals)
      : fit_(fit), residuals_(residuals), prior_(Eigen::MatrixXd::Identity(unknowns(), unknowns())) {
    // Unknowns by a root of the inverse normal matrix: the readings and the prior together say one of each.
    const Eigen::MatrixXd root = covarianceRoot(fit.normal_inverse);
    for (const calibration::PostureEquations& of : fit.equations) {
      columns_.emplace_back(of.by_parameters * root);
      prior_.noalias() -= columns_.back().transpose() * columns_.back();
    }
  }

  /// With all errors in parts of those of `weights`.
  Moments momentsBy(const ErrorComponents& weights) const {
    const int joints = fit_.joints, count = 1 + joints;
    std::vector<Whitened> postures;
    Eigen::MatrixXd information = prior_;
    for (std::size_t p = 0; p < columns_.size(); ++p) {
      postures.push_back(whitened(p, weights));
      information.noalias() += postures.back().fitted.transpose() * postures.back().fitted;
    }
    // Orthonormal columns of what the fit takes, and the residuals without it.
    const Eigen::MatrixXd root =
        covarianceRoot(solvePositive(information, Eigen::MatrixXd::Identity(unknowns(), unknowns())));
    Eigen::VectorXd taken = Eigen::VectorXd::Zero(unknowns());
    for (Whitened& of : postures) {
      of.fitted = (of.fitted * root).eval();
      taken.noalias() += of.fitted.transpose() * of.residual;
    }
    Moments moments{Eigen::MatrixXd::Zero(count, count), Eigen::VectorXd::Zero(count)};
    PerJoint<Eigen::MatrixXd> inside(static_cast<std::size_t>(joints), Eigen::MatrixXd::Zero(unknowns(), unknowns()));
    Eigen::MatrixXd coordinates_inside = Eigen::MatrixXd::Zero(unknowns(), unknowns());
    for (const Whitened& of : postures) {
      const Eigen::VectorXd left = of.residual - of.fitted * taken;
      const JointMatrix products = of.turns.transpose() * of.turns;
      const Eigen::MatrixXd turns_fitted = of.fitted.transpose() * of.turns,
                            coordinates_fitted = of.coordinates * of.fitted,
                            coordinates_turns = of.coordinates * of.turns;
      const JointMatrix fitted_products = turns_fitted.transpose() * turns_fitted;
      const JointVector along = of.turns.transpose() * left;
      moments.right[0] += left.dot(of.coordinates * left);
      moments.normal(0, 0) += of.coordinates.squaredNorm() - 2.0 * coordinates_fitted.squaredNorm();
      coordinates_inside.noalias() += of.fitted.transpose() * coordinates_fitted;
      for (int k = 0; k < joints; ++k) {
        moments.right[k + 1] += along[k] * along[k];
        moments.normal(0, k + 1) += of.turns.col(k).dot(coordinates_turns.col(k)) -
                                    2.0 * turns_fitted.col(k).dot(of.fitted.transpose() * coordinates_turns.col(k));
        inside[static_cast<std::size_t>(k)].noalias() += turns_fitted.col(k) * turns_fitted.col(k).transpose();
        for (int l = 0; l < joints; ++l)
          moments.normal(k + 1, l + 1) +=
              products(k, l) * products(k, l) - 2.0 * products(k, l) * fitted_products(k, l);
      }
    }
    moments.normal(0, 0) += coordinates_inside.squaredNorm();
    for (int k = 0; k < joints; ++k) {
      const Eigen::MatrixXd& own = inside[static_cast<std::size_t>(k)];
      moments.normal(0, k + 1) += coordinates_inside.cwiseProduct(own).sum();
      moments.normal(k + 1, 0) = moments.normal(0, k + 1);
      for (int l = 0; l < joints; ++l)
        moments.normal(k + 1, l + 1) += own.cwiseProduct(inside[static_cast<std::size_t>(l)]).sum();
    }
    return moments;
  }

 private:
  /// A posture's rows where all errors are one: L^-1 of their covariance L L^T times each.
  struct Whitened {
    Eigen::MatrixXd fitted, turns, coordinates;  ///< `coordinates`: covariance of unit errors of coordinates
    Eigen::VectorXd residual;
  };

  Whitened whitened(std::size_t p, const ErrorComponents& weights) const {
    const Eigen::MatrixXd& turns = fit_.equations[p].by_angles;
    const Eigen::MatrixXd lower =
        choleskyLower(turns * weights.angle.asDiagonal() * turns.transpose() +
                      weights.coordinate * Eigen::MatrixXd::Identity(turns.rows(), turns.rows()));
    const auto whiten = lower.triangularView<Eigen::Lower>();
    const Eigen::MatrixXd inverse = whiten.solve(Eigen::MatrixXd::Identity(turns.rows(), turns.rows()));
    return {inverse * columns_[p], inverse * turns, inverse * inverse.transpose(), inverse * residuals_[p]};
  }

  Eigen::Index unknowns() const { return fit_.normal_inverse.rows(); }

  const FitEquations& fit_;
  const std::vector<Eigen::VectorXd>& residuals_;
  Eigen::MatrixXd prior_;
  std::vector<Eigen::MatrixXd> columns_;  ///< of each posture, by those unknowns
};

/// Variances of such moments, none negative, that of coordinates no less than `least_coordinate`.
ErrorComponents solved(const Moments& moments, double least_coordinate) {
  const Eigen::VectorXd beyond = moments.right - least_coordinate * moments.normal.col(0);
  std::vector<int> kept(static_cast<std::size_t>(beyond.size()));
  std::iota(kept.begin(), kept.end(), 0);
  ErrorComponents errors(static_cast<int>(beyond.size()) - 1);
  errors.coordinate = 0.0;
  while (true) {
    const Eigen::MatrixXd own = moments.normal(kept, kept);
    const Eigen::VectorXd scale = own.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::VectorXd found = scale.cwiseProduct(leastSquaresSolution(
        scale.asDiagonal() * own * scale.asDiagonal(), scale.cwiseProduct(Eigen::VectorXd(beyond(kept)))));
    Eigen::Index worst = 0;
    const double least = found.cwiseQuotient(scale).minCoeff(&worst);
    if (least < 0.0 && kept.size() > 1) {
      kept.erase(kept.begin() + worst);
      continue;
    }
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const double value = std::max(0.0, found[static_cast<Eigen::Index>(i)]);
      (kept[i] == 0 ? errors.coordinate : errors.angle[kept[i] - 1]) = value;
    }
    errors.coordinate += least_coordinate;
    return errors;
  }
}

}  // namespace

ErrorComponents errorComponents(const FitEquations& fit, const std::vector<Eigen::VectorXd>& residuals,
                                double least_coordinate) {
  constexpr int kTurns = 10;
  constexpr double kSettled = 0.01;  // of a variance's own standard deviation
  constexpr double kLeastWeight = 1e-6;
  const Estimating estimating(fit, residuals);
  ErrorComponents errors(fit.joints);
  for (int turn = 0; turn < kTurns; ++turn) {
    ErrorComponents weights = errors;
    weights.coordinate = std::max(kLeastWeight, weights.coordinate);
    const Moments moments = estimating.momentsBy(weights);
    const ErrorComponents before = errors;
    errors = solved(moments, least_coordinate);
    Eigen::VectorXd change(1 + fit.joints);
    change << errors.coordinate - before.coordinate, errors.angle - before.angle;
    // Var(theta) = 2 N^-1 where the errors are as the weights say.
    if ((change.cwiseAbs2().array() * moments.normal.diagonal().array() < 2.0 * kSettled * kSettled).all()) break;
  }
  return errors;
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
