#include "core/comparison/geometry_numbers.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "core/calibration/denavit_hartenberg.h"
#include "core/frames/arm_parameters.h"
#include "core/robot/inverse_kinematics.h"
#include "metrology/lines.h"

namespace stiffscope::comparison {

using calibration::DenavitHartenberg, calibration::denavitHartenberg;
using calibration::LinkParameters;

namespace {

constexpr double kStep = frames::ArmParameters::kSmall;

double& valueOf(LinkParameters& link, NumberKind kind) {
  switch (kind) {
    case NumberKind::joint_zero:
      return link.theta;
    case NumberKind::along:
      return link.d;
    case NumberKind::distance:
      return link.a;
    case NumberKind::twist:
      return link.alpha;
    case NumberKind::tilt:
      break;
  }
  return link.beta;
}

/// base_from_frame on the last axis with all joints at `q`: the frame that reflectors are fixed to.
Eigen::Isometry3d lastFrame(const DenavitHartenberg& arm, const JointVector& q) {
  return arm.flangeAt(q) * arm.last_from_flange.inverse();
}

/// What the first link does along and about axis 1 before anything that a machine keeps.
Eigen::Isometry3d firstAlongAxis(const LinkParameters& first) {
  Eigen::Isometry3d motion(Eigen::AngleAxisd(first.theta, Eigen::Vector3d::UnitZ()));
  return first.hayati ? motion : motion * Eigen::Translation3d(0.0, 0.0, first.d);
}

}  // namespace

GeometryNumbers::GeometryNumbers(const robot::Robot& nominal) : nominal_(nominal) {
  const DenavitHartenberg links = denavitHartenberg(nominal, nominal);
  for (int axis = 1; axis < nominal.axes(); ++axis) {
    const bool hayati = links.links[static_cast<std::size_t>(axis) - 1].hayati;
    if (axis > 1) numbers_.push_back({NumberKind::joint_zero, axis});
    if (axis > 1 && !hayati) numbers_.push_back({NumberKind::along, axis});
    numbers_.push_back({NumberKind::distance, axis});
    numbers_.push_back({NumberKind::twist, axis});
    if (hayati) numbers_.push_back({NumberKind::tilt, axis});
  }
}

Eigen::VectorXd GeometryNumbers::of(const robot::Robot& arm) const {
  DenavitHartenberg links = denavitHartenberg(arm, nominal_);
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
  const DenavitHartenberg now = denavitHartenberg(fit.arm(nominal), nominal_),
                          built = denavitHartenberg(nominal_, nominal_);
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
  const DenavitHartenberg built = denavitHartenberg(nominal_, nominal_);
  const Eigen::Isometry3d flange_from_base =
      built.last_from_flange.inverse() *
      lastFrame(denavitHartenberg(arm, nominal_), JointVector::Zero(nominal_.joints())).inverse();
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
  const DenavitHartenberg links = denavitHartenberg(arm, nominal_);
  std::vector<DenavitHartenberg> moved(numbers_.size(), links);
  for (std::size_t k = 0; k < numbers_.size(); ++k)
    valueOf(moved[k].links[static_cast<std::size_t>(numbers_[k].axis) - 1], numbers_[k].kind) += kStep;
  const Eigen::Isometry3d last_from_base = lastFrame(links, JointVector::Zero(nominal_.joints())).inverse();
  const auto targets = static_cast<Eigen::Index>(targets_at_zero.size());
  const Eigen::Index rows = 3 * targets * static_cast<Eigen::Index>(postures.size());
  Eigen::MatrixXd moves(rows, count()), others = Eigen::MatrixXd::Zero(rows, 6 + 3 * targets);
  Eigen::Index row = 0;
  for (const JointVector& q : postures) {
    const Eigen::Isometry3d frame = lastFrame(links, q);
    std::vector<Eigen::Isometry3d> frames;
    for (const DenavitHartenberg& one : moved) frames.push_back(lastFrame(one, q));
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
