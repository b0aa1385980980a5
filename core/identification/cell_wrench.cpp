#include "core/identification/cell_wrench.h"

#include <stdexcept>

namespace stiffscope {

namespace {

const LinkFrame& linkNamed(const Robot& arm, const std::string& name) {
  for (const LinkFrame& link : arm.links) {
    if (link.name == name) return link;
  }
  throw std::invalid_argument("the load cell names the link '" + name + "', which the robot does not have");
}

/// A link's place: with the flange as given for what is fixed to it, by the posture for the rest.
Eigen::Isometry3d placeOf(const LinkFrame& link, const LoadingGeometry& geometry, const ArmPosture& posture,
                          const std::optional<Eigen::Isometry3d>& flange) {
  if (link.body == 6 && flange) {
    return *flange * geometry.arm.base_from_flange_at_zero.inverse() * link.base_from_link_at_zero;
  }
  return posture.motion[static_cast<std::size_t>(link.body)] * link.base_from_link_at_zero;
}

}  // namespace

int bodyOfCellAxes(const LoadCell& cell, const LoadingGeometry& geometry) {
  return linkNamed(geometry.arm, cell.axes_link ? *cell.axes_link : cell.parent).body;
}

Wrench cellWrench(const LoadCell& cell, const LoadingGeometry& geometry, const ArmPosture& posture,
                  const std::optional<Eigen::Isometry3d>& flange_unloaded,
                  const std::optional<Eigen::Isometry3d>& flange_loaded, const Vector6d& reading) {
  const LinkFrame& parent = linkNamed(geometry.arm, cell.parent);
  const Eigen::Matrix3d axes =
      cell.axes_link
          ? placeOf(linkNamed(geometry.arm, *cell.axes_link), geometry, posture, flange_loaded).linear()
          : Eigen::Matrix3d(placeOf(parent, geometry, posture, flange_loaded).linear() *
                            cell.parent_from_cell.linear());
  return {placeOf(parent, geometry, posture, flange_unloaded) * cell.parent_from_cell.translation(),
          axes * reading.head<3>(), axes * reading.tail<3>()};
}

}  // namespace stiffscope
