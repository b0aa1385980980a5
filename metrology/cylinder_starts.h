#pragma once

#include <vector>

#include "metrology/axis_models.h"

namespace stiffscope {

/// A cylinder that an algebraic search finds, in local units, with the sum of squared distances that it
/// expects.
struct CylinderStart {
  CylindersModel model;
  double radius = 0.0;
  double expected = 0.0;
};

/// For an axis direction w the points projected along it should lie on a circle, and Taubin's circle of them
/// follows from the covariance of the nine numbers (x^2, y^2, z^2, yz, xz, xy, x, y, z): with P = I - w w',
/// |P x|^2 is linear in them (after D. Eberly, Fitting 3D Data with a Cylinder, whose sum this makes
/// Taubin's). That covariance is summed once, so that a search over the half sphere costs the same for any
/// number of points. Returns the local minima over it, refined, the best first, `most` at most.
std::vector<CylinderStart> cylinderStarts(const LocalPoints& local, std::size_t most);

}  // namespace stiffscope
