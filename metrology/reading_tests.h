#pragma once

#include <cstddef>
#include <vector>

#include "metrology/axis_fit.h"
#include "metrology/circle_fit.h"
#include "metrology/cylinder_fit.h"
#include "metrology/line_fit.h"
#include "metrology/plane_fit.h"
#include "metrology/sphere_fit.h"

namespace stiffscope {

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

}  // namespace stiffscope
