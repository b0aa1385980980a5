#include "core/planning/planning_arm.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "core/identification/load_case.h"
#include "core/io/input_error.h"

namespace stiffscope::planning {

namespace {

frames::LoadingGeometry geometryFor(const campaign::Campaign& campaign, const identification::Identification* identified) {
  if (identified == nullptr) return frames::sweptGeometry(campaign, frames::measureFrames(campaign), Vector6d::Zero());
  for (const identification::Method method : {identification::Method::decoupled_partial_pose, identification::Method::partial_pose, identification::Method::complete_pose}) {
    if (identified->of(method).available) return identified->of(method).geometry;
  }
  return frames::sweptGeometry(campaign, identified->frames, Vector6d::Zero());
}

/// Along axis 6, away from axis 5: out of the flange.
Eigen::Vector3d outwardInFlange(const robot::Robot& arm) {
  const metrology::Line& last = arm.axes_in_base_at_zero[5];
  const Eigen::Isometry3d& flange = arm.base_from_flange_at_zero;
  const double along = (flange.translation() - arm.axes_in_base_at_zero[4].point).dot(last.direction);
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
  arm.assumed.push_back(
      "three reflectors on a ring of 250 mm radius, 50 mm ahead of the flange: the campaign gives no "
      "x_mm, y_mm, z_mm of its targets and no sweep places them");
}

/// The measured wrenches of the identified load step, in R0.
std::vector<std::pair<robot::ArmPosture, robot::Wrench>> measuredWrenches(const campaign::Campaign& campaign, const PlanningArm& arm,
                                                            int step) {
  std::vector<std::pair<robot::ArmPosture, robot::Wrench>> wrenches;
  for (const campaign::State& state : campaign.states->rows) {
    if (state.step != step) continue;
    const robot::ArmPosture posture = robot::postureAt(arm.geometry.arm, arm.geometry.sagged(state.q));
    wrenches.emplace_back(posture, identification::cellWrench(arm.cell, arm.geometry, posture, {}, {}, state.wrench_in_cell));
  }
  return wrenches;
}

/// The point of the flange on the measured forces' lines, by least squares of M = (hook - point) x F in
/// flange axes.
Eigen::Vector3d hookOf(const std::vector<std::pair<robot::ArmPosture, robot::Wrench>>& wrenches, const robot::Robot& arm) {
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
  Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d> solver;
  solver.setThreshold(
      1e-4);  // forces within half a degree of one line of the flange leave the place along it open: nearest
  solver.compute(normal);
  return solver.solve(right);
}

void placeLoad(const campaign::Campaign& campaign, const identification::Identification* identified, const PlanningInputs& inputs,
               PlanningArm& arm) {
  arm.pull = inputs.pull.value_or(identified != nullptr && !identified->identifiability.load_hangs);
  std::vector<std::pair<robot::ArmPosture, robot::Wrench>> measured;
  if (identified != nullptr) measured = measuredWrenches(campaign, arm, identified->step);
  if (inputs.load) {
    arm.load = *inputs.load;
  } else if (!measured.empty()) {
    for (const auto& one : measured)
      arm.load += one.second.force.norm() / static_cast<double>(measured.size());
    arm.assumed.push_back(
        fmt::format("the load of the measured step {}: {:.0f} N", identified->step, arm.load));
  }
  if (!(arm.load > 0.0) || !std::isfinite(arm.load)) {
    throw io::InputError({inputs.pull.value_or(false) ? "--pull" : "--load"},
                     inputs.load ? fmt::format("{:g}", *inputs.load) : "",
                     inputs.load ? "expected the load in newtons, above 0"
                                 : "expected the load in newtons, above 0: this campaign has no measured one to take");
  }
  if (inputs.hook_in_flange) {
    arm.hook_in_flange = *inputs.hook_in_flange;
  } else if (!measured.empty()) {
    arm.hook_in_flange = hookOf(measured, arm.geometry.arm);
    const Eigen::Vector3d mm = 1e3 * arm.hook_in_flange;
    arm.assumed.push_back(
        fmt::format("the load acts at {:.0f} {:.0f} {:.0f} mm on the flange, where the measured "
                    "wrenches have it",
                    mm.x(), mm.y(), mm.z()));
  } else {
    const robot::ArmPosture zero = robot::postureAt(arm.geometry.arm, Vector6d::Zero());
    const robot::Wrench at_cell = identification::cellWrench(arm.cell, arm.geometry, zero, {}, {}, Vector6d::Zero());
    arm.hook_in_flange = arm.geometry.arm.base_from_flange_at_zero.inverse() * at_cell.point;
    arm.assumed.push_back(
        "the load acts at the load cell's point: --hook says where it does, and a hook aside of axis 6 "
        "is what turns joint 6");
  }
}

void placeTracker(const campaign::Campaign& campaign, const identification::Identification* identified, const PlanningInputs& inputs,
                  PlanningArm& arm) {
  const frames::Frames frames = identified != nullptr ? identified->frames : frames::measureFrames(campaign);
  if (inputs.tracker_in_base) {
    arm.station = arm.geometry.r0_from_base_link * *inputs.tracker_in_base;
  } else if (campaign.tracker && frames.arm.points_placed && frames.points_frame == campaign::PointFrame::tracker) {
    arm.station = frames.arm.r0_from_points * campaign.tracker->station;
  } else {
    arm.assumed.push_back(
        "no line of sight is looked at, and noise is the same everywhere: where the tracker will stand "
        "is not known (--tracker)");
  }
  arm.sigma = inputs.tracker_sigma;
  if (campaign.tracker) {
    metrology::TrackerNoise noise = frames::trackerNoise(*campaign.tracker);
    constexpr double kUsual = 4.0;  // m, of a cell with a heavy robot
    arm.sigma = std::sqrt(noise.covarianceAt(noise.station + Eigen::Vector3d(kUsual, 0, 0)).trace() / 3.0);
    if (arm.station) noise.station = *arm.station, arm.noise = noise;
  }
  if (arm.sigma <= 0.0) arm.sigma = inputs.tracker_sigma, arm.noise.reset();
  if (!campaign.tracker) {
    arm.assumed.push_back(fmt::format(
        "{:.0f} um of noise in each coordinate of a reading: no tracker is declared", 1e6 * arm.sigma));
  }
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
  arm.outward_in_flange = outwardInFlange(arm.geometry.arm);
  if (campaign.load_cell) {
    arm.cell = *campaign.load_cell;
  } else {
    arm.cell.parent = campaign.flange_link;
    arm.assumed.push_back("a load cell in the flange, its axes the flange's: none is declared");
  }
  placeTargets(campaign, arm);
  placeLoad(campaign, identified, inputs, arm);
  placeTracker(campaign, identified, inputs, arm);
  if (identified != nullptr) {
    const identification::MethodResult& method = identified->of(identification::Method::partial_pose);
    if (method.available) arm.misfit = method.estimate.sigma;
  }
  return arm;
}

}  // namespace stiffscope::planning
