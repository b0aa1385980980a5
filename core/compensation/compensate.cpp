#include "core/compensation/compensate.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/compensation/joint_correction.h"
#include "core/identification/load_case.h"
#include "core/io/units.h"
#include "core/numerics/parallel.h"
#include "core/robot/balancer.h"
#include "core/robot/inverse_kinematics.h"
#include "core/robot/wrench.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::compensation {

std::vector<Remark> implausibleCommands(const std::vector<CompensatedPosture>& postures) {
  constexpr double kMost = 2.0 * io::kDegree;
  std::vector<Remark> remarks;
  for (const CompensatedPosture& posture : postures) {
    if (!posture.solved) continue;
    Eigen::Index joint = 0;
    const double turn = (posture.commands - posture.posture.q).cwiseAbs().maxCoeff(&joint);
    if (turn <= kMost) continue;
    remarks.emplace_back(RemarkId::implausible_command, posture.posture.id, joint + 1, turn);
  }
  return remarks;
}

std::vector<Remark> jointCountRemarks(const std::vector<CompensatedPosture>& postures) {
  const auto solved = std::find_if(postures.begin(), postures.end(), [](const auto& one) { return one.solved; });
  if (solved == postures.end() || solved->commands.size() == 6) return {};
  const Eigen::Index joints = solved->commands.size();
  return {Remark(joints < 6 ? RemarkId::position_first : RemarkId::least_turns, joints)};
}

namespace {

/// The flange unloaded and loaded.
struct Moved {
  Eigen::Isometry3d unloaded, loaded;
};

/// Of the estimate's own covariance, or of that of an arm with effects.
DeflectionDraws drawsOf(const identification::StiffnessEstimate& estimate, const effects::EffectDeflection* with) {
  if (with == nullptr) return springDraws(estimate, identification::coveringCovariance(estimate));
  identification::StiffnessEstimate springs = estimate;
  springs.covariance = with->spring_covariance;
  return springDraws(springs, identification::coveringCovariance(springs), 0.0,
                     static_cast<Eigen::Index>(with->varied.size()));
}

class Compensator {
 public:
  Compensator(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
              const identification::StiffnessEstimate& estimate, const Eigen::Vector3d& tcp_in_flange,
              const CompensateOptions& options, const effects::EffectDeflection* with, const Certainty* certainty)
      : campaign_(campaign),
        geometry_(geometry),
        estimate_(estimate),
        tcp_(tcp_in_flange),
        options_(options),
        with_(with),
        range_(certainty ? &certainty->range : nullptr),
        own_draws_(certainty ? DeflectionDraws() : drawsOf(estimate, with)),
        draws_(certainty ? certainty->draws : own_draws_),
        drawn_(sideBySide(draws_)) {}

  CompensatedPosture run(const PostureToCompensate& asked) const {
    CompensatedPosture result;
    result.posture = asked;
    result.commands = JointVector::Zero(asked.q.size());
    const auto unloaded_angles = effects::loadedAngles(geometry_, estimate_.compliance, asked.q, effects::FlangeLoad());
    if (!unloaded_angles) {
      result.reason = Remark(RemarkId::unloaded_arm_does_not_rest);
      return result;
    }
    const robot::ArmPosture unloaded = robot::postureAt(geometry_.arm, *unloaded_angles);
    const auto resting = loadedFlange(asked.q, unloaded, effects::FlangeLoad());
    if (!resting) {
      result.reason = Remark(RemarkId::unloaded_arm_does_not_rest);
      return result;
    }
    const Eigen::Isometry3d wanted = *resting;
    const effects::FlangeLoad load = asked.load ? *asked.load : loadByReading(asked, unloaded, wanted);
    predict(unloaded, wanted, load, result);
    if (!result.predicted) return result;
    addCautions(unloaded, wanted, load, result);
    result.reason = refusal(unloaded, wanted, load, result);
    if (result.reason.empty()) solve(asked, *unloaded_angles, wanted, load, result);
    return result;
  }

 private:
  /// The load that makes the cell read this: its axes stand as the loaded flange does, as in identification, and by how
  /// much that turns the load itself says.
  effects::FlangeLoad loadByReading(const PostureToCompensate& asked, const robot::ArmPosture& unloaded,
                                    const Eigen::Isometry3d& resting) const {
    const auto at = [&](const Eigen::Isometry3d& loaded) -> effects::FlangeLoad {
      const robot::Wrench wrench =
          identification::cellWrench(*campaign_.load_cell, geometry_, unloaded, resting, loaded, asked.wrench_in_cell);
      return {resting.inverse() * wrench.point, wrench.force, wrench.moment};
    };
    effects::FlangeLoad load = at(resting);
    if (identification::bodyOfCellAxes(*campaign_.load_cell, geometry_) != geometry_.arm.axes()) return load;
    // Each round is nearer by the flange's turn, some thousandths.
    constexpr int kMost = 4;
    constexpr double kSettled = 1e-10;  // of the force
    for (int round = 0; round < kMost; ++round) {
      const auto bent = loadedPosture(asked.q, load);
      const auto flange = bent ? loadedFlange(asked.q, *bent, load) : std::nullopt;
      if (!flange) break;
      const Eigen::Vector3d before = load.force;
      load = at(*flange);
      if ((load.force - before).norm() <= kSettled * before.norm()) break;
    }
    return load;
  }

  JointVector torqueOf(const robot::ArmPosture& posture, const Eigen::Isometry3d& flange,
                       const effects::FlangeLoad& load) const {
    return robot::jointTorque(geometry_.arm, posture, {flange * load.point_in_flange, load.force, load.moment});
  }

  /// Where the loaded arm stands with these commands; empty where it does not come to rest.
  std::optional<robot::ArmPosture> loadedPosture(const JointVector& commands, const effects::FlangeLoad& load) const {
    const auto angles = effects::loadedAngles(geometry_, estimate_.compliance, commands, load);
    return angles ? std::optional<robot::ArmPosture>(robot::postureAt(geometry_.arm, *angles)) : std::nullopt;
  }

  /// Where the flange of the loaded arm stands with these commands, `posture` the one of its springs alone.
  std::optional<Eigen::Isometry3d> loadedFlange(const JointVector& commands, const robot::ArmPosture& posture,
                                                const effects::FlangeLoad& load) const {
    return with_ ? with_->flange(commands, load) : robot::flangeAt(geometry_.arm, posture);
  }

  Remark refusal(const robot::ArmPosture& unloaded, const Eigen::Isometry3d& wanted, const effects::FlangeLoad& load,
                 const CompensatedPosture& found) const {
    const Remark outside = outsideLimits(found.posture.q, RemarkId::posture_outside_limits);
    if (!outside.empty()) return outside;
    if (found.conditioning < options_.least_conditioning)
      return Remark(RemarkId::near_singularity, found.conditioning, options_.least_conditioning);
    const Remark unusable = turnsUnusableJoint(torqueOf(unloaded, wanted, load));
    return unusable.empty() ? beyondTheDay(found) : unusable;
  }

  /// The reason to refuse where the day says too little of such a load in such a posture.
  Remark beyondTheDay(const CompensatedPosture& found) const {
    if (range_ == nullptr) return {};
    if (found.load_ratio > options_.load_most)
      return Remark(RemarkId::load_far_beyond, found.load_ratio, options_.load_most);
    for (int joint = turnsFreely(geometry_, 0) ? 1 : 0; joint < geometry_.arm.joints(); ++joint) {
      if (beyondAngles(found.posture.q, joint) > options_.posture_most)
        return Remark(RemarkId::posture_far_beyond, joint + 1, found.posture.q[joint], range_->low[joint],
                      range_->high[joint], options_.posture_most);
    }
    const double size = found.tcp.deflection.norm();
    if (!std::isfinite(found.tcp.expanded)) return Remark(RemarkId::uncertainty_unknown);
    const bool negligible = found.tcp.expanded <= options_.negligible;
    if (!negligible && !(found.tcp.expanded <= options_.uncertain_most * size))
      return Remark(RemarkId::uncertain_as_itself, found.tcp.expanded, size);
    return {};
  }

  void addCautions(const robot::ArmPosture& unloaded, const Eigen::Isometry3d& wanted, const effects::FlangeLoad& load,
                   CompensatedPosture& result) const {
    if (range_ == nullptr) return;
    const robot::ArmAxes axes = robot::axesAt(geometry_.arm, unloaded);
    result.load_ratio = loadRatio(*range_, {wanted * load.point_in_flange, load.force, load.moment}, axes);
    if (result.load_ratio > options_.load_caution)
      result.cautions.emplace_back(RemarkId::load_beyond, result.load_ratio);
    const JointVector torque = torqueOf(unloaded, wanted, load);
    const PointJacobian rows = robot::pointJacobianAt(axes, wanted * tcp_);
    const double size = result.tcp.deflection.norm();
    for (int joint = 0; joint < geometry_.arm.joints(); ++joint) {
      const bool any_angle_serves = joint == 0 && turnsFreely(geometry_, 0);
      if (!any_angle_serves && beyondAngles(result.posture.q, joint) > options_.posture_caution)
        result.cautions.emplace_back(RemarkId::posture_beyond, joint + 1, result.posture.q[joint], range_->low[joint],
                                     range_->high[joint]);
      // A joint that the day cannot see has its stiffness, if any, from elsewhere; one that moves little may be wrong.
      constexpr double kMovesLittle = 0.2;
      const double largest = range_->torque[joint], part = std::abs(torque[joint] * estimate_.compliance[joint]);
      const bool seen = largest > options_.share_unknown * range_->torque.maxCoeff();
      if (seen && std::abs(torque[joint]) > options_.load_caution * largest &&
          part * rows.col(joint).norm() > kMovesLittle * size)
        result.cautions.emplace_back(RemarkId::torque_beyond, joint + 1, std::abs(torque[joint]), largest);
    }
    if (result.tcp.expanded > options_.negligible && result.tcp.expanded > options_.uncertain_caution * size)
      result.cautions.emplace_back(RemarkId::uncertain, result.tcp.expanded, size);
  }

  /// How far a joint stands outside the angles that identified, rad; whole turns do not count.
  double beyondAngles(const JointVector& q, int joint) const {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    const double low = range_->low[joint], high = range_->high[joint];
    const double past = std::remainder(q[joint] - 0.5 * (low + high), kTurn);
    return std::max(0.0, std::abs(past) - 0.5 * (high - low));
  }

  /// The reason to refuse where the load turns a joint of unknown stiffness, which counts as rigid here, or
  /// of a negative one, by which the commands would go the wrong way.
  Remark turnsUnusableJoint(const JointVector& torque) const {
    for (int joint = 0; joint < geometry_.arm.joints(); ++joint) {
      const bool known = estimate_.identifiable[static_cast<std::size_t>(joint)];
      if (known && estimate_.compliance[joint] >= 0.0) continue;
      if (std::abs(torque[joint]) <= options_.share_unknown * torque.cwiseAbs().maxCoeff()) continue;
      return Remark(known ? RemarkId::turns_joint_of_negative_k : RemarkId::turns_joint_of_unknown_k, joint + 1,
                    std::abs(torque[joint]));
    }
    return {};
  }

  /// A draw in a row, as `factorsOf` takes it, but for the parameters of effects: compliances, error of the load,
  /// whether it is of springs alone, model error.
  static Eigen::MatrixXd sideBySide(const DeflectionDraws& draws) {
    const Eigen::Index joints = draws.compliance.rows();
    Eigen::MatrixXd drawn = Eigen::MatrixXd::Zero(draws.size(), joints + 5);
    drawn.leftCols(joints) = draws.compliance.transpose();
    drawn.col(joints) = draws.load;
    drawn.col(joints + 1).tail(draws.springs_alone).setOnes();
    drawn.rightCols<3>() = draws.model_error.transpose();
    return drawn;
  }

  /// What a draw (sideBySide) makes of the errors of three coordinates, a column each. `rows`: of the joints,
  /// J diag(tau); `left`: model error of each, m (or rad).
  static Eigen::MatrixX3d factorsOf(const PointJacobian& rows, const Eigen::Vector3d& predicted, double left) {
    Eigen::MatrixX3d factors(rows.cols() + 5, 3);
    factors << rows.transpose(), predicted.transpose(), -predicted.transpose(), left * Eigen::Matrix3d::Identity();
    return factors;
  }

  static PointDeflection deflectionOf(const Eigen::Vector3d& deflection,
                                      const Eigen::Ref<const Eigen::MatrixX3d>& errors) {
    const PredictionSpread spread = spreadOf(errors);
    PointDeflection point{deflection, spread.sd, spread.interval, spread.expanded};
    for (int k = 0; k < 3; ++k) {
      identification::CoverageInterval& interval = point.interval[static_cast<std::size_t>(k)];
      interval = {interval.low + deflection[k], interval.high + deflection[k]};
    }
    return point;
  }

  /// The flange of the arm with what is uncertain moved; as it is where that does not come to rest.
  std::vector<Moved> variedBy(const JointVector& q, const effects::FlangeLoad& load, const Moved& as_it_is) const {
    std::vector<Moved> moved;
    for (const effects::RestingFlange& flange : with_->varied) {
      const auto unloaded = flange(q, effects::FlangeLoad()), loaded = flange(q, load);
      moved.push_back(unloaded && loaded ? Moved{*unloaded, *loaded} : as_it_is);
    }
    return moved;
  }

  /// What a unit of each uncertain parameter changes: of the deflection of the points (fixed to the flange, which
  /// stands at `flange.unloaded`), three rows each, and of the flange's rotation.
  Eigen::MatrixXd byParameters(const JointVector& q, const effects::FlangeLoad& load, const Moved& flange,
                               const std::vector<Eigen::Vector3d>& points) const {
    const auto count = static_cast<Eigen::Index>(points.size());
    Eigen::MatrixXd by = Eigen::MatrixXd::Zero(3 * count + 3, draws_.parameters.rows());
    if (by.cols() == 0) return by;
    if (draws_.by) {
      std::vector<Eigen::Vector3d> places;
      for (const Eigen::Vector3d& point : points) places.push_back(flange.unloaded * point);
      for (int k = 0; k < 3; ++k) places.push_back(places.front() + Eigen::Vector3d::Unit(k));
      const Eigen::MatrixXd moves = draws_.by(q, load, places);
      by.topRows(3 * count) = moves.topRows(3 * count);
      // A small turn moves the points one metre off along the axes by its cross product.
      for (Eigen::Index c = 0; c < by.cols(); ++c) {
        for (int k = 0; k < 3; ++k) {
          const Eigen::Vector3d off = moves.col(c).segment<3>(3 * (count + k)) - moves.col(c).head<3>();
          by.col(c).tail<3>() += 0.5 * Eigen::Vector3d::Unit(k).cross(off);
        }
      }
      return by;
    }
    const std::vector<Moved> varied = variedBy(q, load, flange);
    for (std::size_t v = 0; v < varied.size(); ++v) {
      const auto c = static_cast<Eigen::Index>(v);
      for (Eigen::Index p = 0; p < count; ++p) {
        const Eigen::Vector3d& point = points[static_cast<std::size_t>(p)];
        by.col(c).segment<3>(3 * p) = moveOf(varied[v], point) - moveOf(flange, point);
      }
      by.col(c).tail<3>() = turnOf(varied[v]) - turnOf(flange);
    }
    return by;
  }

  static Eigen::Vector3d moveOf(const Moved& flange, const Eigen::Vector3d& point_in_flange) {
    return flange.loaded * point_in_flange - flange.unloaded * point_in_flange;
  }
  static Eigen::Vector3d turnOf(const Moved& flange) {
    return robot::rotationVector(flange.loaded.linear() * flange.unloaded.linear().transpose());
  }

  void predict(const robot::ArmPosture& unloaded, const Eigen::Isometry3d& wanted, const effects::FlangeLoad& load,
               CompensatedPosture& result) const {
    const auto posture = loadedPosture(result.posture.q, load);
    const auto resting = posture ? loadedFlange(result.posture.q, *posture, load) : std::nullopt;
    if (!resting) {
      result.reason = Remark(RemarkId::loaded_arm_does_not_rest);
      return;
    }
    result.predicted = true;
    const Moved flange{wanted, *resting};
    const JointVector torque = torqueOf(unloaded, wanted, load);
    std::vector<Eigen::Vector3d> points{tcp_};
    const auto& places = geometry_.targets_at_zero;
    if (std::all_of(places.begin(), places.end(), [](const auto& place) { return place.has_value(); })) {
      const Eigen::Isometry3d flange_from_zero = geometry_.arm.base_from_flange_at_zero.inverse();
      for (const auto& place : places) points.push_back(flange_from_zero * *place);
    }
    const Eigen::MatrixXd by = byParameters(result.posture.q, load, flange, points);
    const robot::ArmAxes axes = robot::axesAt(geometry_.arm, unloaded);
    const double left = range_ ? range_->model_error *
                                     loadRatio(*range_, {wanted * load.point_in_flange, load.force, load.moment}, axes)
                               : 0.0;
    const Jacobian jacobian = robot::jacobianAt(geometry_.arm, unloaded, wanted * tcp_);
    result.rotation = turnOf(flange);
    const double turn_left = range_ && range_->tool_size > 0.0 ? left / range_->tool_size : 0.0;
    // The errors of all coordinates by one product.
    const auto count = static_cast<Eigen::Index>(points.size());
    Eigen::MatrixXd factors(drawn_.cols(), 3 * count + 3);
    for (Eigen::Index p = 0; p < count; ++p) {
      const Eigen::Vector3d& point = points[static_cast<std::size_t>(p)];
      const PointJacobian rows = robot::pointJacobianAt(axes, wanted * point) * torque.asDiagonal();
      factors.middleCols<3>(3 * p) = factorsOf(rows, moveOf(flange, point), left);
    }
    factors.rightCols<3>() = factorsOf(jacobian.bottomRows<3>() * torque.asDiagonal(), result.rotation, turn_left);
    Eigen::MatrixXd errors = drawn_ * factors;
    if (by.cols() > 0) draws_.addByParameters(by, errors);
    for (Eigen::Index p = 0; p < count; ++p) {
      const PointDeflection point =
          deflectionOf(moveOf(flange, points[static_cast<std::size_t>(p)]), errors.middleCols<3>(3 * p));
      if (p == 0) {
        result.tcp = point;
      } else {
        result.targets.push_back(point);
      }
    }
    result.rotation_sd =
        (errors.rightCols<3>().colwise().squaredNorm() / static_cast<double>(errors.rows())).cwiseSqrt().transpose();
    result.conditioning = stepConditioning(axes, wanted * tcp_);
  }

  void solve(const PostureToCompensate& asked, const JointVector& unloaded_angles, const Eigen::Isometry3d& wanted,
             const effects::FlangeLoad& load, CompensatedPosture& result) const {
    const auto once = effects::loadedAngles(geometry_, estimate_.compliance, asked.q, load);
    JointVector commands = asked.q - (*once - unloaded_angles);  // the predicted turn, mirrored: the first try
    constexpr int kMostSteps = 20;
    constexpr double kThere = 1e-9;  // m and rad
    for (int step = 0; step < kMostSteps; ++step) {
      const auto posture = loadedPosture(commands, load);
      const auto resting = posture ? loadedFlange(commands, *posture, load) : std::nullopt;
      if (!resting) {
        result.reason = Remark(RemarkId::loaded_arm_does_not_rest);
        return;
      }
      const Eigen::Isometry3d& flange = *resting;
      Vector6d error;
      error << wanted * tcp_ - flange * tcp_, robot::rotationVector(wanted.linear() * flange.linear().transpose());
      result.remaining = error.head<3>().norm();
      if (step == 0) result.mirrored_remaining = result.remaining;
      const bool whole = commands.size() >= 6;
      const auto next = [&] {
        return jointStep(robot::jacobianAt(geometry_.arm, *posture, flange * tcp_), error, commands - asked.q);
      };
      // Fewer joints are where they should be when the position is right and a step brings the orientation no nearer.
      const bool there = whole
                             ? error.cwiseAbs().maxCoeff() < kThere
                             : error.head<3>().cwiseAbs().maxCoeff() < kThere && next().cwiseAbs().maxCoeff() < kThere;
      if (there) {
        finish(commands, whole ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : Eigen::Vector3d(-error.tail<3>()), result);
        return;
      }
      commands += next();
    }
    result.reason = Remark(RemarkId::steps_do_not_converge);
  }

  void finish(const JointVector& commands, const Eigen::Vector3d& turn_left, CompensatedPosture& result) const {
    result.commands = commands;
    result.remaining_turn = turn_left;
    result.reason = outsideLimits(commands, RemarkId::command_outside_limits);
    result.solved = result.reason.empty();
    if (result.solved && turn_left.norm() > options_.negligible_turn)
      result.cautions.emplace_back(RemarkId::turn_left, turn_left.norm(), turn_left.x(), turn_left.y(), turn_left.z());
  }

  Remark outsideLimits(const JointVector& angles, RemarkId what) const {
    for (int joint = 0; joint < geometry_.arm.joints(); ++joint) {
      const robot::JointLimits& limits = geometry_.arm.limits[static_cast<std::size_t>(joint)];
      if (angles[joint] < limits.lower || angles[joint] > limits.upper)
        return Remark(what, joint + 1, angles[joint], limits.lower, limits.upper);
    }
    const robot::Robot& arm = geometry_.arm;
    if (robot::withinAxisLimits(arm, angles)) return {};
    const JointVector turned = arm.axes_in_base_at_zero.angles(angles);
    for (std::size_t axis = 0; arm.coupled() && axis < arm.axis_limits.size(); ++axis) {
      const robot::JointLimits& limits = arm.axis_limits[axis];
      const double angle = turned[static_cast<Eigen::Index>(axis)];
      if (angle < limits.lower || angle > limits.upper)
        return Remark(RemarkId::follower_outside_limits, arm.axis_names[axis], angle, limits.lower, limits.upper);
    }
    const robot::ArmPosture posture = robot::postureAt(arm, angles);
    for (std::size_t i = 0; i < arm.balancers.size(); ++i) {
      const double length = robot::lengthAt(arm.balancers[i], posture);
      if (!robot::withinStroke(arm.balancers[i], length))
        return Remark(RemarkId::balancer_outside_stroke, static_cast<int>(i) + 1, length);
    }
    return {};
  }

  const campaign::Campaign& campaign_;
  const frames::LoadingGeometry& geometry_;
  const identification::StiffnessEstimate& estimate_;
  Eigen::Vector3d tcp_;
  CompensateOptions options_;
  const effects::EffectDeflection* with_;
  const IdentifiedRange* range_;  ///< null: not known
  DeflectionDraws own_draws_;     ///< where none are given
  const DeflectionDraws& draws_;
  Eigen::MatrixXd drawn_;  ///< of them, a draw each row (sideBySide)
};

}  // namespace

std::vector<CompensatedPosture> compensate(const campaign::Campaign& campaign, const frames::LoadingGeometry& geometry,
                                           const identification::StiffnessEstimate& estimate,
                                           const Eigen::Vector3d& tcp_in_flange,
                                           const std::vector<PostureToCompensate>& postures,
                                           const CompensateOptions& options, const effects::EffectDeflection* with,
                                           const Certainty* certainty) {
  const Compensator compensator(campaign, geometry, estimate, tcp_in_flange, options, with, certainty);
  std::vector<CompensatedPosture> results(postures.size());
  numerics::onAllCores(postures.size(), [&](std::size_t i) { results[i] = compensator.run(postures[i]); });
  return results;
}

bool turnsFreely(const frames::LoadingGeometry& geometry, int joint) {
  constexpr double kUpright = 0.087;  // rad, 5 deg
  const Eigen::Vector3d& axis = geometry.arm.axes_in_base_at_zero[static_cast<std::size_t>(joint)].direction;
  const Eigen::Vector3d& gravity = geometry.weight.gravity_in_base;
  return axis.cross(gravity).norm() <= std::sin(kUpright) * gravity.norm();
}

std::optional<Eigen::Isometry3d> restingFlange(const frames::LoadingGeometry& geometry,
                                               const identification::StiffnessEstimate& estimate,
                                               const effects::EffectDeflection* with, const JointVector& commands) {
  if (with != nullptr) return with->flange(commands, effects::FlangeLoad());
  const auto angles = effects::loadedAngles(geometry, estimate.compliance, commands, effects::FlangeLoad());
  if (!angles) return std::nullopt;
  return robot::flangeAt(geometry.arm, robot::postureAt(geometry.arm, *angles));
}

Certainty certaintyOf(const identification::Identification& result, identification::Method method, double load_sd) {
  const identification::StiffnessEstimate& estimate = result.of(method).estimate;
  return {springDraws(estimate, identification::coveringCovariance(estimate), load_sd),
          identifiedRange(result, method)};
}

Certainty certaintyOf(const extended_model::ExtendedModel& model, identification::Method method, double load_sd) {
  return {modelDraws(model, method, load_sd), identifiedRange(model.with, method)};
}

CompensationSummary summaryOf(const std::vector<CompensatedPosture>& postures) {
  CompensationSummary summary;
  summary.asked = postures.size();
  for (const CompensatedPosture& posture : postures) {
    if (posture.solved) {
      ++summary.compensated;
      summary.cautioned += !posture.cautions.empty();
      continue;
    }
    const auto same = std::find_if(summary.refused.begin(), summary.refused.end(), [&](const auto& one) {
      return one.first.family == posture.reason.family && one.first.id == posture.reason.id;
    });
    if (same == summary.refused.end()) {
      summary.refused.emplace_back(posture.reason, 1);
    } else {
      ++same->second;
    }
  }
  std::stable_sort(summary.refused.begin(), summary.refused.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return summary;
}

}  // namespace stiffscope::compensation
