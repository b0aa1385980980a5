#include "core/planning/candidates.h"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/identification/load_case.h"
#include "core/identification/posture_stiffness.h"
#include "core/io/input_error.h"
#include "core/robot/wrench.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::planning {

namespace {

frames::LoadingGeometry geometryFor(const campaign::Campaign& campaign,
                                    const identification::Identification* identified) {
  const JointVector rigid = JointVector::Zero(campaign.robot.joints());
  if (identified == nullptr) return frames::sweptGeometry(campaign, frames::measureFrames(campaign), rigid);
  for (const identification::Method method :
       {identification::Method::decoupled_partial_pose, identification::Method::partial_pose,
        identification::Method::complete_pose}) {
    if (identified->of(method).available) return identified->of(method).geometry;
  }
  return frames::sweptGeometry(campaign, identified->frames, rigid);
}

/// Along the last axis, away from the one before: out of the flange.
Eigen::Vector3d outwardInFlange(const robot::Robot& arm) {
  const robot::ArmAxes& axes = arm.axes_in_base_at_zero;
  const metrology::Line& last = axes.back();
  const Eigen::Isometry3d& flange = arm.base_from_flange_at_zero;
  const double along = (flange.translation() - axes[axes.size() - 2].point).dot(last.direction);
  const Eigen::Vector3d outward = flange.linear().transpose() * last.direction;
  return along < 0.0 ? Eigen::Vector3d(-outward) : outward;
}

void placeTargets(const campaign::Campaign& campaign, PlanningArm& arm) {
  const Eigen::Isometry3d flange_from_zero = arm.geometry.arm.base_from_flange_at_zero.inverse();
  for (std::size_t k = 0; k < campaign.targets.size(); ++k) {
    if (k < arm.geometry.targets_at_zero.size() && arm.geometry.targets_at_zero[k]) {
      arm.targets_in_flange.push_back(flange_from_zero * *arm.geometry.targets_at_zero[k]);
    } else if (campaign.targets[k].position_in_flange) {
      arm.targets_in_flange.push_back(*campaign.targets[k].position_in_flange);
    }
  }
  if (!arm.targets_in_flange.empty() && arm.targets_in_flange.size() == campaign.targets.size()) return;
  arm.targets_in_flange.clear();
  constexpr double kRadius = 0.25, kAhead = 0.05;  // m
  const Eigen::Vector3d across = arm.outward_in_flange.unitOrthogonal();
  for (int k = 0; k < 3; ++k) {
    const Eigen::AngleAxisd turn(2.0 * std::numbers::pi * k / 3.0, arm.outward_in_flange);
    arm.targets_in_flange.push_back(kAhead * arm.outward_in_flange + kRadius * (turn * across));
  }
  arm.assumed.emplace_back(RemarkId::reflectors_on_ring, kRadius, kAhead);
}

/// The measured wrenches of the identified load step, in R0.
std::vector<std::pair<robot::ArmPosture, robot::Wrench>> measuredWrenches(const campaign::Campaign& campaign,
                                                                          const PlanningArm& arm, int step) {
  std::vector<std::pair<robot::ArmPosture, robot::Wrench>> wrenches;
  for (const campaign::State& state : campaign.states->rows) {
    if (state.step != step) continue;
    const robot::ArmPosture posture = robot::postureAt(arm.geometry.arm, arm.geometry.sagged(state.q));
    wrenches.emplace_back(posture,
                          identification::cellWrench(arm.cell, arm.geometry, posture, {}, {}, state.wrench_in_cell));
  }
  return wrenches;
}

/// The point of the flange on the measured forces' lines, by least squares of M = (hook - point) x F in
/// flange axes.
Eigen::Vector3d hookOf(const std::vector<std::pair<robot::ArmPosture, robot::Wrench>>& wrenches,
                       const robot::Robot& arm) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const auto& [posture, wrench] : wrenches) {
    const Eigen::Isometry3d flange_from_r0 = robot::flangeAt(arm, posture).inverse();
    const Eigen::Vector3d force = flange_from_r0.linear() * wrench.force;
    const robot::Wrench at_flange = wrench.about(flange_from_r0.inverse().translation());
    const Eigen::Vector3d moment = flange_from_r0.linear() * at_flange.moment;
    // hook x F = M: normal equations of -[F]x, whose square is |F|^2 I - F F^T.
    normal += force.squaredNorm() * Eigen::Matrix3d::Identity() - force * force.transpose();
    right += force.cross(moment);
  }
  // Forces within half a degree of one line of the flange leave the place along it open: nearest.
  constexpr double kOneLine = 1e-4;
  return leastSquaresSolution(normal, right, kOneLine);
}

void placeLoad(const campaign::Campaign& campaign, const identification::Identification* identified,
               const PlanningInputs& inputs, PlanningArm& arm) {
  arm.pull = inputs.pull.value_or(identified != nullptr && !identified->identifiability.load_hangs);
  std::vector<std::pair<robot::ArmPosture, robot::Wrench>> measured;
  if (identified != nullptr) measured = measuredWrenches(campaign, arm, identified->step);
  if (inputs.load) {
    arm.load = *inputs.load;
  } else if (!measured.empty()) {
    for (const auto& one : measured) arm.load += one.second.force.norm() / static_cast<double>(measured.size());
    arm.assumed.emplace_back(RemarkId::load_of_step, identified->step, arm.load);
  }
  if (!(arm.load > 0.0) || !std::isfinite(arm.load)) {
    throw io::InputError(
        {inputs.pull.value_or(false) ? "--pull" : "--load"}, inputs.load ? fmt::format("{:g}", *inputs.load) : "",
        inputs.load ? "expected the load in newtons, above 0"
                    : "expected the load in newtons, above 0: this campaign has no measured one to take");
  }
  if (inputs.hook_in_flange) {
    arm.hook_in_flange = *inputs.hook_in_flange;
  } else if (!measured.empty()) {
    arm.hook_in_flange = hookOf(measured, arm.geometry.arm);
    arm.assumed.emplace_back(RemarkId::load_where_measured,
                             std::vector<double>(arm.hook_in_flange.begin(), arm.hook_in_flange.end()));
  } else {
    const robot::ArmPosture zero = robot::postureAt(arm.geometry.arm, JointVector::Zero(arm.geometry.arm.joints()));
    const robot::Wrench at_cell = identification::cellWrench(arm.cell, arm.geometry, zero, {}, {}, Vector6d::Zero());
    arm.hook_in_flange = arm.geometry.arm.base_from_flange_at_zero.inverse() * at_cell.point;
    arm.assumed.emplace_back(RemarkId::load_at_cell, campaign.robot.joints());
  }
}

void placeTracker(const campaign::Campaign& campaign, const identification::Identification* identified,
                  const PlanningInputs& inputs, PlanningArm& arm) {
  const frames::Frames frames = identified != nullptr ? identified->frames : frames::measureFrames(campaign);
  if (inputs.tracker_in_base) {
    arm.station = arm.geometry.r0_from_base_link * *inputs.tracker_in_base;
  } else if (campaign.tracker && frames.arm.points_placed && frames.points_frame == campaign::PointFrame::tracker) {
    arm.station = frames.arm.r0_from_points * campaign.tracker->station;
  } else {
    arm.assumed.emplace_back(RemarkId::tracker_not_placed);
  }
  arm.sigma = inputs.tracker_sigma;
  if (campaign.tracker) {
    metrology::TrackerNoise noise = frames::trackerNoise(*campaign.tracker);
    constexpr double kUsual = 4.0;  // m, of a cell with a heavy robot
    arm.sigma = std::sqrt(noise.covarianceAt(noise.station + Eigen::Vector3d(kUsual, 0, 0)).trace() / 3.0);
    if (arm.station) noise.station = *arm.station, arm.noise = noise;
  }
  if (arm.sigma <= 0.0) arm.sigma = inputs.tracker_sigma, arm.noise.reset();
  if (!campaign.tracker) arm.assumed.emplace_back(RemarkId::noise_not_declared, arm.sigma);
}

}  // namespace

Eigen::Matrix3d PlanningArm::displacementCovariance(const Eigen::Vector3d& point) const {
  const Eigen::Matrix3d reading =
      noise ? noise->covarianceAt(point) : Eigen::Matrix3d(sigma * sigma * Eigen::Matrix3d::Identity());
  return 2.0 / repeats * reading + misfit * misfit * Eigen::Matrix3d::Identity();
}

PlanningArm planningArm(const campaign::Campaign& campaign, const identification::Identification* identified,
                        const PlanningInputs& inputs) {
  if (inputs.repeats < 1)
    throw io::InputError({"--repeats"}, std::to_string(inputs.repeats), "expected 1 or more readings");
  PlanningArm arm;
  arm.geometry = geometryFor(campaign, identified);
  arm.repeats = inputs.repeats;
  arm.joint_readings = campaign.joint_readings;
  arm.effects = inputs.effects;
  if (arm.effects) arm.assumed.emplace_back(RemarkId::effects_as_known_now);
  arm.outward_in_flange = outwardInFlange(arm.geometry.arm);
  if (campaign.load_cell) {
    arm.cell = *campaign.load_cell;
  } else {
    arm.cell.parent = campaign.flange_link;
    arm.assumed.emplace_back(RemarkId::cell_in_flange);
  }
  placeTargets(campaign, arm);
  placeLoad(campaign, identified, inputs, arm);
  placeTracker(campaign, identified, inputs, arm);
  if (identified != nullptr) {
    const identification::MethodResult& method = identified->of(identification::Method::partial_pose);
    // What the noise puts into the means of that day is in sigma, too; the day to come has noise of its own.
    const double noise = identified->noise ? identified->noise->per_coordinate : 0.0, left = method.estimate.sigma;
    if (method.available) arm.misfit = std::sqrt(std::max(0.0, left * left - noise * noise));
  }
  return arm;
}

PlanningArm unloadedPlanningArm(const campaign::Campaign& campaign, const PlanningInputs& inputs) {
  if (inputs.repeats < 1)
    throw io::InputError({"--repeats"}, std::to_string(inputs.repeats), "expected 1 or more readings");
  PlanningArm arm;
  arm.geometry.arm = campaign.robot;
  arm.repeats = inputs.repeats;
  arm.joint_readings = campaign.joint_readings;
  arm.pull = true;
  arm.outward_in_flange = outwardInFlange(campaign.robot);
  placeTargets(campaign, arm);
  arm.station = inputs.tracker_in_base;
  if (!arm.station) arm.assumed.emplace_back(RemarkId::tracker_not_placed);
  arm.sigma = inputs.tracker_sigma;
  if (!campaign.tracker) arm.assumed.emplace_back(RemarkId::noise_not_declared, arm.sigma);
  return arm;
}

namespace {

struct Skeleton {
  std::vector<Eigen::Vector3d> points;  // sampled every few centimetres
  std::size_t forearm = 0;              // the first point beyond the last axis before the wrist
};

Skeleton skeletonOf(const PlanningArm& arm, const robot::ArmPosture& posture) {
  std::vector<Eigen::Vector3d> corners{arm.geometry.r0_from_base_link.translation()};
  for (int axis = 0; axis < arm.geometry.arm.axes(); ++axis)
    corners.push_back(robot::axisAt(arm.geometry.arm, posture, axis).point);
  corners.push_back(robot::flangeAt(arm.geometry.arm, posture).translation());
  Skeleton skeleton;
  constexpr int kSamples = 20;
  const auto elbow = static_cast<std::size_t>(arm.geometry.arm.armAxes());
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    if (k == elbow) skeleton.forearm = skeleton.points.size();  // corners: base, axes 1, 2, 3, ...
    for (int s = 0; s <= kSamples; ++s) {
      const double t = static_cast<double>(s) / kSamples;
      skeleton.points.push_back((1.0 - t) * corners[k] + t * corners[k + 1]);
    }
  }
  return skeleton;
}

/// Distance of a point from the part of a line that starts at `from` and is `length` long; infinite beside
/// its ends.
double distanceFromLine(const Eigen::Vector3d& point, const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                        double length) {
  const double along = (point - from).dot(direction);
  if (along <= 0.0 || along >= length) return std::numeric_limits<double>::infinity();
  return (point - from - along * direction).norm();
}

double clearanceOfLine(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& from,
                       const Eigen::Vector3d& direction, double length) {
  double clearance = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : points) {
    clearance = std::min(clearance, distanceFromLine(point, from, direction, length));
  }
  return clearance;
}

bool nearBody(const Skeleton& skeleton, const Eigen::Vector3d& point, double clearance) {
  return std::any_of(skeleton.points.begin(), skeleton.points.begin() + static_cast<std::ptrdiff_t>(skeleton.forearm),
                     [&](const Eigen::Vector3d& own) { return (own - point).norm() < clearance; });
}

PostureRule brokenBySight(const PlanningArm& arm, const PostureRules& rules, const Skeleton& skeleton,
                          const std::vector<Eigen::Vector3d>& targets) {
  if (!arm.station) return PostureRule::none;
  for (const Eigen::Vector3d& target : targets) {
    const Eigen::Vector3d line = target - *arm.station;
    const double distance = line.norm();
    if (distance < rules.least_distance || distance > rules.most_distance) return PostureRule::distance;
    if (clearanceOfLine(skeleton.points, *arm.station, line / distance, distance) < rules.sight_clearance) {
      return PostureRule::sight;
    }
  }
  return PostureRule::none;
}

}  // namespace

const char* wordsFor(PostureRule rule) {
  switch (rule) {
    case PostureRule::none:
      break;
    case PostureRule::figures:
      return "what the controller states of a joint outside --min-deg or --max-deg";
    case PostureRule::follower:
      return "an axis that follows others outside its limits, or a balancer outside its stroke";
    case PostureRule::singularity:
      return "too near a singularity";
    case PostureRule::low:
      return "the arm, a reflector or the hook too low";
    case PostureRule::hanging:
      return "the flange pointing up, where a load does not hang free";
    case PostureRule::load_line:
      return "the arm in the way of the hanging load or of the cable";
    case PostureRule::body:
      return "the tool too near the arm";
    case PostureRule::distance:
      return "outside the tracker's reach";
    case PostureRule::sight:
      return "a reflector hidden from the tracker by the arm";
  }
  return "keeping all rules";
}

PostureRule brokenRule(const PlanningArm& arm, const PostureRules& rules, const robot::ArmPosture& posture,
                       const Eigen::Vector3d& direction) {
  const Eigen::Isometry3d flange = robot::flangeAt(arm.geometry.arm, posture);
  const Jacobian jacobian = robot::jacobianAt(arm.geometry.arm, posture, flange.translation());
  if (identification::postureConditioning(jacobian, 1.0).dexterity < rules.least_dexterity)
    return PostureRule::singularity;

  const Eigen::Isometry3d base_from_r0 = arm.geometry.r0_from_base_link.inverse();
  const Skeleton skeleton = skeletonOf(arm, posture);
  const Eigen::Vector3d hook = flange * arm.hook_in_flange;
  std::vector<Eigen::Vector3d> targets;
  for (const Eigen::Vector3d& target : arm.targets_in_flange) targets.push_back(flange * target);
  const auto lower = [&](const Eigen::Vector3d& point, double height) { return (base_from_r0 * point).z() < height; };
  if (!arm.pull && lower(hook, rules.least_hook_height)) return PostureRule::low;
  for (const Eigen::Vector3d& target : targets) {
    if (lower(target, rules.least_height)) return PostureRule::low;
  }
  for (std::size_t k = skeleton.forearm; k < skeleton.points.size(); ++k) {
    if (lower(skeleton.points[k], rules.least_height)) return PostureRule::low;
  }
  if (!arm.pull && -direction.dot(flange.linear() * arm.outward_in_flange) > std::sin(rules.most_outward_up)) {
    return PostureRule::hanging;
  }
  constexpr double kLine = 3.0;  // m of cable or chain
  const bool loaded = arm.load > 0.0;
  if (loaded && clearanceOfLine(skeleton.points, hook, direction, kLine) < rules.line_clearance)
    return PostureRule::load_line;
  if (loaded && nearBody(skeleton, hook, rules.body_clearance)) return PostureRule::body;
  for (const Eigen::Vector3d& target : targets) {
    if (nearBody(skeleton, target, rules.body_clearance)) return PostureRule::body;
  }
  return brokenBySight(arm, rules, skeleton, targets);
}

namespace {

/// Uniform in [low, high); 53 bits of one draw, so that a seed means the same everywhere.
double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
}

std::string whyNone(const CandidateDraw& draw) {
  std::string text = fmt::format("expected limits within which some posture keeps the rules; of {} drawn", draw.drawn);
  for (std::size_t rule = 1; rule < kPostureRules; ++rule) {
    if (draw.broken[rule] == 0) continue;
    text += fmt::format("; {}: {}", wordsFor(static_cast<PostureRule>(rule)), draw.broken[rule]);
  }
  return text;
}

}  // namespace

std::vector<Eigen::Vector3d> loadDirections(const PlanningArm& arm) {
  const Eigen::Vector3d& gravity = arm.geometry.weight.gravity_in_base;
  const Eigen::Matrix3d r0_from_base = arm.geometry.r0_from_base_link.linear();
  const Eigen::Vector3d down =
      gravity.norm() > 0.0 ? Eigen::Vector3d(gravity.normalized()) : Eigen::Vector3d(-r0_from_base.col(2));
  if (!arm.pull) return {down};
  std::vector<Eigen::Vector3d> directions{down};
  for (const int axis : {0, 1}) {
    for (const double sign : {1.0, -1.0}) {
      const Eigen::Vector3d level = sign * r0_from_base.col(axis);
      directions.push_back(level);
      directions.push_back((level + down).normalized());
    }
  }
  return directions;
}

Candidate candidateAt(const PlanningArm& arm, const JointVector& q, const Eigen::Vector3d& direction) {
  Candidate candidate(q, direction);
  identification::LoadCase& load_case = candidate.load_case;
  load_case.q = q;
  load_case.q_sagged = arm.geometry.sagged(q);
  const robot::ArmPosture posture = identification::unloadedPosture(arm.geometry.arm, load_case);
  load_case.axes = robot::axesAt(arm.geometry.arm, posture);
  const Eigen::Isometry3d flange = robot::flangeAt(arm.geometry.arm, posture);
  load_case.wrench = {flange * arm.hook_in_flange, arm.load * direction, Eigen::Vector3d::Zero()};
  const JointVector torque = robot::jointTorque(load_case.axes, load_case.wrench);
  Eigen::MatrixXd moves;
  if (arm.effects) moves = arm.effects.moves(q, load_case.wrench.force, arm.hook_in_flange, arm.targets_in_flange);
  Eigen::MatrixXd among = Eigen::MatrixXd::Identity(moves.cols(), moves.cols());  // I + E^T S^-1 E, S noise alone
  Eigen::MatrixXd across = Eigen::MatrixXd::Zero(moves.cols(), q.size());         // E^T S^-1 A
  for (std::size_t k = 0; k < arm.targets_in_flange.size(); ++k) {
    const Eigen::Vector3d point = flange * arm.targets_in_flange[k];
    const PointJacobian rows = identification::pointRows(load_case.axes, point, torque);
    const Eigen::LLT<Eigen::Matrix3d> noise(arm.displacementCovariance(point));
    const PointJacobian weighed = noise.solve(rows);
    candidate.information += rows.transpose() * weighed;
    if (moves.cols() == 0) continue;
    const Eigen::MatrixXd own = moves.middleRows<3>(static_cast<Eigen::Index>(3 * k));
    among += own.transpose() * noise.solve(own);
    across += own.transpose() * weighed;
  }
  // The inverse of S + E E^T by Woodbury.
  if (moves.cols() > 0) candidate.information -= across.transpose() * solvePositive(among, across);
  return candidate;
}

CandidateDraw drawCandidates(const PlanningArm& arm, const PostureRules& rules, int count, std::uint64_t seed) {
  const PostureLimits limits(arm.geometry.arm, arm.joint_readings, rules);
  const PerJoint<robot::JointLimits>& box = limits.box();
  const std::vector<Eigen::Vector3d> directions = loadDirections(arm);
  std::mt19937_64 random(seed);
  CandidateDraw draw;
  constexpr int kTriesEach = 400;
  while (static_cast<int>(draw.kept.size()) < count && draw.drawn < kTriesEach * count) {
    JointVector q(static_cast<Eigen::Index>(box.size()));
    for (std::size_t j = 0; j < box.size(); ++j)
      q[static_cast<Eigen::Index>(j)] = uniform(random, box[j].lower, box[j].upper);
    const Eigen::Vector3d& direction = directions[random() % directions.size()];
    ++draw.drawn;
    const PostureRule broken =
        !limits.hold(q) ? PostureRule::figures
        : !robot::withinAxisLimits(arm.geometry.arm, q)
            ? PostureRule::follower
            : brokenRule(arm, rules, robot::postureAt(arm.geometry.arm, arm.geometry.sagged(q)), direction);
    ++draw.broken[static_cast<std::size_t>(broken)];
    if (broken == PostureRule::none) draw.kept.push_back(candidateAt(arm, q, direction));
  }
  if (draw.kept.empty()) throw io::InputError({"plan"}, "", whyNone(draw));
  return draw;
}

Vector6d expectedReading(const PlanningArm& arm, const Candidate& candidate) {
  // Readings of unit size show the cell's axes and point.
  const robot::ArmPosture posture = identification::unloadedPosture(arm.geometry.arm, candidate.load_case);
  Eigen::Matrix3d axes;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const robot::Wrench unit =
        identification::cellWrench(arm.cell, arm.geometry, posture, {}, {}, Vector6d::Unit(axis));
    axes.col(axis) = unit.force;
    point = unit.point;
  }
  const robot::Wrench at_cell = candidate.load_case.wrench.about(point);
  return (Vector6d() << axes.transpose() * at_cell.force, axes.transpose() * at_cell.moment).finished();
}

}  // namespace stiffscope::planning
