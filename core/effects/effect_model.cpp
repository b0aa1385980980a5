#include "core/effects/effect_model.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "metrology/rigid_motion.h"

namespace stiffscope::effects {

bool LinearizationPoint::jointsTurn() const {
  return std::any_of(present.begin(), present.end(), [](const PresentEffect& one) { return one.model->angles; });
}

bool LinearizationPoint::bodiesMove() const {
  return std::any_of(present.begin(), present.end(), [](const PresentEffect& one) { return one.model->twists; });
}

Eigen::Vector3d LinearizationPoint::travelOf(double carriage) const {
  if (std::isnan(carriage)) return Eigen::Vector3d::Zero();
  return r0_from_base_link.linear() * (carriage * rail_in_base);
}

Eigen::Vector3d LinearizationPoint::travelFromMean(double carriage) const { return travelOf(carriage - rail.mean); }

Eigen::MatrixXd LinearizationPoint::byMovedInstrument(const ArmState& state) const {
  Eigen::MatrixXd columns(state.rows(), 6);
  const Eigen::Vector3d pivot = epoch_centre - travelFromMean(state.carriage), none = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    columns.col(k) = byMotion(state, pivot, Eigen::Vector3d::Unit(k), none);
    columns.col(3 + k) = byMotion(state, pivot, none, Eigen::Vector3d::Unit(k));
  }
  return columns;
}

Eigen::Isometry3d LinearizationPoint::withoutMovedInstrument(const Vector6d& motion, double carriage) const {
  // The motion turned the points where they were read; travel is what lies between there and where they are referred
  // to.
  const Eigen::Vector3d travel = travelFromMean(carriage);
  return Eigen::Translation3d(-travel) * metrology::motionAbout(epoch_centre, motion).inverse() *
         Eigen::Translation3d(travel);
}

Eigen::MatrixXd EffectModel::columns(const LinearizationPoint& at, const PostureStates& posture,
                                     std::size_t state) const {
  if (angles) return byJoints(posture[state], angles(at, posture, state));
  if (offset) return offset(at, posture, state);
  const std::vector<BodyTwist> motions = twists(at, posture, state);
  Eigen::MatrixXd columns(posture[state].rows(), static_cast<Eigen::Index>(motions.size()));
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const BodyTwist& one = motions[k];
    columns.col(static_cast<Eigen::Index>(k)) = byMotion(posture[state], one.pivot, one.rotation, one.shift);
  }
  return columns;
}

std::size_t EffectModel::parameters() const {
  std::size_t count = 0;
  for (const EffectPart& part : parts) count += part.most.size();
  return count;
}

std::vector<EffectPart> jointParts(const ModelScope& scope, double most, bool positive, const std::string& unit) {
  std::vector<EffectPart> parts;
  for (int j = 1; j <= scope.joints; ++j) parts.push_back({fmt::format("joint {}", j), {most}, positive, unit});
  return parts;
}

EffectPart rigidMotionPart(double most) {
  EffectPart part{"", std::vector<double>(6, most), false, "rad, m"};
  for (const char* axis : {"x", "y", "z"}) part.names.push_back(fmt::format("turn about {}", axis));
  for (const char* axis : {"x", "y", "z"}) part.names.push_back(fmt::format("shift along {}", axis));
  part.units = {"rad", "rad", "rad", "m", "m", "m"};
  return part;
}

Eigen::VectorXd bySprings(const LinearizationPoint& at, const ArmState& state, const robot::Wrench& change) {
  const JointVector turn = at.compliance.cwiseProduct(robot::jointTorque(state.axes, change));
  return byJoints(state, turn);
}

std::string parameterName(const EffectPart& part, std::size_t k) {
  return part.names.empty() ? part.detail : part.names[k];
}

std::string parameterUnit(const EffectPart& part, std::size_t k) {
  return part.units.empty() ? part.unit : part.units[k];
}

}  // namespace stiffscope::effects
