#include "core/calibration/fitted_day.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/calibration/arm_fit.h"
#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace fit_sums_test {

using calibration::ArmFit;
using calibration::EffectPart;

/// A day, and a fit of it that is moved from where it was, with a term of each kind.
struct MovedFit {
  calibration::UnloadedDay day;
  ArmFit fit;

  explicit MovedFit(int postures) {
    Noise noise(81);
    UnloadedSpec spec = builtOtherwise(noise);
    spec.postures = postures;
    day = calibration::unloadedDay(unloadedCampaign(spec, noise));
    const std::vector<double> all(day.readings(), 1.0);
    const std::vector<EffectPart> parts{calibration::transmissionError(1, 3.0), calibration::targetMotion(day, 1, 0.4)};
    fit = calibration::fitArm(day, *calibration::placeArm(day, all), parts, {.weights = all});
    for (Eigen::Index k = 0; k < fit.steps.size(); ++k) fit.steps[k] += 1e-4 * noise.normal();
    // Of what moves reflectors only the size itself is in the derivatives, not how that turns with the arm: none here.
    fit.sizes << 1e-4, -2e-4, 0.0, 0.0, 0.0;
    for (std::size_t i = 0; i < fit.weights.size(); ++i) fit.weights[i] = i % 7 == 0 ? 0.0 : 0.5 + 0.1 * double(i % 5);
  }

  std::vector<int> allPlaces() const {
    std::vector<int> places(static_cast<std::size_t>(fit.steps.size() + fit.sizes.size()));
    std::iota(places.begin(), places.end(), 0);
    return places;
  }
  std::vector<std::size_t> allPostures() const {
    std::vector<std::size_t> postures(day.postures.size());
    std::iota(postures.begin(), postures.end(), 0);
    return postures;
  }
  calibration::FitSum sum(const std::vector<int>& places) const {
    std::vector<double> distances(day.readings());
    return calibration::FitSums(day, fit).over(fit, allPostures(), places, distances);
  }
};

/// Sum of the weighted squared residuals in parts of their covariances, by what each reading leaves.
double weightedSquares(const calibration::UnloadedDay& day, const ArmFit& fit) {
  const calibration::FittedDay fitted(day, fit);
  const std::vector<Eigen::Vector3d> residuals = calibration::residualsOf(day, fit);
  double sum = 0.0;
  std::size_t at = 0;
  for (const calibration::Posture& posture : day.postures) {
    for (const calibration::Reading& reading : posture.readings) {
      const Eigen::Matrix3d turn = fit.place.base_from_points.linear();
      const Eigen::Matrix3d covariance =
          turn * reading.covariance * turn.transpose() + fit.model_sd * fit.model_sd * Eigen::Matrix3d::Identity();
      sum += fit.weights[at] * residuals[at].dot(covariance.inverse() * residuals[at]);
      ++at;
    }
  }
  return sum;
}

// The last row is half of the squares' gradient, the other way: by differences, for every kind of parameter.
TEST(FitSums, RightSideIsTheGradientOfTheSquares) {
  const MovedFit moved(60);
  const calibration::FitSum sum = moved.sum(moved.allPlaces());
  EXPECT_NEAR(sum.weighted_chi2, weightedSquares(moved.day, moved.fit), 1e-9 * sum.weighted_chi2);
  constexpr double kStep = 1e-6;
  const Eigen::Index steps = moved.fit.steps.size(), count = steps + moved.fit.sizes.size();
  for (Eigen::Index k = 0; k < count; ++k) {
    ArmFit plus = moved.fit, minus = moved.fit;
    (k < steps ? plus.steps[k] : plus.sizes[k - steps]) += kStep;
    (k < steps ? minus.steps[k] : minus.sizes[k - steps]) -= kStep;
    const double slope = (weightedSquares(moved.day, plus) - weightedSquares(moved.day, minus)) / (2.0 * kStep);
    // Against the length of the column times that of the residual: a gradient may vanish. The third derivative times
    // 1e-12, and the rounding of the squares over the step, are below 1e-6 of it.
    const double scale = std::sqrt(sum.normal(k, k) * sum.weighted_chi2);
    EXPECT_NEAR(sum.normal(count, k), -slope / 2.0, 1e-6 * scale) << "parameter " << k;
  }
}

TEST(FitSums, SomeParametersHaveTheEntriesOfAll) {
  const MovedFit moved(300);  // several blocks
  const Eigen::MatrixXd all = moved.sum(moved.allPlaces()).normal;
  const int last = static_cast<int>(moved.allPlaces().size());
  const std::vector<int> some{3, 8, 17, 26, 31, 33, 36, last - 4, last - 1};
  const Eigen::MatrixXd own = moved.sum(some).normal;
  ASSERT_EQ(own.rows(), all.rows());
  std::vector<int> asked = some;
  asked.push_back(last);  // the residual
  for (int i = 0; i <= last; ++i) {
    for (int j = 0; j <= i; ++j) {
      const bool there = std::count(asked.begin(), asked.end(), i) > 0 && std::count(asked.begin(), asked.end(), j) > 0;
      // The same products, summed by another kernel.
      const double scale = std::sqrt(all(i, i) * all(j, j));
      EXPECT_NEAR(own(i, j), there ? all(i, j) : 0.0, 1e-12 * scale) << i << ", " << j;
    }
  }
}

TEST(FitSums, DistancesAreThoseOfTheSums) {
  const MovedFit moved(60);
  const calibration::FitSums sums(moved.day, moved.fit);
  std::vector<double> beside(moved.day.readings(), -1.0), alone(moved.day.readings(), -1.0);
  sums.over(moved.fit, moved.allPostures(), moved.fit.free, beside);
  sums.distancesOf(moved.fit, moved.allPostures(), alone);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_GE(alone[i], 0.0);  // of readings of weight zero too
    EXPECT_NEAR(alone[i], beside[i], 1e-12 * (1.0 + beside[i]));
  }
}

}  // namespace fit_sums_test
}  // namespace stiffscope
