#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/effects/effect.h"
#include "core/identification/estimate.h"

namespace stiffscope::extended_model {

/// A parameter of an effect that may hide, in words of effect_model.h.
struct HiddenParameter {
  effects::Effect effect = effects::Effect::link_compliance;
  std::string name;  ///< "joint 3", "1/GJ of link 3"
  std::string unit;  ///< SI
  double fit = 0.0;  ///< what the model has of it; 0 where it has none
};

/// c_j + ratio theta: what the data determine where they tell neither from the other (1/k4 + L/GJ of the forearm).
struct SeenCombination {
  int joint = 0;  ///< 0-based
  HiddenParameter parameter;
  double ratio = 0.0;  ///< rad/Nm by the parameter's unit
  double value = 0.0;  ///< rad/Nm
  double sd = 0.0;     ///< standard uncertainty of `value`, rad/Nm
};

/// For each identifiable joint the parameter whose combination with the compliance is known best, where it is known at
/// least three times better than the compliance itself: the ratio that leaves least of the draws, least squares about
/// the fit. `moved` and `off`: how far the compliances (6 x draws) and the parameters (one a row) are from the fit;
/// `own`: covariance of the compliances by everything else, which the combination keeps.
std::vector<SeenCombination> seenCombinations(const std::vector<HiddenParameter>& parameters,
                                              const Eigen::MatrixXd& moved, const Eigen::MatrixXd& off,
                                              const Matrix6d& own, const identification::StiffnessEstimate& estimate);

}  // namespace stiffscope::extended_model
