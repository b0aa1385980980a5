#include "core/improved/improved_model.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "core/identification/cautions.h"
#include "core/identification/without_postures.h"
#include "core/improved/improved_subsets.h"
#include "core/improved/taken_off.h"

namespace stiffscope {

namespace {

/// The values alone: no subsets, no bootstrap, no outliers sought.
IdentifyOptions valuesOnly(IdentifyOptions options) {
  options.subsets.size = std::numeric_limits<int>::max();
  options.bootstrap.draws = 0;
  options.robust = false;
  return options;
}

/// S of Sigma = S S^T by eigenvectors, the parameters in their own standard deviations.
Eigen::MatrixXd rootOf(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd sd = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd inverse = sd.unaryExpr([](double d) { return d > 0.0 ? 1.0 / d : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> own(inverse.asDiagonal() * covariance * inverse.asDiagonal());
  return sd.asDiagonal() * own.eigenvectors() * own.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// The effects' parameters moved along a column.
Eigen::VectorXd movedBy(const EffectFit& effects, const Eigen::VectorXd& column) {
  Eigen::VectorXd parameters = effects.parameters();
  for (std::size_t i = 0; i < effects.free.size(); ++i) parameters[effects.free[i]] += column[static_cast<Eigen::Index>(i)];
  return parameters;
}

void findSpread(const Campaign& used, const IdentifyOptions& options, ImprovedModel& model) {
  EffectSpread& spread = model.spread;
  spread.parameters = rootOf(model.effects.covariance);
  for (auto& columns : spread.compliance) columns.setZero(6, spread.parameters.cols());
  for (Eigen::Index k = 0; k < spread.parameters.cols(); ++k) {
    const Campaign moved = withoutEffects(used, model.effects, movedBy(model.effects, spread.parameters.col(k)),
                                          TakenOff::everything);
    const Identification there = identify(moved, options);
    for (const Method which : kMethods) {
      const MethodResult &here = model.with.of(which), &other = there.of(which);
      if (!here.available || !other.available) continue;
      spread.compliance[static_cast<std::size_t>(which)].col(k) =
          other.estimate.compliance - here.estimate.compliance;
    }
  }
}

/// Equations that a method fits: three a reflector and case; of Complete Pose six a case.
double rowsOf(const MethodResult& method, Method which) {
  double rows = 0.0;
  for (const CaseEquations& one : method.target_rows)
    rows += which == Method::complete_pose ? 6.0 : static_cast<double>(one.right.size());
  return rows;
}

void addEffectsUncertainty(ImprovedModel& model) {
  const auto taken = static_cast<double>(model.effects.free.size());
  for (const Method which : kMethods) {
    MethodResult& method = model.with.methods[static_cast<std::size_t>(which)];
    if (!method.available) continue;
    StiffnessEstimate& estimate = method.estimate;
    const auto unknowns = static_cast<double>(
        std::count(estimate.identifiable.begin(), estimate.identifiable.end(), true));
    const double rows = rowsOf(method, which);
    if (rows > unknowns + taken) {
      const double factor = (rows - unknowns) / (rows - unknowns - taken);
      estimate.sigma *= std::sqrt(factor);
      estimate.parts.scatter *= factor;
    }
    const auto& columns = model.spread.compliance[static_cast<std::size_t>(which)];
    estimate.parts.effects = columns * columns.transpose();
    estimate.covariance = estimate.parts.total();
  }
}

}  // namespace

ImprovedModel improveModel(const Campaign& campaign, EffectFit effects, const IdentifyOptions& options) {
  ImprovedModel model;
  model.effects = std::move(effects);
  model.without = identify(campaign, options);
  if (model.effects.added.empty()) {
    model.with = model.without;
    model.campaign = campaign;
    return model;
  }
  std::vector<std::string> left_out;
  model.campaign =
      withoutEffects(campaign, model.effects, model.effects.parameters(), TakenOff::everything, &left_out);
  IdentifyOptions own = valuesOnly(options);
  own.robust = options.robust;
  model.with = identify(model.campaign, own);
  model.with.left_out.insert(model.with.left_out.end(), left_out.begin(), left_out.end());
  const Campaign used = model.with.robust ? withoutPostures(campaign, model.with.outlying) : campaign;
  findSpread(used, valuesOnly(options), model);
  addEffectsUncertainty(model);
  judgeImproved(used, options, model);
  model.with.cautions = cautionsOf(model.campaign, model.with);
  return model;
}

}  // namespace stiffscope
