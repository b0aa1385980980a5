#pragma once

#include <Eigen/Core>
#include <optional>

#include "metrology/local_points.h"

namespace stiffscope {

/// The common centre of concentric circles (Dim 2) or spheres (Dim 3), one a group, from the points projected
/// on the columns of `basis`: the algebraic fit of G. Taubin, IEEE Trans. PAMI 13 (1991) 1115, which on short
/// arcs does not shrink the radius as Kasa's does. Least sum of (A |x|^2 + b.x + D_k)^2 over the sum of its
/// squared gradient; taking each group's means off removes its D_k, and the rest is the least eigenvector of
/// a symmetric matrix of Dim + 1. Groups of fewer than three points take no part. In local units, relative to
/// the local origin; empty where the points are as well on a line (a plane).
template <int Dim>
std::optional<Eigen::Matrix<double, Dim, 1>> algebraicCentre(const LocalPoints& local,
                                                             const Eigen::Matrix<double, 3, Dim>& basis);

extern template std::optional<Eigen::Vector2d> algebraicCentre<2>(const LocalPoints&,
                                                                  const Eigen::Matrix<double, 3, 2>&);
extern template std::optional<Eigen::Vector3d> algebraicCentre<3>(const LocalPoints&,
                                                                  const Eigen::Matrix<double, 3, 3>&);

}  // namespace stiffscope
