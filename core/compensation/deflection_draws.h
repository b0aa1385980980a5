#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "core/effects/elastic_arm.h"
#include "core/extended_model/extended_model.h"
#include "core/identification/estimate.h"

namespace stiffscope::compensation {

/// Displacement of points of the flange body (R0, unloaded places) under a load by a unit of each parameter, to first
/// order: three rows a point, one column a parameter, m per unit.
using DisplacementByParameters = std::function<Eigen::MatrixXd(
    const Vector6d& commands, const effects::FlangeLoad& load, const std::vector<Eigen::Vector3d>& points)>;

/// What may be true of the arm instead of its model, a draw each column (Monte Carlo, JCGM 101). All draws are equally
/// likely, and one draw is the same arm in all postures and under all loads: an effect that the day's loads could not
/// see is small in no draw for that reason, and widens the prediction for the loads that rouse it.
struct DeflectionDraws {
  /// c less the model's, rad/Nm; of a draw of `springs_alone` c itself. A joint that the day cannot see is anywhere
  /// between rigid and as weak as the weaker of its neighbours.
  Eigen::Matrix<double, 6, Eigen::Dynamic> compliance;
  Eigen::MatrixXd parameters;   ///< of what gives besides joint springs, less the model's
  DisplacementByParameters by;  ///< null: the parameters are moves along EffectDeflection::varied
  Eigen::VectorXd load;         ///< error of the wrench's size, a share
  /// Whether the draw is an arm that gives at joint springs alone: where no model explains the day, half of them are.
  std::vector<bool> springs_alone;
  Eigen::Matrix3Xd model_error;  ///< standard normal numbers, for what the model leaves of a point

  Eigen::Index size() const { return compliance.cols(); }
};

/// Joint springs alone. `covariance`: of their compliances, scaled to normal numbers (coveringCovariance). `load_sd`:
/// of the load cell's scale. `varied`: further parameters, standard normal and independent.
DeflectionDraws springDraws(const identification::StiffnessEstimate& estimate, const Matrix6d& covariance,
                            double load_sd = 0.0, Eigen::Index varied = 0);

/// The posterior predictive: each draw one of springs and effects together (extended_model/hidden_effects.h) with one
/// of everything else. Where the effects were named by hand, nothing hides, and the draws are those of the fit. `model`
/// must outlive the result.
DeflectionDraws modelDraws(const extended_model::ExtendedModel& model, identification::Method method, double load_sd);

/// What a prediction of three coordinates is uncertain by.
struct PredictionSpread {
  Eigen::Vector3d sd = Eigen::Vector3d::Zero();
  std::array<identification::CoverageInterval, 3>
      interval{};         ///< of the error of each coordinate, at the stated coverage
  double expanded = 0.0;  ///< U: the error is shorter than this at the stated coverage
};

/// Of the errors of a prediction, a draw each column: moments about zero, and quantiles widened to hold zero. Not a
/// number where some error is not.
PredictionSpread spreadOf(const Eigen::Matrix3Xd& errors);

}  // namespace stiffscope::compensation
