#include "core/mistakes/nominal_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/numerics/resampling.h"
#include "core/robot/kinematics.h"
#include "metrology/linear_algebra.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::mistakes {

namespace {

constexpr int kLeastReadings = 12;

/// The part of a reading's equation that no parameter changes.
struct Pose {
  Eigen::Isometry3d flange;
  robot::ArmAxes axes;
  JointVector torque;  ///< of the own weight
};

std::vector<Pose> posesOf(const ReadingsOfDay& day, bool sag) {
  std::vector<Pose> poses;
  poses.reserve(day.unloaded.size());
  for (const UnloadedReading& reading : day.unloaded) {
    // Reflectors of one state follow each other.
    if (!poses.empty() && (&reading)[-1].q == reading.q) {
      poses.push_back(poses.back());
      continue;
    }
    const robot::ArmPosture posture = robot::postureAt(day.robot, reading.q);
    Pose pose{robot::flangeAt(day.robot, posture), {}, JointVector::Zero(reading.q.size())};
    if (sag) {
      pose.axes = robot::axesAt(day.robot, posture);
      pose.torque = robot::weightTorque(day.robot, posture, day.weight);
    }
    poses.push_back(pose);
  }
  return poses;
}

/// M y - u - R p_k = t by least squares, (R, t) the flange's pose: the start of the fit, and what is left of it.
struct AffineStart {
  Eigen::Matrix3d map = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< u
  std::vector<Eigen::Vector3d> reflectors;
  double rms = 0.0;
};

AffineStart affineStart(const ReadingsOfDay& day, const std::vector<Pose>& poses) {
  const Eigen::Index size = 12 + 3 * day.targets;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const UnloadedReading& reading : day.unloaded) middle += reading.point / static_cast<double>(poses.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  Eigen::Matrix<double, 3, Eigen::Dynamic> rows(3, size);
  double squares = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const UnloadedReading& reading = day.unloaded[i];
    const Eigen::Vector3d y = reading.point - middle;
    rows.setZero();
    for (Eigen::Index k = 0; k < 3; ++k) rows.block<1, 3>(k, 3 * k) = y.transpose();
    rows.middleCols<3>(9) = -Eigen::Matrix3d::Identity();
    rows.middleCols<3>(12 + 3 * reading.target) = -poses[i].flange.linear();
    const Eigen::Vector3d t = poses[i].flange.translation();
    normal.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
    right += rows.transpose() * t;
    squares += t.squaredNorm();
  }
  // Directions that the readings leave open stay near zero.
  const double ridge = 1e-9 * normal.diagonal().maxCoeff();
  normal = Eigen::MatrixXd(normal.selfadjointView<Eigen::Lower>());
  normal.diagonal().array() += ridge;
  const Eigen::VectorXd found = solveSymmetric(normal, right);
  AffineStart start;
  for (Eigen::Index k = 0; k < 3; ++k) start.map.row(k) = found.segment<3>(3 * k).transpose();
  start.shift = found.segment<3>(9) + start.map * middle;
  for (int k = 0; k < day.targets; ++k) start.reflectors.emplace_back(found.segment<3>(12 + 3 * k));
  start.rms = std::sqrt(std::max(0.0, squares - found.dot(right)) / static_cast<double>(poses.size()));
  return start;
}

class GaussNewton {
 public:
  GaussNewton(const ReadingsOfDay& day, const NominalFitOptions& options)
      : day_(day),
        sag_(options.sag && day.weight.links_known && day.weight.any()),
        scale_(options.scale),
        springs_(options.springs),
        poses_(posesOf(day, sag_)),
        largest_torque_(JointVector::Zero(day.robot.joints())) {
    fit_.compliance = largest_torque_;
    for (const Pose& pose : poses_) largest_torque_ = largest_torque_.cwiseMax(pose.torque.cwiseAbs());
  }

  NominalFit run() {
    if (springs_) fit_.sag_factor = 0.0;  // linear in it; a start far off would bend the arm double
    const AffineStart start = affineStart(day_, poses_);
    fit_.base_from_points.linear() = metrology::nearestRotation(start.map).rotation;
    fit_.reflectors_in_flange = start.reflectors;
    placeReflectors();
    // From a start by readings that contradict each other, weights by misfit would fix whichever is nearest by chance.
    constexpr int kPlain = 4, kRounds = 14;
    weights_.assign(static_cast<std::size_t>(day_.groups), 1.0);
    for (int round = 0; round < kRounds; ++round) {
      step();
      describe();
      if (round >= kPlain) setWeights();
    }
    fit_.done = true;
    return std::move(fit_);
  }

 private:
  Eigen::Index sagCount() const { return !sag_ ? 0 : springs_ ? 1 : day_.robot.joints(); }

  Eigen::Vector3d measured(std::size_t i) const {
    return fit_.scale * (fit_.base_from_points.linear() * day_.unloaded[i].point) + fit_.base_from_points.translation();
  }

  PointJacobian sagColumns(std::size_t i, const Eigen::Vector3d& at) const {
    return robot::pointJacobianAt(poses_[i].axes, at) * poses_[i].torque.asDiagonal();
  }

  Eigen::Vector3d modelled(std::size_t i) const {
    const Eigen::Vector3d rigid =
        poses_[i].flange * fit_.reflectors_in_flange[static_cast<std::size_t>(day_.unloaded[i].target)];
    return sag_ ? Eigen::Vector3d(rigid + sagColumns(i, rigid) * fit_.compliance) : rigid;
  }

  /// Base and reflectors by the turn alone, which makes them linear.
  void placeReflectors() {
    const Eigen::Index size = 3 + 3 * day_.targets;
    Eigen::MatrixXd normal = 1e-9 * Eigen::MatrixXd::Identity(size, size);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const Eigen::Index at = 3 + 3 * day_.unloaded[i].target;
      const Eigen::Matrix3d turn = poses_[i].flange.linear();
      const Eigen::Vector3d off =
          fit_.base_from_points.linear() * day_.unloaded[i].point - poses_[i].flange.translation();
      normal.topLeftCorner<3, 3>() += Eigen::Matrix3d::Identity();
      normal.block<3, 3>(0, at) -= turn;
      normal.block<3, 3>(at, 0) -= turn.transpose();
      normal.block<3, 3>(at, at) += Eigen::Matrix3d::Identity();
      right.head<3>() -= off;
      right.segment<3>(at) += turn.transpose() * off;
    }
    const Eigen::VectorXd found = solveSymmetric(normal, right);
    fit_.base_from_points.translation() = found.head<3>();
    for (int k = 0; k < day_.targets; ++k)
      fit_.reflectors_in_flange[static_cast<std::size_t>(k)] = found.segment<3>(3 + 3 * k);
  }

  void step() {
    const Eigen::Index reflectors = 6, sags = reflectors + 3 * day_.targets, scale = sags + sagCount(),
                       size = scale + (scale_ ? 1 : 0);
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    Eigen::Matrix<double, 3, Eigen::Dynamic> rows(3, size);
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const double weight = weights_[static_cast<std::size_t>(day_.unloaded[i].group)];
      const Eigen::Vector3d x = measured(i), at = modelled(i);
      rows.setZero();
      rows.leftCols<3>() = metrology::crossMatrix(x);
      rows.middleCols<3>(3) = -Eigen::Matrix3d::Identity();
      rows.middleCols<3>(reflectors + 3 * day_.unloaded[i].target) = poses_[i].flange.linear();
      if (sag_ && springs_) {
        rows.col(sags) = sagColumns(i, at) * *springs_;
      } else if (sag_) {
        rows.middleCols(sags, sagCount()) = sagColumns(i, at);
      }
      if (scale_) rows.col(scale) = -(x - fit_.base_from_points.translation());
      normal.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose(), weight);
      right += weight * (rows.transpose() * (x - at));
    }
    normal = Eigen::MatrixXd(normal.selfadjointView<Eigen::Lower>());
    normal.diagonal().array() += 1e-9;
    if (sag_ && !springs_) holdSag(sags, normal, right);
    const Eigen::VectorXd found = solveSymmetric(normal, right);
    const Eigen::Vector3d turn = found.head<3>();
    const Eigen::Matrix3d by = turn.norm() > 0.0 ? Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix()
                                                 : Eigen::Matrix3d::Identity();
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    moved.linear() = by * fit_.base_from_points.linear();
    moved.translation() = by * fit_.base_from_points.translation() + found.segment<3>(3);
    fit_.base_from_points = moved;
    for (int k = 0; k < day_.targets; ++k)
      fit_.reflectors_in_flange[static_cast<std::size_t>(k)] += found.segment<3>(reflectors + 3 * k);
    if (sag_ && springs_) {
      fit_.sag_factor += found[sags];
      fit_.compliance = fit_.sag_factor * *springs_;
    } else if (sag_) {
      fit_.compliance += found.segment(sags, sagCount());
    }
    if (scale_) fit_.scale *= std::exp(std::clamp(found[scale], -0.5, 0.5));
  }

  /// A sag of more than half a degree of a joint is none; of joints that the weight does not turn nothing is known.
  void holdSag(Eigen::Index at, Eigen::MatrixXd& normal, Eigen::VectorXd& right) const {
    constexpr double kMostTurn = 0.01, kMisfit = 2e-3;  // rad, m
    for (Eigen::Index j = 0; j < largest_torque_.size(); ++j) {
      const double hold = std::pow(std::max(largest_torque_[j], 1.0) * kMisfit / kMostTurn, 2);
      normal(at + j, at + j) += hold;
      right[at + j] -= hold * fit_.compliance[j];
    }
  }

  void describe() {
    std::vector<double> squares(static_cast<std::size_t>(day_.groups), 0.0), counts(squares);
    double sum = 0.0;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const auto group = static_cast<std::size_t>(day_.unloaded[i].group);
      const double square = (measured(i) - modelled(i)).squaredNorm();
      squares[group] += square;
      counts[group] += 1.0;
      sum += square;
    }
    std::vector<double> known;
    for (std::size_t g = 0; g < squares.size(); ++g) {
      squares[g] = counts[g] > 0.0 ? std::sqrt(squares[g] / counts[g]) : 0.0;
      if (counts[g] > 0.0) known.push_back(squares[g]);
    }
    fit_.group_rms = squares;
    fit_.rms = std::sqrt(sum / static_cast<double>(poses_.size()));
    fit_.typical = numerics::upperMedian(known);
  }

  void setWeights() {
    constexpr double kCauchy = 2.385, kLeast = 1e-3;  // its usual constant; m
    const double scale = kCauchy * std::max(fit_.typical, kLeast);
    for (std::size_t g = 0; g < weights_.size(); ++g)
      weights_[g] = 1.0 / (1.0 + std::pow(fit_.group_rms[g] / scale, 2));
  }

  const ReadingsOfDay& day_;
  bool sag_, scale_;
  std::optional<JointVector> springs_;
  std::vector<Pose> poses_;
  JointVector largest_torque_;
  std::vector<double> weights_;
  NominalFit fit_;
};

bool enough(const ReadingsOfDay& day) {
  return day.groups >= 2 && day.targets > 0 && static_cast<int>(day.unloaded.size()) >= kLeastReadings;
}

}  // namespace

Eigen::Vector3d NominalFit::measuredPoint(const UnloadedReading& reading) const {
  return scale * (base_from_points.linear() * reading.point) + base_from_points.translation();
}

Eigen::Vector3d NominalFit::modelledPoint(const ReadingsOfDay& day, const UnloadedReading& reading) const {
  const robot::ArmPosture posture = robot::postureAt(day.robot, reading.q);
  const Eigen::Vector3d rigid =
      robot::flangeAt(day.robot, posture) * reflectors_in_flange[static_cast<std::size_t>(reading.target)];
  if (compliance.isZero()) return rigid;
  return rigid + robot::pointJacobianAt(robot::axesAt(day.robot, posture), rigid) *
                     compliance.cwiseProduct(robot::weightTorque(day.robot, posture, day.weight));
}

double NominalFit::missOf(const ReadingsOfDay& day, const UnloadedReading& reading) const {
  return (measuredPoint(reading) - modelledPoint(day, reading)).norm();
}

double NominalFit::rmsButForWorst() const {
  std::vector<double> sorted;
  for (const double one : group_rms) {
    if (one > 0.0) sorted.push_back(one);
  }
  if (sorted.size() < 3) return rms;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t worst = std::max<std::size_t>(1, sorted.size() / 20);
  double sum = 0.0;
  for (std::size_t i = 0; i + worst < sorted.size(); ++i) sum += sorted[i] * sorted[i];
  return std::sqrt(sum / static_cast<double>(sorted.size() - worst));
}

NominalFit fitNominal(const ReadingsOfDay& day, const NominalFitOptions& options) {
  return enough(day) ? GaussNewton(day, options).run() : NominalFit{};
}

double affineMisfit(const ReadingsOfDay& day) { return enough(day) ? affineStart(day, posesOf(day, false)).rms : 0.0; }

}  // namespace stiffscope::mistakes
