#include "core/effects/link_compliance.h"

#include <fmt/format.h>

namespace stiffscope::effects {

namespace {

constexpr int kLinks = 4;  // bodies 1 to 4: joint origin to the next; the wrist's own bodies are compact

Eigen::MatrixXd offset(const WorkingPoint&, const PostureStates& posture, std::size_t i) {
  const ArmState& state = posture[i];
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(state.rows(), 2 * kLinks);
  for (int link = 0; link < kLinks; ++link) {
    const Eigen::Vector3d from = state.axes[static_cast<std::size_t>(link)].point;
    const Eigen::Vector3d tip = state.axes[static_cast<std::size_t>(link) + 1].point;
    const double length = (tip - from).norm();
    constexpr double kNoBeam = 0.05;  // m: shorter is a housing
    if (length < kNoBeam) continue;
    const Eigen::Vector3d along = (tip - from) / length;
    const robot::Wrench load = carried(state, link + 2, tip);
    const Eigen::Vector3d force = load.force - along * along.dot(load.force);
    const Eigen::Vector3d moment = load.moment - along * along.dot(load.moment);
    const double square = length * length;
    columns.col(2 * link) = byMotion(state, tip, square / 2.0 * along.cross(force) + length * moment,
                                     square * length / 3.0 * force + square / 2.0 * moment.cross(along));
    columns.col(2 * link + 1) =
        byMotion(state, tip, length * along * along.dot(load.moment), Eigen::Vector3d::Zero());
  }
  return columns;
}

}  // namespace

EffectModel linkCompliance() {
  EffectModel model{Effect::link_compliance, "", {}, kLinks, &offset, nullptr};
  for (int link = 1; link <= kLinks; ++link) {
    model.parts.push_back({fmt::format("link {}", link), {1e-4, 1e-4}, true, "1/(N m^2)"});
    model.first_body.insert(model.first_body.end(), 2, link + 1);
  }
  return model;
}

}  // namespace stiffscope::effects
