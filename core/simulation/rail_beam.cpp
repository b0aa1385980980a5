#include "core/simulation/rail_beam.h"

#include <Eigen/LU>

namespace stiffscope::simulation {

namespace {

/// Deflection and slope by force and moment.
Eigen::Matrix2d bendingCompliance(double bending, double a, double b) {
  const double span = a + b, ab = a * b;
  Eigen::Matrix2d compliance;
  compliance << ab * ab, ab * (b - a), ab * (b - a), span * span - 3.0 * ab;
  return compliance / (3.0 * bending * span);
}

/// Puts 2x2 blocks where deflection and slope of both planes stand.
Eigen::Matrix<double, 6, 6> inPlanes(const Eigen::Matrix2d& up, const Eigen::Matrix2d& level, double twist) {
  constexpr int uy = 1, uz = 2, rx = 3, ry = 4, rz = 5;
  Eigen::Matrix<double, 6, 6> all = Eigen::Matrix<double, 6, 6>::Zero();
  all(uz, uz) = up(0, 0);
  all(uz, ry) = all(ry, uz) = -up(0, 1);
  all(ry, ry) = up(1, 1);
  all(uy, uy) = level(0, 0);
  all(uy, rz) = all(rz, uy) = level(0, 1);
  all(rz, rz) = level(1, 1);
  all(rx, rx) = twist;
  return all;
}

}  // namespace

Eigen::Matrix<double, 6, 6> railCompliance(const RailBeam& beam, double position) {
  const double a = position - beam.from, b = beam.to - position;
  return inPlanes(bendingCompliance(beam.bending_up, a, b), bendingCompliance(beam.bending_level, a, b),
                  beam.torsion ? a * b / (*beam.torsion * (a + b)) : 0.0);
}

Eigen::Matrix<double, 6, 6> railStiffness(const RailBeam& beam, double position) {
  const double a = position - beam.from, b = beam.to - position;
  return inPlanes(bendingCompliance(beam.bending_up, a, b).inverse(),
                  bendingCompliance(beam.bending_level, a, b).inverse(),
                  beam.torsion ? *beam.torsion * (a + b) / (a * b) : 0.0);
}

bool carries(const RailBeam& beam, double position) {
  const double clear = 0.01 * (beam.to - beam.from);
  return position >= beam.from + clear && position <= beam.to - clear;
}

}  // namespace stiffscope::simulation
