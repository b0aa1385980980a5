#include "core/simulation/beam.h"

#include <Eigen/LU>

namespace stiffscope::simulation {

Eigen::Matrix<double, 6, 6> beamTipStiffness(const LinkBeam& beam, double length) {
  Eigen::Matrix<double, 6, 6> k = Eigen::Matrix<double, 6, 6>::Zero();
  if (beam.bending) {
    const double l = length, ei = *beam.bending;
    const double shear = beam.shear ? l / *beam.shear : 0.0;
    Eigen::Matrix2d compliance;
    compliance << l * l * l / (3 * ei) + shear, l * l / (2 * ei), l * l / (2 * ei), l / ei;
    const Eigen::Matrix2d plane = compliance.inverse();
    k(0, 0) = k(1, 1) = plane(0, 0);
    k(4, 4) = k(3, 3) = plane(1, 1);
    // A tip force along x turns the tip about +y; one along y turns it about -x.
    k(0, 4) = k(4, 0) = plane(0, 1);
    k(1, 3) = k(3, 1) = -plane(0, 1);
  }
  if (beam.axial) k(2, 2) = *beam.axial / length;
  if (beam.torsion) k(5, 5) = *beam.torsion / length;
  return k;
}

}  // namespace stiffscope::simulation
