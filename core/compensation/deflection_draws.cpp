#include "core/compensation/compensate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/extended_model/effect_deflection.h"
#include "core/numerics/random.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::compensation {

namespace {

using identification::StiffnessEstimate;
using numerics::RandomStream;

constexpr Eigen::Index kDraws = 3000;  // 75 beyond each end of a 95 % interval

/// Standard normal numbers whose sample mean is zero and whose sample covariance is one: first-order standard
/// uncertainties made of them are exact.
Eigen::MatrixXd standardNormal(Eigen::Index rows, Eigen::Index draws, RandomStream& random) {
  Eigen::MatrixXd z(rows, draws);
  for (double& one : z.reshaped()) one = random.normal();
  z.colwise() -= z.rowwise().mean().eval();
  if (rows == 0 || draws <= rows) return z;
  const Eigen::MatrixXd covariance = z * z.transpose() / static_cast<double>(draws);
  return choleskyLower(covariance).triangularView<Eigen::Lower>().solve(z);
}

/// Normal numbers of a covariance; not a number where that is not.
Eigen::MatrixXd normalDraws(const JointMatrix& covariance, Eigen::Index draws, RandomStream& random) {
  const Eigen::MatrixXd z = standardNormal(covariance.rows(), draws, random);
  if (!covariance.allFinite())
    return Eigen::MatrixXd::Constant(covariance.rows(), draws, std::numeric_limits<double>::quiet_NaN());
  return covarianceRoot(covariance) * z;
}

void addUnknownJoints(const StiffnessEstimate& estimate, DeflectionDraws& draws, RandomStream& random) {
  const auto joints = static_cast<int>(estimate.compliance.size());
  for (int j = 0; j < joints; ++j) {
    if (estimate.identifiable[static_cast<std::size_t>(j)]) continue;
    const double weakest =
        std::max({0.0, j > 0 ? estimate.compliance[j - 1] : 0.0, j < joints - 1 ? estimate.compliance[j + 1] : 0.0});
    for (double& c : draws.compliance.row(j)) c = weakest * random.uniform();
  }
}

void addCommon(double load_sd, DeflectionDraws& draws, RandomStream& random) {
  draws.load = load_sd * standardNormal(1, draws.size(), random).transpose();
  draws.model_error = standardNormal(3, draws.size(), random);
}

/// `known`: joints whose stiffness is from elsewhere. What has been drawn of the day's joints does not have them.
JointMatrix withKnown(const JointMatrix& others, const StiffnessEstimate& estimate) {
  JointMatrix covariance = others;
  for (int j = 0; j < covariance.rows(); ++j) {
    if (estimate.identifiable[static_cast<std::size_t>(j)] && covariance(j, j) == 0.0)
      covariance(j, j) = estimate.covariance(j, j);
  }
  return covariance;
}

DeflectionDraws hiddenDraws(const extended_model::ExtendedModel& model, identification::Method method, double load_sd) {
  const extended_model::HiddenDraws& hidden = model.hidden->draws;
  const extended_model::HiddenDraws::OfMethod& own = hidden.methods[static_cast<std::size_t>(method)];
  const StiffnessEstimate &estimate = model.with.of(method).estimate, &alone = model.without.of(method).estimate;
  const auto possible = static_cast<Eigen::Index>(own.possible.size());
  const Eigen::Index each = std::max<Eigen::Index>(1, kDraws / possible), by_model = each * possible;
  const Eigen::Index all = model.hidden->unexplained ? 2 * by_model : by_model;
  RandomStream random(1, "predictions");
  DeflectionDraws draws;
  draws.compliance.resize(estimate.compliance.size(), all);
  draws.compliance.leftCols(by_model) = normalDraws(withKnown(own.others, estimate), by_model, random);
  draws.parameters.setZero(hidden.off.rows(), all);
  for (Eigen::Index d = 0; d < by_model; ++d) {
    const Eigen::Index drawn = d % possible;
    draws.compliance.col(d) += own.compliance.col(drawn);
    draws.parameters.col(d) = hidden.off.col(own.possible[static_cast<std::size_t>(drawn)]);
  }
  draws.springs_alone.assign(static_cast<std::size_t>(all), false);
  if (model.hidden->unexplained) {
    draws.compliance.rightCols(by_model) =
        normalDraws(identification::coveringCovariance(alone), by_model, random).colwise() + alone.compliance;
    std::fill(draws.springs_alone.begin() + by_model, draws.springs_alone.end(), true);
  }
  addUnknownJoints(estimate, draws, random);
  addCommon(load_sd, draws, random);
  draws.by = [&model, method](const JointVector& commands, const effects::FlangeLoad& load,
                              const std::vector<Eigen::Vector3d>& points) {
    return extended_model::displacementByHidden(model, method, commands, load, points);
  };
  return draws;
}

double quantile(std::vector<double>& values, double p) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(p * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

DeflectionDraws springDraws(const StiffnessEstimate& estimate, const JointMatrix& covariance, double load_sd,
                            Eigen::Index varied) {
  RandomStream random(1, "predictions");
  DeflectionDraws draws;
  draws.compliance = normalDraws(covariance, kDraws, random);
  draws.parameters = standardNormal(varied, kDraws, random);
  draws.springs_alone.assign(static_cast<std::size_t>(kDraws), false);
  addUnknownJoints(estimate, draws, random);
  addCommon(load_sd, draws, random);
  return draws;
}

DeflectionDraws modelDraws(const extended_model::ExtendedModel& model, identification::Method method, double load_sd) {
  if (model.hidden && !model.hidden->draws.methods[static_cast<std::size_t>(method)].possible.empty())
    return hiddenDraws(model, method, load_sd);
  StiffnessEstimate springs = model.with.of(method).estimate;
  if (!extended_model::deflectsByEffects(model.effects))
    return springDraws(springs, identification::coveringCovariance(springs), load_sd);
  springs.covariance -= springs.parts.effects;
  return springDraws(springs, identification::coveringCovariance(springs), load_sd, model.spread.parameters.cols());
}

identification::CoverageInterval intervalOf(std::vector<double>& errors) {
  constexpr double kBeyond = 0.5 * (1.0 - identification::kStatedCoverage);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!std::all_of(errors.begin(), errors.end(), [](double error) { return std::isfinite(error); }))
    return {kNone, kNone};
  const double low = quantile(errors, kBeyond), high = quantile(errors, 1.0 - kBeyond);
  return {std::min(low, 0.0), std::max(high, 0.0)};
}

PredictionSpread spreadOf(const Eigen::Matrix3Xd& errors) {
  PredictionSpread spread;
  spread.sd = (errors.rowwise().squaredNorm() / static_cast<double>(errors.cols())).cwiseSqrt();
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!errors.allFinite()) {
    spread.sd.setConstant(kNone);
    spread.interval.fill({kNone, kNone});
    spread.expanded = kNone;
    return spread;
  }
  std::vector<double> values(static_cast<std::size_t>(errors.cols()));
  for (int k = 0; k < 3; ++k) {
    Eigen::VectorXd::Map(values.data(), errors.cols()) = errors.row(k);
    spread.interval[static_cast<std::size_t>(k)] = intervalOf(values);
  }
  Eigen::VectorXd::Map(values.data(), errors.cols()) = errors.colwise().norm();
  spread.expanded = quantile(values, identification::kStatedCoverage);
  return spread;
}

}  // namespace stiffscope::compensation
