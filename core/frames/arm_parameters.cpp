#include "core/frames/arm_parameters.h"

#include "core/frames/base_frame.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::frames {

AxesAtStart sweptAxes(const Frames& frames, const robot::ArmAxes& axes) {
  const Eigen::Matrix3d turn = frames.arm.r0_from_points.linear();
  AxesAtStart start(axes.size());
  start.couplings = axes.couplings;
  for (std::size_t j = 0; j < start.size(); ++j) {
    const metrology::MeasuredLine& swept = frames.axes[j].at_zero;
    const metrology::Line& axis = axes[j];
    const Eigen::Vector3d beside = frames.arm.r0_from_points * swept.line.point - axis.point;
    const Eigen::Vector3d point = axis.point + axis.direction.dot(beside) * axis.direction;
    start[j] = {{point, axis.direction}, turn * swept.across_u, turn * swept.across_v, swept.covariance};
  }
  return start;
}

namespace {

Eigen::Vector4d ofAxis(const Eigen::Ref<const Eigen::VectorXd>& steps, std::size_t axis) {
  return steps.segment<ArmParameters::kOfAxis>(ArmParameters::kOfAxis * static_cast<Eigen::Index>(axis));
}

}  // namespace

LoadingGeometry moved(const LoadingGeometry& geometry, const Eigen::VectorXd& steps, const Eigen::Vector3d& centre) {
  LoadingGeometry result = geometry;
  const ArmParameters parameters(geometry.arm.axes());
  const AxesAtStart start = axesAtStart(geometry.arm.axes_in_base_at_zero);
  for (std::size_t j = 0; j < start.size(); ++j) {
    result.arm.axes_in_base_at_zero[j] = start[j].moved(ofAxis(steps, j));
  }
  const std::size_t last = start.size() - 1, across = axisAcrossLast(geometry.arm.axes_in_base_at_zero);
  if (!ofAxis(steps, across).isZero() || !ofAxis(steps, last).isZero())
    carryFlange(geometry.arm.axes_in_base_at_zero, result.arm);
  if (result.r0_from_loading) {
    const Vector6d of_readings = steps.segment<ArmParameters::kBase>(parameters.baseAt());
    result.r0_from_loading = metrology::motionAbout(centre, of_readings) * *geometry.r0_from_loading;
  }
  for (std::size_t t = 0; t < result.targets_at_zero.size(); ++t) {
    if (!result.targets_at_zero[t]) continue;
    *result.targets_at_zero[t] += steps.segment<3>(parameters.targetAt(t));
  }
  return result;
}

}  // namespace stiffscope::frames
