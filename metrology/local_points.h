#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "metrology/measured_points.h"

namespace stiffscope {

/// One group of readings (a reflector's, say) in local coordinates.
struct LocalGroup {
  std::vector<Eigen::Vector3d> points;
  const std::vector<Eigen::Matrix3d>* covariances = nullptr;  ///< in the unit of the readings; null: none
};

/// Readings about their mean, in units of their own size: x = origin + scale x_local. Far from the origin
/// nothing is lost by this, and squares neither overflow nor lose the small against the large. The scale is a
/// power of two, so that scaling rounds nothing; local coordinates lie within -2..2.
struct LocalPoints {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double scale = 1.0;
  double rounding = 0.0;  ///< of the readings' coordinates in double precision, in local units
  std::vector<LocalGroup> groups;
  std::string flaw;  ///< why nothing can be fitted to the readings; empty where something can

  std::size_t count() const;
  bool weighted() const { return groups.front().covariances != nullptr; }
};

/// The readings must outlive the result, which refers to their covariances. Flaws: no readings, numbers that
/// are not finite, covariances that are not one a point and positive definite, all readings in one place, or
/// so far from the origin that double precision holds less than four digits of their spread.
LocalPoints localPoints(const MeasuredPoints* groups, std::size_t count);

/// The pooled spread of all points about the means of their groups: eigenvalues of the scatter matrix,
/// ascending (local units squared), and the directions that belong to them.
struct PrincipalAxes {
  Eigen::Vector3d spread;
  Eigen::Matrix3d directions;
};

PrincipalAxes principalAxes(const LocalPoints& local);

/// Do two spreads (eigenvalues of a scatter of points) tell a direction from rounding? `small` must be more
/// than a millionth of `large` in length, and more than the coordinates' rounding.
bool spreads(double small, double large, const LocalPoints& local);

/// Do the greater of two neighbouring spreads and its direction stand out from the lesser? For `count` points
/// of one scatter in both directions the difference of the two lies, at 95 %, below 4.9 times the root of
/// their product over the count (the spread of a 2x2 Wishart matrix: twice a Rayleigh variable).
bool standsOut(double greater, double lesser, std::size_t count);

}  // namespace stiffscope
