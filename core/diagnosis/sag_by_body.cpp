#include "core/diagnosis/sag_by_body.h"

namespace stiffscope {

namespace {

/// Joint angles in place of displacements.
Matrix6d anglesByBody(const WorkingPoint& at, const ArmState& state) {
  Matrix6d angles = Matrix6d::Zero();
  for (int body = 1; body <= 6; ++body) {
    const auto b = static_cast<std::size_t>(body);
    Wrench own = state.weight_from_body[b];
    if (body < 6) {
      own.force -= state.weight_from_body[b + 1].force;
      own.moment -= state.weight_from_body[b + 1].moment;
    }
    for (int j = 0; j < body; ++j) {
      const Line& axis = state.axes[static_cast<std::size_t>(j)];
      angles(j, body - 1) = at.compliance[j] * axis.direction.dot(own.about(axis.point).moment);
    }
  }
  return angles;
}

}  // namespace

Eigen::MatrixXd sagByBody(const WorkingPoint& at, const ArmState& state) {
  return byJoints(state, anglesByBody(at, state));
}

}  // namespace stiffscope
