#pragma once

#include <Eigen/Core>
#include <optional>

#include "metrology/least_squares.h"
#include "metrology/lines.h"

namespace stiffscope::metrology {

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

// Shapes as models of least_squares.h. Shared parameters of those about an axis: (shift_u, shift_v, tilt_u, tilt_v) of
// the axis where it stands. e_u, e_v: the outward unit vector; rho, h: radius and height of a point.

/// A model that moves an axis.
class AxisModel : public Model {
 public:
  explicit AxisModel(const AxisFrame& frame) : axis(frame), before_(frame) {}
  void move(const Eigen::VectorXd& step) override;
  void undo() override { axis = before_; }

  AxisFrame axis;

 protected:
  AxisFrame before_;
};

/// Circles about one axis: radial residual rho - r and axial residual h - h_k. Own parameters: radius r,
/// height h_k.
class CirclesModel : public AxisModel {
 public:
  using AxisModel::AxisModel;
  Size size() const override { return {4, 2, 2}; }
  void observe(std::size_t i, const Eigen::Vector3d& point, const double* own, Observation& seen) const override;
};

/// Cylinders about one axis: radial residual rho - r. Own parameter: radius r.
class CylindersModel : public AxisModel {
 public:
  using AxisModel::AxisModel;
  Size size() const override { return {4, 1, 1}; }
  void observe(std::size_t i, const Eigen::Vector3d& point, const double* own, Observation& seen) const override;
};

/// A straight line: the two components of a point's distance, along u and v.
class LineModel : public AxisModel {
 public:
  using AxisModel::AxisModel;
  Size size() const override { return {4, 0, 2}; }
  void observe(std::size_t i, const Eigen::Vector3d& point, const double* own, Observation& seen) const override;
};

/// Parallel planes, one a group: residual n.p - height, the normal being the direction of `axis`, which goes through
/// the local origin. Shared parameters: tilts of the normal towards u and v. Own: the height.
class PlanesModel : public AxisModel {
 public:
  using AxisModel::AxisModel;
  Size size() const override { return {2, 1, 1}; }
  void observe(std::size_t i, const Eigen::Vector3d& point, const double* own, Observation& seen) const override;
  void move(const Eigen::VectorXd& step) override;
};

/// Concentric spheres, one a group: residual |p - centre| - r. Shared parameters: the centre. Own: the
/// radius.
class SpheresModel : public Model {
 public:
  explicit SpheresModel(const Eigen::Vector3d& at) : centre(at), before_(at) {}
  Size size() const override { return {3, 1, 1}; }
  void observe(std::size_t i, const Eigen::Vector3d& point, const double* own, Observation& seen) const override;
  void move(const Eigen::VectorXd& step) override;
  void undo() override { centre = before_; }

  Eigen::Vector3d centre;

 private:
  Eigen::Vector3d before_;
};

/// The start of a fit of circles about one axis: across the axis the plane in which the points spread most
/// about their groups' means, in it Taubin's common centre. Groups of fewer than three points take no part.
/// Empty, with the reason, where the points lie on one line.
std::optional<CirclesModel> circlesStart(const LocalPoints& local, Remark& reason);

/// Mean radius and height of each group about the axis.
Eigen::Matrix2Xd firstOwn(const CirclesModel& model, const LocalPoints& local);

}  // namespace stiffscope::metrology
