#include "core/calibration/denavit_hartenberg.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "metrology/lines.h"

namespace stiffscope::calibration {

namespace {

using Eigen::AngleAxisd, Eigen::Vector3d;

Eigen::Isometry3d frameOf(const Vector3d& origin, const Vector3d& x, const Vector3d& z) {
  Eigen::Isometry3d frame;
  frame.linear().col(0) = x;
  frame.linear().col(1) = z.cross(x);
  frame.linear().col(2) = z;
  frame.translation() = origin;
  frame.makeAffine();
  return frame;
}

/// Turn about `axis` that brings `from` onto `to`, both across it.
double turnAbout(const Vector3d& axis, const Vector3d& from, const Vector3d& to) {
  return std::atan2(axis.dot(from.cross(to)), from.dot(to));
}

bool nearParallel(const metrology::Line& first, const metrology::Line& second) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  return metrology::angleBetween(first, second) < kDegree;
}

/// Parameters from a frame on its axis to the next axis, and the frame there. `x_hint`: which way x points where either
/// way would do; zero: towards the next axis.
LinkParameters linkTo(const metrology::Line& next, bool hayati, const Vector3d& x_hint, Eigen::Isometry3d& frame) {
  LinkParameters link;
  link.hayati = hayati;
  const Vector3d z = frame.linear().col(2), x_before = frame.linear().col(0), origin = frame.translation();
  const Vector3d hint = x_hint.isZero() ? x_before : x_hint;
  if (hayati) {
    const double along = z.dot(next.direction);
    const Vector3d pierced = next.point + next.direction * (z.dot(origin - next.point) / along);
    const Vector3d between = pierced - origin;
    constexpr double kSameLine = 1e-6;  // m: x is then free
    Vector3d x = between.norm() > kSameLine ? Vector3d(between.normalized()) : x_before;
    if (x.dot(hint) < 0.0) x = -x;
    link.theta = turnAbout(z, x_before, x);
    link.a = x.dot(between);
    // Rx(alpha) Ry(beta) z = (sin beta, -sin alpha cos beta, cos alpha cos beta).
    const Vector3d to = frameOf(origin, x, z).linear().transpose() * next.direction;
    link.beta = std::asin(std::clamp(to.x(), -1.0, 1.0));
    link.alpha = std::atan2(-to.y(), to.z());
  } else {
    const metrology::CommonPerpendicular feet =
        metrology::commonPerpendicular({origin, z}, {next.point, next.direction});
    Vector3d x = z.cross(next.direction).normalized();
    if (x.dot(hint) < 0.0) x = -x;
    link.theta = turnAbout(z, x_before, x);
    link.d = z.dot(feet.foot_on_first - origin);
    link.a = x.dot(feet.foot_on_second - feet.foot_on_first);
    link.alpha = turnAbout(x, z, next.direction);
  }
  frame = frame * link.at(0.0);
  return link;
}

}  // namespace

Eigen::Isometry3d LinkParameters::at(double q) const {
  Eigen::Isometry3d motion(AngleAxisd(theta + q, Vector3d::UnitZ()));
  motion = motion * Eigen::Translation3d(a, 0.0, hayati ? 0.0 : d) * AngleAxisd(alpha, Vector3d::UnitX());
  if (hayati) motion = motion * AngleAxisd(beta, Vector3d::UnitY());
  return motion;
}

Eigen::Isometry3d DenavitHartenberg::flangeAt(const JointVector& q) const {
  Eigen::Isometry3d frame = base_from_first;
  const JointVector angles = couplings ? couplings->angles(q) : q;
  for (std::size_t i = 0; i < links.size(); ++i) frame = frame * links[i].at(angles[static_cast<Eigen::Index>(i)]);
  return frame * AngleAxisd(angles[angles.size() - 1], Vector3d::UnitZ()) * last_from_flange;
}

DenavitHartenberg denavitHartenberg(const robot::Robot& arm, const robot::Robot& nominal) {
  const auto& axes = arm.axes_in_base_at_zero;
  const auto& as_built = nominal.axes_in_base_at_zero;
  DenavitHartenberg result;
  result.couplings = axes.couplings;
  result.links.resize(axes.size() - 1);
  const auto firstFrame = [](const metrology::Line& axis) {
    Vector3d x = Vector3d::UnitX() - axis.direction * axis.direction.x();
    if (x.norm() < 0.5) x = Vector3d::UnitY() - axis.direction * axis.direction.y();
    return frameOf(metrology::nearestPoint(axis, Vector3d::Zero()), x.normalized(), axis.direction);
  };
  Eigen::Isometry3d frame = result.base_from_first = firstFrame(axes[0]);
  Eigen::Isometry3d frame_as_built = firstFrame(as_built[0]);
  for (std::size_t i = 0; i < result.links.size(); ++i) {
    const bool hayati = nearParallel(as_built[i], as_built[i + 1]);
    linkTo(as_built[i + 1], hayati, Vector3d::Zero(), frame_as_built);
    result.links[i] = linkTo(axes[i + 1], hayati, frame_as_built.linear().col(0), frame);
  }
  result.last_from_flange = frame.inverse() * arm.base_from_flange_at_zero;
  return result;
}

PerJoint<LinkParameters> withoutRounding(PerJoint<LinkParameters> uncertainties) {
  using Numbers = std::vector<double LinkParameters::*>;
  const Numbers lengths{&LinkParameters::d, &LinkParameters::a},
      angles{&LinkParameters::theta, &LinkParameters::alpha, &LinkParameters::beta};
  constexpr double kRounding = 1e-6;  // a quotient over steps of a micrometre leaves 1e-10 of a metre
  for (const Numbers& kind : {lengths, angles}) {
    double largest = 0.0;
    for (const LinkParameters& link : uncertainties)
      for (const auto number : kind) largest = std::max(largest, link.*number);
    for (LinkParameters& link : uncertainties) {
      for (const auto number : kind)
        if (link.*number < kRounding * largest) link.*number = 0.0;
    }
  }
  return uncertainties;
}

}  // namespace stiffscope::calibration
