#include "metrology/shape_models.h"

#include <Eigen/Dense>
#include <cmath>

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
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Dim + 1, Dim + 1>> eigen(moments);
  const Lifted least = eigen.eigenvectors().col(0);
  constexpr double kStraight = 1e-12;  // half the points' extent over the distance to the centre
  if (!(std::abs(least[0]) > kStraight)) return std::nullopt;
  const Flat centre = -0.5 * lever * least.template tail<Dim>() / least[0];
  return Flat(centre + basis.transpose() * mean);
}

template std::optional<Eigen::Vector2d> algebraicCentre<2>(const LocalPoints&,
                                                           const Eigen::Matrix<double, 3, 2>&);
template std::optional<Eigen::Vector3d> algebraicCentre<3>(const LocalPoints&,
                                                           const Eigen::Matrix<double, 3, 3>&);

std::optional<CirclesModel> circlesStart(const LocalPoints& local, std::string& reason) {
  const PrincipalAxes axes = principalAxes(local);
  if (!spreads(axes.spread[1], axes.spread[2], local)) {
    reason = "the readings lie on one line";
    return std::nullopt;
  }
  const AxisFrame flat(Eigen::Vector3d::Zero(), axes.directions.col(0));
  Eigen::Matrix<double, 3, 2> basis;
  basis << flat.u(), flat.v();
  const auto centre = algebraicCentre<2>(local, basis);
  if (!centre) {
    reason = "the readings lie on one line";
    return std::nullopt;
  }
  return CirclesModel{AxisFrame(basis * *centre, flat.direction())};
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
