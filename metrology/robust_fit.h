#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "metrology/axis_fit.h"
#include "metrology/circle_fit.h"
#include "metrology/cylinder_fit.h"
#include "metrology/line_fit.h"
#include "metrology/plane_fit.h"
#include "metrology/remarks.h"
#include "metrology/sphere_fit.h"

namespace stiffscope::metrology {

/// How far one reading lies from the shape that the others make.
struct ReadingTest {
  std::size_t group = 0,
              index = 0;  ///< of the reading, from 0; `group` is 0 but for fits of several reflectors
  double w = 0.0;         ///< in standard deviations of its residual; 0 where no other reading controls it
};

/// w-tests of all readings of a fit: W. Baarda, A testing procedure for use in geodetic networks, Netherlands
/// Geodetic Commission 2 No. 5 (1968), for one reading at a time: w^2 = e' (I - H)^-1 e, e its whitened
/// residuals, H its block of the hat matrix. With covariances w^2 is chi-square of as many degrees as a
/// reading has residuals; without, the variance comes from the residuals of the other readings and w^2 over
/// the number of residuals is F.
struct ReadingTests {
  std::vector<ReadingTest> readings;
  int residuals = 1;         ///< of each reading, 1 or 2
  int variance_degrees = 0;  ///< degrees of freedom of the variance that w is made with; 0: known beforehand

  /// The w that a good reading exceeds with this probability.
  double criticalW(double level) const;
};

ReadingTests readingTests(const FittedLine& fit, const MeasuredPoints& points);
ReadingTests readingTests(const FittedPlane& fit, const MeasuredPoints& points);
ReadingTests readingTests(const FittedCircle& fit,
                          const MeasuredPoints& points);  ///< radial and axial, for both strategies
ReadingTests readingTests(const FittedSphere& fit, const MeasuredPoints& points);
ReadingTests readingTests(const FittedCylinder& fit, const MeasuredPoints& points);
ReadingTests readingTests(const AxisFit& fit, const std::vector<CirclePoints>& circles);
ReadingTests readingTests(const SphereFit& fit, const std::vector<SpherePoints>& spheres);

/// A reading that was left out, as it stood when it was.
struct RejectedReading {
  std::size_t group = 0, index = 0;  ///< in the readings as they were given, from 0
  double w = 0.0;
  double critical_w = 0.0;  ///< above which a reading was rejected then
};

template <class Fit>
struct RobustFit {
  Fit fit;                                ///< of the readings that are left: its degrees of freedom are theirs
  std::vector<RejectedReading> rejected;  ///< in the order of their rejection
  double family_level = 0.0;              ///< probability that a set of good readings loses one at the first test
  double critical_w = 0.0;                ///< of the last test: every reading that is left lies below; 0: none made
};

/// One good set in a hundred loses a reading; for 20 readings that is a critical w of 3.5, near Baarda's 3.3.
inline constexpr double kFamilyLevel = 0.01;

/// What data snooping asks of a fit: fits the readings that are left and tests them; empty where the fit is not
/// determined.
using FitAndTest = std::function<std::optional<ReadingTests>(const std::vector<MeasuredPoints>&)>;

struct DataSnooping {
  std::vector<RejectedReading> rejected;
  double critical_w = 0.0;
  bool contradictory = false;  ///< more than a third of the readings would go
};

/// The rejections of fitRobustly; the last call of `fit_and_test` was with the readings that are left.
DataSnooping snoopReadings(std::vector<MeasuredPoints> readings, const FitAndTest& fit_and_test, double family_level);

/// Data snooping: the reading with the largest w (ReadingTest) is rejected where w lies above the
/// critical value for a level of 1 - (1 - family_level)^(1/n) a reading (Sidak), n the readings left; then
/// the fit is repeated, until none does. One at a time, since a wrong reading spoils the residuals of good
/// ones. Where more than a third would go it cannot be told which are wrong, and the fit is not determined.
/// Small wrong readings can hide, and several that agree with each other can outvote good ones.
///
/// `fitTo` fits readings (one MeasuredPoints, or a vector of them by reflector) with a result for which there
/// is a `readingTests`.
template <class Readings, class FitFunction>
auto fitRobustly(const Readings& readings, const FitFunction& fitTo, double family_level = kFamilyLevel) {
  using Fit = std::decay_t<decltype(fitTo(readings))>;
  Fit fit;
  const auto fitAndTest = [&](const auto& left) -> std::optional<ReadingTests> {
    fit = fitTo(left);
    if (!fit.determined) return std::nullopt;
    return readingTests(fit, left);
  };
  DataSnooping found;
  if constexpr (std::is_same_v<Readings, MeasuredPoints>) {
    found = snoopReadings(
        {readings}, [&](const auto& left) { return fitAndTest(left.front()); }, family_level);
  } else {
    found = snoopReadings(readings, fitAndTest, family_level);
  }
  if (found.contradictory) {
    fit = {};
    fit.reason = Remark(RemarkId::readings_contradict);
  }
  return RobustFit<Fit>{std::move(fit), std::move(found.rejected), family_level, found.critical_w};
}

}  // namespace stiffscope::metrology
