#include "core/diagnosis/effect_model.h"

#include <fmt/format.h>

namespace stiffscope {

std::vector<EffectPart> jointParts(double most, bool positive, const std::string& unit) {
  std::vector<EffectPart> parts;
  for (int j = 1; j <= 6; ++j) parts.push_back({fmt::format("joint {}", j), {most}, positive, unit});
  return parts;
}

Eigen::VectorXd bySprings(const WorkingPoint& at, const ArmState& state, const Wrench& change) {
  Vector6d torque;
  for (int j = 0; j < 6; ++j) {
    const Line& axis = state.axes[static_cast<std::size_t>(j)];
    torque[j] = axis.direction.dot(change.about(axis.point).moment);
  }
  return byJoints(state, at.compliance.cwiseProduct(torque));
}

}  // namespace stiffscope
