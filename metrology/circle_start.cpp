#include "metrology/circle_start.h"

#include "metrology/algebraic_centre.h"

namespace stiffscope {

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

}  // namespace stiffscope
