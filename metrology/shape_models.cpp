#include "metrology/shape_models.h"

#include <Eigen/Dense>
#include <cmath>

#include "metrology/linear_algebra.h"
#include "metrology/remarks.h"

namespace stiffscope::metrology {

template <int Dim>
std::optional<Eigen::Matrix<double, Dim, 1>> algebraicCentre(const LocalPoints& local,
                                                             const Eigen::Matrix<double, 3, Dim>& basis) {
  using Flat = Eigen::Matrix<double, Dim, 1>;
  using Lifted = Eigen::Matrix<double, Dim + 1, 1>;  // (|x|^2, x)
  const auto lift = [&basis](const Eigen::Vector3d& from_mean) {
    const Flat flat = basis.transpose() * from_mean;
    Lifted lifted;
    lifted << flat.squaredNorm(), flat;
    return lifted;
  };

  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const LocalGroup& group : local.groups) {
    if (group.points.size() < 3) continue;
    for (const Eigen::Vector3d& point : group.points) mean += point;
    count += static_cast<double>(group.points.size());
  }
  if (count == 0.0) return std::nullopt;
  mean /= count;

  Eigen::Matrix<double, Dim + 1, Dim + 1> moments = Eigen::Matrix<double, Dim + 1, Dim + 1>::Zero();
  double squares = 0.0;
  for (const LocalGroup& group : local.groups) {
    if (group.points.size() < 3) continue;
    Lifted own_mean = Lifted::Zero();
    for (const Eigen::Vector3d& point : group.points) own_mean += lift(point - mean);
    squares += own_mean[0];
    own_mean /= static_cast<double>(group.points.size());
    for (const Eigen::Vector3d& point : group.points) {
      const Lifted lifted = lift(point - mean) - own_mean;
      moments.noalias() += lifted * lifted.transpose();
    }
  }
  // The squared gradient, 4 A^2 |x|^2 + |b|^2 on the mean, is made the unit of length by 2 sqrt(mean |x|^2).
  const double lever = 2.0 * std::sqrt(squares / count);
  if (!(lever > 0.0)) return std::nullopt;
  moments.row(0) /= lever;
  moments.col(0) /= lever;
  const Lifted least = symmetricEigen(moments).vectors.col(0);
  constexpr double kStraight = 1e-12;  // half the points' extent over the distance to the centre
  if (!(std::abs(least[0]) > kStraight)) return std::nullopt;
  const Flat centre = -0.5 * lever * least.template tail<Dim>() / least[0];
  return Flat(centre + basis.transpose() * mean);
}

template std::optional<Eigen::Vector2d> algebraicCentre<2>(const LocalPoints&, const Eigen::Matrix<double, 3, 2>&);
template std::optional<Eigen::Vector3d> algebraicCentre<3>(const LocalPoints&, const Eigen::Matrix<double, 3, 3>&);

void AxisModel::move(const Eigen::VectorXd& step) {
  before_ = axis;
  axis.move(Eigen::Vector4d(step));
}

void CirclesModel::observe(std::size_t, const Eigen::Vector3d& point, const double* own, Observation& seen) const {
  const PlaceAboutAxis place = axis.placeOf(point);
  const double rho = static_cast<double>(place.radius), h = static_cast<double>(place.height);
  const double eu = place.outward_u, ev = place.outward_v;
  seen.residual = {static_cast<double>(place.radius - own[0]), static_cast<double>(place.height - own[1])};
  seen.rows[0] = {-eu, -ev, -h * eu, -h * ev, -1.0, 0.0};
  seen.rows[1] = {0.0, 0.0, rho * eu, rho * ev, 0.0, -1.0};
  seen.directions[0] = eu * axis.u() + ev * axis.v();
  seen.directions[1] = axis.direction();
}

void CylindersModel::observe(std::size_t, const Eigen::Vector3d& point, const double* own, Observation& seen) const {
  const PlaceAboutAxis place = axis.placeOf(point);
  const double h = static_cast<double>(place.height), eu = place.outward_u, ev = place.outward_v;
  seen.residual[0] = static_cast<double>(place.radius - own[0]);
  seen.rows[0] = {-eu, -ev, -h * eu, -h * ev, -1.0};
  seen.directions[0] = eu * axis.u() + ev * axis.v();
}

void LineModel::observe(std::size_t, const Eigen::Vector3d& point, const double*, Observation& seen) const {
  long double h = 0.0L, u = 0.0L, v = 0.0L;
  for (int k = 0; k < 3; ++k) {
    const long double from = static_cast<long double>(point[k]) - axis.point()[k];
    h += from * axis.direction()[k];
    u += from * axis.u()[k];
    v += from * axis.v()[k];
  }
  const double height = static_cast<double>(h);
  seen.residual = {static_cast<double>(u), static_cast<double>(v)};
  seen.rows[0] = {-1.0, 0.0, -height, 0.0};
  seen.rows[1] = {0.0, -1.0, 0.0, -height};
  seen.directions[0] = axis.u();
  seen.directions[1] = axis.v();
}

void PlanesModel::observe(std::size_t, const Eigen::Vector3d& point, const double* own, Observation& seen) const {
  seen.residual[0] = static_cast<double>(axis.heightOf(point) - own[0]);
  seen.rows[0] = {axis.u().dot(point), axis.v().dot(point), -1.0};
  seen.directions[0] = axis.direction();
}

void PlanesModel::move(const Eigen::VectorXd& step) {
  before_ = axis;
  axis.move({0.0, 0.0, step[0], step[1]});
}

void SpheresModel::observe(std::size_t, const Eigen::Vector3d& point, const double* own, Observation& seen) const {
  long double square = 0.0L;
  for (int k = 0; k < 3; ++k) {
    const long double from = static_cast<long double>(point[k]) - centre[k];
    square += from * from;
  }
  const long double distance = std::sqrt(square);
  const Eigen::Vector3d outward = distance > 0.0L ? Eigen::Vector3d((point - centre) / static_cast<double>(distance))
                                                  : Eigen::Vector3d::UnitX();  // at the centre any serves
  seen.residual[0] = static_cast<double>(distance - own[0]);
  seen.rows[0] = {-outward.x(), -outward.y(), -outward.z(), -1.0};
  seen.directions[0] = outward;
}

void SpheresModel::move(const Eigen::VectorXd& step) {
  before_ = centre;
  centre += Eigen::Vector3d(step);
}

std::optional<CirclesModel> circlesStart(const LocalPoints& local, Remark& reason) {
  const PrincipalAxes axes = principalAxes(local);
  if (!spreads(axes.spread[1], axes.spread[2], local)) {
    reason = Remark(RemarkId::readings_on_one_line);
    return std::nullopt;
  }
  const AxisFrame flat(Eigen::Vector3d::Zero(), axes.directions.col(0));
  Eigen::Matrix<double, 3, 2> basis;
  basis << flat.u(), flat.v();
  const auto centre = algebraicCentre<2>(local, basis);
  if (!centre) {
    reason = Remark(RemarkId::readings_on_one_line);
    return std::nullopt;
  }
  return CirclesModel(AxisFrame(basis * *centre, flat.direction()));
}

Eigen::Matrix2Xd firstOwn(const CirclesModel& model, const LocalPoints& local) {
  Eigen::Matrix2Xd own = Eigen::Matrix2Xd::Zero(2, static_cast<Eigen::Index>(local.groups.size()));
  for (std::size_t k = 0; k < local.groups.size(); ++k) {
    const double share = 1.0 / static_cast<double>(local.groups[k].points.size());
    for (const Eigen::Vector3d& point : local.groups[k].points) {
      const PlaceAboutAxis place = model.axis.placeOf(point);
      own.col(static_cast<Eigen::Index>(k)) +=
          share * Eigen::Vector2d(static_cast<double>(place.radius), static_cast<double>(place.height));
    }
  }
  return own;
}

}  // namespace stiffscope::metrology
