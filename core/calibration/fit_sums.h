#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/calibration/fitted_day.h"

namespace stiffscope::calibration {

/// Sums over postures of a fit's whitened equations  residual = J step.
struct FitSum {
  /// Lower triangle of [J r]^T [J r], J by (steps, sizes), its rows and columns zero where nothing was asked for.
  Eigen::MatrixXd normal;
  double weighted_chi2 = 0.0, weight = 0.0;
  double squares_together = 0.0, squares_apart = 0.0;  ///< of the whitened residuals of a posture's reflectors
};

/// Makes them for the turns of one fit: what does not change from turn to turn is found once. Postures are taken on all
/// cores; how they are put together depends on their number alone.
class FitSums {
 public:
  /// Keeps a reference to the day. `fit`: of its parts the terms.
  FitSums(const UnloadedDay& day, const ArmFit& fit);

  std::size_t firstReading(std::size_t posture) const { return first_[posture]; }

  /// Over `postures`, by the parameters `places` in (steps, sizes), with the weights of the fit. `distances`, one a
  /// reading of the day: its squared distance from the model in parts of its covariance, of all readings of `postures`.
  FitSum over(const ArmFit& fit, const std::vector<std::size_t>& postures, const std::vector<int>& places,
              std::vector<double>& distances) const;

  /// The distances alone.
  void distancesOf(const ArmFit& fit, const std::vector<std::size_t>& postures, std::vector<double>& distances) const;

 private:
  struct Block;
  struct Equations;
  void addPosture(const FittedDay& fitted, std::size_t i, ReadingDerivatives& derivatives,
                  std::vector<Equations>& equations, Block& sum, std::vector<double>& distances) const;
  auto anglesByTerms(std::size_t posture) const {
    return by_terms_.middleCols(static_cast<Eigen::Index>(posture) * terms_, terms_);
  }

  const UnloadedDay& day_;
  std::vector<std::size_t> first_;  ///< reading of each posture
  Eigen::Index terms_ = 0;
  AnglesByTerms by_terms_;  ///< posture by posture
};

}  // namespace stiffscope::calibration
