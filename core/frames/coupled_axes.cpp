#include "core/frames/coupled_axes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/frames/base_from_postures.h"
#include "core/frames/placed_arm.h"
#include "core/frames/remarks.h"
#include "core/numerics/parallel.h"
#include "metrology/linear_algebra.h"
#include "metrology/measured_points.h"

namespace stiffscope::frames {

namespace {

/// The reflectors of one stop of a sweep.
struct SweepStop {
  JointVector q;
  std::vector<std::size_t> readings;  ///< in SweepReadings
};

struct SweepReadings {
  std::vector<SweepStop> stops;
  std::vector<UnloadedPosition> positions;
  std::vector<Eigen::Matrix3d> covariances;  ///< in the frame of the readings; none without a tracker
};

class Gatherer {
 public:
  explicit Gatherer(const campaign::Campaign& campaign) {
    if (campaign.tracker) noise_ = trackerNoise(*campaign.tracker);
  }

  template <class Row>
  void add(const std::vector<Row>& rows, const std::vector<Eigen::Vector3d>& rigid) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      // The reflectors of one stop follow each other.
      if (i == 0 || rows[i].q != rows[i - 1].q) all_.stops.push_back({rows[i].q, {}});
      all_.stops.back().readings.push_back(all_.positions.size());
      all_.positions.push_back({static_cast<int>(all_.stops.size()) - 1, rows[i].target, rows[i].q, rigid[i], 1});
      if (noise_) all_.covariances.push_back(noise_->covarianceAt(rows[i].point, rows[i].from));
    }
  }

  SweepReadings all() { return std::move(all_); }

 private:
  std::optional<metrology::TrackerNoise> noise_;
  SweepReadings all_;
};

struct Normal {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  double weighted = 0.0, plain = 0.0;

  Normal& operator+=(const Normal& other) {
    if (other.right.size() == 0) return *this;
    if (right.size() == 0) return *this = other;
    matrix += other.matrix;
    right += other.right;
    weighted += other.weighted;
    plain += other.plain;
    return *this;
  }
};

class CoupledFit {
 public:
  CoupledFit(const robot::Robot& arm, SweepReadings readings, const BaseFromPostures& start)
      : start_(axesAtStart(arm.axes_in_base_at_zero)),
        parameters_(arm.axes()),
        readings_(std::move(readings)),
        base_from_points_(start.points_from_base.inverse()) {
    const std::size_t count = readings_.positions.size();
    for (UnloadedPosition& position : readings_.positions) {
      position.point = base_from_points_ * position.point;
      centre_ += position.point / static_cast<double>(count);
    }
    // Where no tracker is declared: as one reads. Its size only says what counts beside the priors; the residuals say
    // how well the axes are known.
    constexpr double kUsual = 2e-5;  // m
    declared_ = !readings_.covariances.empty();
    if (!declared_) weights_.assign(count, Eigen::Matrix3d::Identity() / (kUsual * kUsual));
    for (const Eigen::Matrix3d& own : readings_.covariances) {
      weights_.push_back((base_from_points_.linear() * own * base_from_points_.linear().transpose()).inverse());
    }
    x_ = Eigen::VectorXd::Zero(parameters_.count(start.targets_at_zero.size()));
    for (std::size_t t = 0; t < start.targets_at_zero.size(); ++t) {
      if (start.targets_at_zero[t]) x_.segment<3>(parameters_.targetAt(t)) = *start.targets_at_zero[t];
    }
    addPriors();
  }

  CoupledAxes run() {
    constexpr int kMostSteps = 30;
    constexpr double kSettled = 1e-11;  // m and rad
    CoupledAxes result;
    for (int step = 0; step < kMostSteps; ++step) {
      const Normal normal = normalAt();
      const Eigen::VectorXd change = solveSymmetric(normal.matrix, normal.right);
      if (!change.allFinite()) break;
      x_ += change;
      if (change.cwiseAbs().maxCoeff() > kSettled) continue;
      describe(normalAt(), result);
      return result;
    }
    result.reason = Remark(RemarkId::coupled_axes_not_settling);
    return result;
  }

 private:
  PlacedArm placed() const {
    return {start_, centre_, AxesSteps(x_.head(parameters_.axes())), Vector6d(x_.segment<6>(parameters_.baseAt()))};
  }

  void addPriors() {
    constexpr double kOfUrdf = 0.01;                 // m and rad
    constexpr double kOneLine = 1e-9, kTied = 1e-6;  // m and rad
    prior_ = Eigen::MatrixXd::Zero(x_.size(), x_.size());
    prior_.diagonal().head(parameters_.axes()).array() = 1.0 / (kOfUrdf * kOfUrdf);
    for (std::size_t j = 1; j < start_.size(); ++j) {
      const metrology::MeasuredLine &inner = start_[j - 1], &outer = start_[j];
      const bool one = inner.line.direction.cross(outer.line.direction).norm() < kOneLine &&
                       (outer.line.point - inner.line.point).norm() < kOneLine;
      if (!one) continue;
      Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(6, x_.size());
      const double sense = inner.line.direction.dot(outer.line.direction) > 0.0 ? 1.0 : -1.0;
      const auto put = [&](const metrology::MeasuredLine& line, std::size_t axis, double sign, double tilt) {
        const auto at = static_cast<Eigen::Index>(4 * axis);
        rows.block<3, 1>(0, at) = sign * line.across_u;
        rows.block<3, 1>(0, at + 1) = sign * line.across_v;
        rows.block<3, 1>(3, at + 2) = sign * tilt * line.across_u;
        rows.block<3, 1>(3, at + 3) = sign * tilt * line.across_v;
      };
      put(inner, j - 1, 1.0, 1.0);
      put(outer, j, -1.0, sense);
      prior_ += rows.transpose() * rows / (kTied * kTied);
    }
  }

  Normal normalAt() const {
    const PlacedArm arm = placed();
    Normal sum = numerics::sumInBlocks<Normal>(readings_.stops.size(), [&](std::size_t s, Normal& all) {
      const SweepStop& stop = readings_.stops[s];
      if (all.right.size() == 0) all = {Eigen::MatrixXd::Zero(x_.size(), x_.size()), Eigen::VectorXd::Zero(x_.size())};
      const PlacedPosture posture(arm, stop.q);
      // Axes and base together, and a reflector's three.
      const Eigen::Index common = parameters_.targetsAt();
      for (const std::size_t i : stop.readings) {
        const UnloadedPosition& reading = readings_.positions[i];
        const Eigen::Index target = parameters_.targetAt(static_cast<std::size_t>(reading.target));
        const Eigen::Vector3d modelled = posture.position(x_.segment<3>(target));
        const Eigen::Vector3d left = reading.point - modelled;
        Eigen::Matrix3Xd rows(3, common + 3);
        rows.leftCols(parameters_.axes()) = posture.byAxes(modelled);
        rows.middleCols<6>(parameters_.baseAt()) = posture.byBase(modelled);
        rows.rightCols<3>() = posture.byTarget();
        const Eigen::Matrix3d& weight = weights_[i];
        const Eigen::MatrixXd weighted = rows.transpose() * weight;
        const Eigen::MatrixXd products = weighted * rows;
        all.matrix.topLeftCorner(common, common) += products.topLeftCorner(common, common);
        all.matrix.block(0, target, common, 3) += products.topRightCorner(common, 3);
        all.matrix.block(target, 0, 3, common) += products.bottomLeftCorner(3, common);
        all.matrix.block<3, 3>(target, target) += products.bottomRightCorner<3, 3>();
        const Eigen::VectorXd right = weighted * left;
        all.right.head(common) += right.head(common);
        all.right.segment<3>(target) += right.tail<3>();
        all.weighted += left.dot(weight * left);
        all.plain += left.squaredNorm();
      }
    });
    sum.matrix += prior_;
    sum.right -= prior_ * x_;
    // A reflector that the sweeps do not show stays where it is.
    for (Eigen::Index k = 0; k < x_.size(); ++k) {
      if (sum.matrix(k, k) == 0.0) sum.matrix(k, k) = 1.0;
    }
    return sum;
  }

  /// Covariance of the parameters, and the lines in the frame of the readings.
  void describe(const Normal& normal, CoupledAxes& result) const {
    const auto rows = 3.0 * static_cast<double>(readings_.positions.size());
    result.rms = std::sqrt(normal.plain / rows);
    const double dof = std::max(1.0, rows - static_cast<double>(x_.size()));
    const double per_dof = normal.weighted / dof;
    result.chi2_per_dof = declared_ ? per_dof : 1.0;
    const double factor = declared_ ? std::max(1.0, per_dof) : per_dof;
    const Eigen::MatrixXd covariance =
        factor * solveSymmetric(normal.matrix, Eigen::MatrixXd::Identity(x_.size(), x_.size()));
    const PlacedArm arm = placed();
    const Eigen::Isometry3d points_from_base = base_from_points_.inverse();
    for (std::size_t j = 0; j < start_.size(); ++j) {
      metrology::MeasuredLine seen;  // in the frame of the start, the base's motion in
      seen.line = {arm.base * arm.axes[j].point, arm.base.linear() * arm.axes[j].direction};
      metrology::basisAcross(seen.line.direction, seen.across_u, seen.across_v);
      Eigen::MatrixXd by = Eigen::MatrixXd::Zero(4, parameters_.targetsAt());
      const auto put = [&](Eigen::Index column, const Eigen::Vector3d& shift, const Eigen::Vector3d& rotation) {
        const Eigen::Vector3d tilt = rotation.cross(seen.line.direction);
        by.col(column) << seen.across_u.dot(shift), seen.across_v.dot(shift), seen.across_u.dot(tilt),
            seen.across_v.dot(tilt);
      };
      for (std::size_t k = 4 * j; k < 4 * j + 4; ++k) {
        const SmallMotion& own = arm.steps[k];
        put(static_cast<Eigen::Index>(k), arm.base.linear() * own.at(arm.axes[j].point),
            arm.base.linear() * own.rotation);
      }
      for (std::size_t k = 0; k < 6; ++k) {
        const SmallMotion motion = arm.byBase(k);
        put(parameters_.baseAt() + static_cast<Eigen::Index>(k), motion.at(seen.line.point), motion.rotation);
      }
      seen.covariance = propagated(by, covariance.topLeftCorner(parameters_.targetsAt(), parameters_.targetsAt()));
      seen.line = {points_from_base * seen.line.point, points_from_base.linear() * seen.line.direction};
      seen.across_u = points_from_base.linear() * seen.across_u;
      seen.across_v = points_from_base.linear() * seen.across_v;
      result.at_zero.push_back(seen);
    }
  }

  AxesAtStart start_;
  ArmParameters parameters_;
  SweepReadings readings_;  ///< points in the frame of the start
  Eigen::Isometry3d base_from_points_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Matrix3d> weights_;
  bool declared_ = false;  ///< whether the tracker's noise is
  Eigen::VectorXd x_;
  Eigen::MatrixXd prior_;
};

}  // namespace

CoupledAxes fitCoupledAxes(const campaign::Campaign& campaign, const RigidPoints& points) {
  CoupledAxes none;
  if (!campaign.circle_sweeps) {
    none.reason = Remark(RemarkId::no_circle_sweeps);
    return none;
  }
  Gatherer gatherer(campaign);
  gatherer.add(campaign.circle_sweeps->rows, points.circle_sweeps);
  if (campaign.wrist_sweep && campaign.wrist_sweep->frame == campaign.circle_sweeps->frame)
    gatherer.add(campaign.wrist_sweep->rows, points.wrist_sweep);
  SweepReadings readings = gatherer.all();
  const auto start = baseFromPostures(campaign.robot, readings.positions, campaign.targets.size());
  if (!start) {
    none.reason = Remark(RemarkId::coupled_axes_not_placed);
    return none;
  }
  if (start->open) {
    none.reason = Remark(RemarkId::coupled_flange_level);
    return none;
  }
  return CoupledFit(campaign.robot, std::move(readings), *start).run();
}

}  // namespace stiffscope::frames
