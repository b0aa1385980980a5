#include "core/diagnosis/arm_geometry.h"

#include "core/frames/arm_in_r0.h"
#include "metrology/measured_line.h"
#include "metrology/rigid_motion.h"

namespace stiffscope {

LoadingGeometry moved(const LoadingGeometry& geometry, const Eigen::VectorXd& steps,
                      const Eigen::Vector3d& centre) {
  LoadingGeometry result = geometry;
  Robot& arm = result.arm;
  for (std::size_t j = 0; j < 6; ++j) {
    const Eigen::Vector4d own = steps.segment<4>(4 * static_cast<Eigen::Index>(j));
    Line& axis = arm.axes_in_base_at_zero[j];
    Eigen::Vector3d u, v;
    basisAcross(axis.direction, u, v);
    axis = {axis.point + own[0] * u + own[1] * v, (axis.direction + own[2] * u + own[3] * v).normalized()};
  }
  if (!steps.segment<8>(16).isZero()) {
    const Eigen::Isometry3d carry = flangeCarry(geometry.arm.axes_in_base_at_zero, arm.axes_in_base_at_zero);
    arm.base_from_flange_at_zero = carry * arm.base_from_flange_at_zero;
    for (LinkFrame& link : arm.links) {
      if (link.body == 6) link.base_from_link_at_zero = carry * link.base_from_link_at_zero;
    }
  }
  if (result.r0_from_loading) {
    result.r0_from_loading =
        motionAbout(centre, steps.segment<6>(GeometrySteps::kAxes)) * *geometry.r0_from_loading;
  }
  for (std::size_t t = 0; t < result.targets_at_zero.size(); ++t) {
    if (!result.targets_at_zero[t]) continue;
    *result.targets_at_zero[t] +=
        steps.segment<3>(GeometrySteps::kAxes + GeometrySteps::kBase + 3 * static_cast<Eigen::Index>(t));
  }
  return result;
}

}  // namespace stiffscope
