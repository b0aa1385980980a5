#include "core/compensation/compensate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

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
  // Of the draws of the effects as many as tell their spread: what they do is computed anew at every place.
  constexpr Eigen::Index kEffects = 600;
  const auto drawn = static_cast<Eigen::Index>(own.possible.size());
  const Eigen::Index stride = std::max<Eigen::Index>(1, (drawn + kEffects - 1) / kEffects);
  const Eigen::Index possible = (drawn + stride - 1) / stride;
  const Eigen::Index each = std::max<Eigen::Index>(1, kDraws / possible), by_model = each * possible;
  const Eigen::Index all = model.hidden->unexplained ? 2 * by_model : by_model;
  RandomStream random(1, "predictions");
  DeflectionDraws draws;
  draws.compliance.resize(estimate.compliance.size(), all);
  draws.compliance.leftCols(by_model) = normalDraws(withKnown(own.others, estimate), by_model, random);
  for (Eigen::Index d = 0; d < by_model; ++d) draws.compliance.col(d) += own.compliance.col(stride * (d % possible));
  draws.parameters.resize(hidden.off.rows(), possible);
  for (Eigen::Index d = 0; d < possible; ++d)
    draws.parameters.col(d) = hidden.off.col(own.possible[static_cast<std::size_t>(stride * d)]);
  if (model.hidden->unexplained) {
    draws.compliance.rightCols(by_model) =
        normalDraws(identification::coveringCovariance(alone), by_model, random).colwise() + alone.compliance;
    draws.springs_alone = by_model;
  }
  addUnknownJoints(estimate, draws, random);
  addCommon(load_sd, draws, random);
  draws.by = [&model, method](const JointVector& commands, const effects::FlangeLoad& load,
                              const std::vector<Eigen::Vector3d>& points) {
    return extended_model::displacementByHidden(model, method, commands, load, points);
  };
  return draws;
}

/// Rank from the nearer end of what a share of `count` values does not exceed; from zero.
Eigen::Index rankFromEnd(Eigen::Index count, double share) {
  const auto rank = static_cast<Eigen::Index>(share * static_cast<double>(count - 1) + 0.5);
  return share < 0.5 ? rank : count - 1 - rank;
}

/// The one among `values` that `rank` others come before. Only what comes before `bound`, some of them, is looked at
/// closely, if that is enough.
template <typename Before>
double ranked(const Eigen::Ref<const Eigen::VectorXd>& values, Eigen::Index rank, double bound, Before before) {
  std::vector<double> kept(static_cast<std::size_t>(values.size()));
  std::size_t count = 0;
  for (const double value : values) {
    kept[count] = value;
    count += before(value, bound) ? 1 : 0;
  }
  if (count <= static_cast<std::size_t>(rank)) {
    std::copy(values.begin(), values.end(), kept.begin());
    count = kept.size();
  }
  const auto at = kept.begin() + rank;
  std::nth_element(kept.begin(), at, kept.begin() + static_cast<std::ptrdiff_t>(count), before);
  return *at;
}

double rootMeanSquare(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

}  // namespace

void DeflectionDraws::addByParameters(const Eigen::MatrixXd& by, Eigen::Ref<Eigen::MatrixXd> errors) const {
  if (parameters.size() == 0) return;
  const Eigen::MatrixXd moves = parameters.transpose() * by.transpose();
  const Eigen::Index by_model = size() - springs_alone;
  for (Eigen::Index first = 0; first < by_model; first += moves.rows()) {
    const Eigen::Index count = std::min(moves.rows(), by_model - first);
    errors.middleRows(first, count) += moves.topRows(count);
  }
}

DeflectionDraws springDraws(const StiffnessEstimate& estimate, const JointMatrix& covariance, double load_sd,
                            Eigen::Index varied) {
  RandomStream random(1, "predictions");
  DeflectionDraws draws;
  draws.compliance = normalDraws(covariance, kDraws, random);
  draws.parameters = standardNormal(varied, kDraws, random);
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

identification::CoverageInterval intervalOf(const Eigen::Ref<const Eigen::VectorXd>& errors) {
  constexpr double kBeyond = 0.5 * (1.0 - identification::kStatedCoverage);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!errors.allFinite()) return {kNone, kNone};
  const double size = rootMeanSquare(errors);
  const double low = ranked(errors, rankFromEnd(errors.size(), kBeyond), -size, std::less<>());
  const double high = ranked(errors, rankFromEnd(errors.size(), 1.0 - kBeyond), size, std::greater<>());
  return {std::min(low, 0.0), std::max(high, 0.0)};
}

PredictionSpread spreadOf(const Eigen::Ref<const Eigen::MatrixX3d>& errors) {
  PredictionSpread spread;
  if (!errors.allFinite()) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    spread.sd.setConstant(kNone);
    spread.interval.fill({kNone, kNone});
    spread.expanded = kNone;
    return spread;
  }
  for (int k = 0; k < 3; ++k) {
    spread.sd[k] = rootMeanSquare(errors.col(k));
    spread.interval[static_cast<std::size_t>(k)] = intervalOf(errors.col(k));
  }
  const Eigen::VectorXd length = errors.rowwise().norm();
  spread.expanded = ranked(length, rankFromEnd(length.size(), identification::kStatedCoverage), rootMeanSquare(length),
                           std::greater<>());
  return spread;
}

}  // namespace stiffscope::compensation
