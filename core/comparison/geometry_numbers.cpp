#include "core/comparison/geometry_numbers.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/calibration/denavit_hartenberg.h"
#include "core/comparison/matched_postures.h"
#include "core/frames/arm_parameters.h"
#include "core/robot/inverse_kinematics.h"
#include "core/robot/kinematics.h"
#include "metrology/lines.h"

namespace stiffscope::comparison {

using calibration::DenavitHartenberg, calibration::denavitHartenberg;
using calibration::LinkParameters;

namespace {

constexpr double kStep = frames::ArmParameters::kSmall;

/// Whether the URDF has an axis where the one before it is; a calibrated one nearly so.
bool areOneLine(const metrology::Line& inner, const metrology::Line& outer) {
  return inner.direction.cross(outer.direction).norm() < kSameDirection &&
         inner.direction.cross(outer.point - inner.point).norm() < kSamePlace;
}

/// A link as its numbers have it.
struct Link {
  LinkParameters apart;  ///< of axes that are not one line
  // Of axes that are: where the outer one stands at the zero of both, and nothing about it.
  bool one_line = false, opposite = false;
  double off_x = 0.0, off_y = 0.0, tilt_x = 0.0, tilt_y = 0.0;

  /// What stands between the two axes, without a turn about either.
  Eigen::Isometry3d off() const {
    const double along = std::sqrt(std::max(0.0, 1.0 - tilt_x * tilt_x - tilt_y * tilt_y));
    const Eigen::Vector3d as_built = (opposite ? -1.0 : 1.0) * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d direction(tilt_x, tilt_y, opposite ? -along : along);
    Eigen::Isometry3d motion(Eigen::Translation3d(off_x, off_y, 0.0) *
                             Eigen::Quaterniond::FromTwoVectors(as_built, direction));
    if (opposite) motion.rotate(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
    return motion;
  }
  Eigen::Isometry3d at(double q) const {
    return one_line ? Eigen::AngleAxisd(q, Eigen::Vector3d::UnitZ()) * off() : apart.at(q);
  }
};

double& valueOf(Link& link, NumberKind kind) {
  switch (kind) {
    case NumberKind::joint_zero:
      return link.apart.theta;
    case NumberKind::along:
      return link.apart.d;
    case NumberKind::distance:
      return link.apart.a;
    case NumberKind::twist:
      return link.apart.alpha;
    case NumberKind::off_x:
      return link.off_x;
    case NumberKind::off_y:
      return link.off_y;
    case NumberKind::tilt_x:
      return link.tilt_x;
    case NumberKind::tilt_y:
      return link.tilt_y;
    case NumberKind::tilt:
      break;
  }
  return link.apart.beta;
}

/// An arm as its numbers have it.
struct Chain {
  Eigen::Isometry3d base_from_first = Eigen::Isometry3d::Identity();
  PerJoint<Link> links;
  std::shared_ptr<const robot::Couplings> couplings;

  /// base_from_frame on the last axis: the frame that reflectors are fixed to.
  Eigen::Isometry3d lastFrame(const JointVector& q) const {
    const JointVector angles = couplings ? couplings->angles(q) : q;
    Eigen::Isometry3d frame = base_from_first;
    for (std::size_t i = 0; i < links.size(); ++i) frame = frame * links[i].at(angles[static_cast<Eigen::Index>(i)]);
    return frame * Eigen::AngleAxisd(angles[angles.size() - 1], Eigen::Vector3d::UnitZ());
  }
};

/// Denavit and Hartenberg's links, but that the turn between axes that are one line, where x points anywhere, is part
/// of the next link's.
Chain chainOf(const robot::Robot& arm, const robot::Robot& nominal) {
  const DenavitHartenberg built = denavitHartenberg(arm, nominal);
  const auto& axes = nominal.axes_in_base_at_zero;
  Chain chain{built.base_from_first, {}, built.couplings};
  double turn = 0.0;  // handed on
  for (std::size_t i = 0; i < built.links.size(); ++i) {
    Link link{.apart = built.links[i]};
    link.apart.theta += turn;
    turn = 0.0;
    link.one_line = i > 0 && areOneLine(axes[i], axes[i + 1]);
    if (link.one_line) {
      const Eigen::Isometry3d to_next = link.apart.at(0.0);
      const Eigen::Vector3d direction = to_next.linear().col(2);
      link.opposite = direction.z() < 0.0;
      link.off_x = to_next.translation().x(), link.off_y = to_next.translation().y();
      link.tilt_x = direction.x(), link.tilt_y = direction.y();
      const Eigen::Matrix3d rest = link.off().linear().transpose() * to_next.linear();
      turn = std::atan2(rest(1, 0), rest(0, 0));
    }
    chain.links.push_back(link);
  }
  return chain;
}

/// What the first link does along and about axis 1 before anything that a machine keeps.
Eigen::Isometry3d firstAlongAxis(const Link& first) {
  Eigen::Isometry3d motion(Eigen::AngleAxisd(first.apart.theta, Eigen::Vector3d::UnitZ()));
  return first.apart.hayati ? motion : motion * Eigen::Translation3d(0.0, 0.0, first.apart.d);
}

}  // namespace

GeometryNumbers::GeometryNumbers(const robot::Robot& nominal) : nominal_(nominal) {
  const Chain chain = chainOf(nominal, nominal);
  for (int axis = 1; axis < nominal.axes(); ++axis) {
    const Link& link = chain.links[static_cast<std::size_t>(axis) - 1];
    if (link.one_line) {
      for (const NumberKind kind : {NumberKind::off_x, NumberKind::off_y, NumberKind::tilt_x, NumberKind::tilt_y})
        numbers_.push_back({kind, axis});
      continue;
    }
    const bool hayati = link.apart.hayati;
    if (axis > 1) numbers_.push_back({NumberKind::joint_zero, axis, jointOfZero(axis)});
    if (axis > 1 && !hayati) numbers_.push_back({NumberKind::along, axis});
    numbers_.push_back({NumberKind::distance, axis});
    numbers_.push_back({NumberKind::twist, axis});
    if (hayati) numbers_.push_back({NumberKind::tilt, axis});
  }
}

int GeometryNumbers::oneLineWith(int axis) const {
  const auto& axes = nominal_.axes_in_base_at_zero;
  const auto at = static_cast<std::size_t>(axis) - 1;
  return axis > 2 && areOneLine(axes[at - 1], axes[at]) ? axis - 1 : 0;
}

int GeometryNumbers::jointOfZero(int axis) const {
  const robot::ArmAxes& axes = nominal_.axes_in_base_at_zero;
  for (int one = axis; one > 0; one = oneLineWith(one)) {
    const int joint = axes.jointOf(one - 1);
    if (joint >= 0 && axes.turnsAlone(joint)) return joint + 1;
  }
  return 0;
}

Eigen::VectorXd GeometryNumbers::of(const robot::Robot& arm) const {
  Chain links = chainOf(arm, nominal_);
  Eigen::VectorXd values(count());
  for (std::size_t k = 0; k < numbers_.size(); ++k) {
    values[static_cast<Eigen::Index>(k)] =
        valueOf(links.links[static_cast<std::size_t>(numbers_[k].axis) - 1], numbers_[k].kind);
  }
  return values;
}

Eigen::VectorXd GeometryNumbers::difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  Eigen::VectorXd difference = b - a;
  for (std::size_t k = 0; k < numbers_.size(); ++k) {
    double& value = difference[static_cast<Eigen::Index>(k)];
    if (!numbers_[k].isLength()) value = std::remainder(value, 2.0 * std::numbers::pi);
  }
  return difference;
}

Eigen::Isometry3d GeometryNumbers::pointsFromBase(const robot::Robot& nominal, const calibration::ArmFit& fit) const {
  const Chain now = chainOf(fit.arm(nominal), nominal_), built = chainOf(nominal_, nominal_);
  return fit.basePointsMotion().inverse() * now.base_from_first * firstAlongAxis(now.links[0]) *
         (built.base_from_first * firstAlongAxis(built.links[0])).inverse();
}

Eigen::VectorXd GeometryNumbers::allOf(const robot::Robot& nominal, const calibration::ArmFit& fit,
                                       const std::vector<int>& targets,
                                       const Eigen::Isometry3d& points_from_base) const {
  const robot::Robot arm = fit.arm(nominal);
  const Eigen::Index reflectors = 3 * static_cast<Eigen::Index>(targets.size());
  Eigen::VectorXd all(count() + reflectors + 6);
  all.head(count()) = of(arm);
  const JointVector zero = JointVector::Zero(nominal_.joints());
  const Eigen::Isometry3d flange_from_base = nominal_.base_from_flange_at_zero.inverse() *
                                             chainOf(nominal_, nominal_).lastFrame(zero) *
                                             chainOf(arm, nominal_).lastFrame(zero).inverse();
  const std::vector<Eigen::Vector3d> at_zero = fit.targetsAtZero();
  for (std::size_t t = 0; t < targets.size(); ++t) {
    all.segment<3>(count() + 3 * static_cast<Eigen::Index>(t)) =
        flange_from_base * at_zero[static_cast<std::size_t>(targets[t])];
  }
  const Eigen::Isometry3d moved = points_from_base.inverse() * pointsFromBase(nominal, fit);
  all.segment<3>(count() + reflectors) = robot::rotationVector(moved.linear());
  all.tail<3>() = moved.translation();
  return all;
}

Eigen::MatrixXd GeometryNumbers::movesOfReflectors(const robot::Robot& arm,
                                                   const std::vector<Eigen::Vector3d>& targets_at_zero,
                                                   const std::vector<const calibration::UnloadedDay*>& days) const {
  constexpr std::size_t kEnough = 600;  // postures: a rms over more is the same
  std::vector<JointVector> postures;
  for (const calibration::UnloadedDay* day : days) {
    const std::size_t stride = day->postures.size() / (kEnough / days.size()) + 1;
    for (std::size_t i = 0; i < day->postures.size(); i += stride) postures.push_back(day->postures[i].q);
  }
  const Chain links = chainOf(arm, nominal_);
  std::vector<Chain> moved(numbers_.size(), links);
  for (std::size_t k = 0; k < numbers_.size(); ++k)
    valueOf(moved[k].links[static_cast<std::size_t>(numbers_[k].axis) - 1], numbers_[k].kind) += kStep;
  const Eigen::Isometry3d last_from_base = links.lastFrame(JointVector::Zero(nominal_.joints())).inverse();
  const auto targets = static_cast<Eigen::Index>(targets_at_zero.size());
  const Eigen::Index rows = 3 * targets * static_cast<Eigen::Index>(postures.size());
  Eigen::MatrixXd moves(rows, count()), others = Eigen::MatrixXd::Zero(rows, 6 + 3 * targets);
  Eigen::Index row = 0;
  for (const JointVector& q : postures) {
    const Eigen::Isometry3d frame = links.lastFrame(q);
    std::vector<Eigen::Isometry3d> frames;
    for (const Chain& one : moved) frames.push_back(one.lastFrame(q));
    for (Eigen::Index t = 0; t < targets; ++t, row += 3) {
      const Eigen::Vector3d in_last = last_from_base * targets_at_zero[static_cast<std::size_t>(t)];
      const Eigen::Vector3d at = frame * in_last;
      for (std::size_t k = 0; k < frames.size(); ++k)
        moves.block<3, 1>(row, static_cast<Eigen::Index>(k)) = (frames[k] * in_last - at) / kStep;
      for (Eigen::Index k = 0; k < 3; ++k) others.block<3, 1>(row, k) = Eigen::Vector3d::Unit(k).cross(at);
      others.block<3, 3>(row, 3).setIdentity();
      others.block<3, 3>(row, 6 + 3 * t) = frame.linear();
    }
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(1e-9);
  qr.compute(others);
  const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(rows, qr.rank());
  moves -= basis * (basis.transpose() * moves);
  return 3.0 / static_cast<double>(rows) * moves.transpose() * moves;
}

Eigen::VectorXd GeometryNumbers::byJoint(const robot::Robot& arm, int joint) const {
  JointVector turn = JointVector::Zero(arm.joints());
  turn[joint] = kStep;
  robot::Robot turned = arm;
  turned.axes_in_base_at_zero = robot::axesAt(arm, robot::postureAt(arm, turn));
  return difference(of(arm), of(turned)) / kStep;
}

Eigen::MatrixXd GeometryNumbers::byLink(const robot::Robot& arm, int axis) const {
  const Eigen::VectorXd before = of(arm);
  Eigen::MatrixXd changes(count(), 6);
  const Eigen::Vector3d& about = arm.axes_in_base_at_zero[static_cast<std::size_t>(axis)].point;
  for (int k = 0; k < 6; ++k) {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    if (k < 3) {
      motion = Eigen::Translation3d(about) * Eigen::AngleAxisd(kStep, Eigen::Vector3d::Unit(k)) *
               Eigen::Translation3d(-about);
    } else {
      motion.translation() = kStep * Eigen::Vector3d::Unit(k - 3);
    }
    robot::Robot bent = arm;
    for (std::size_t j = static_cast<std::size_t>(axis); j < bent.axes_in_base_at_zero.size(); ++j) {
      metrology::Line& line = bent.axes_in_base_at_zero[j];
      line = {motion * line.point, motion.linear() * line.direction};
    }
    changes.col(k) = difference(before, of(bent)) / kStep;
  }
  return changes;
}

Eigen::MatrixXd GeometryNumbers::byAxis(const robot::Robot& arm, int axis) const {
  const Eigen::VectorXd before = of(arm);
  Eigen::MatrixXd changes(count(), 4);
  const frames::AxesAtStart start = frames::axesAtStart(arm.axes_in_base_at_zero);
  for (int k = 0; k < 4; ++k) {
    const auto j = static_cast<std::size_t>(axis) - 1;
    robot::Robot moved = arm;
    moved.axes_in_base_at_zero[j] = start[j].moved(kStep * Eigen::Vector4d::Unit(k));
    changes.col(k) = difference(before, of(moved)) / kStep;
  }
  return changes;
}

Eigen::VectorXd GeometryNumbers::byGrowth(const robot::Robot& arm) const {
  Eigen::VectorXd lengths = of(arm);
  for (std::size_t k = 0; k < numbers_.size(); ++k) {
    if (!numbers_[k].isLength()) lengths[static_cast<Eigen::Index>(k)] = 0.0;
  }
  return lengths;
}

}  // namespace stiffscope::comparison
