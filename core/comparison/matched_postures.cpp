#include "core/comparison/matched_postures.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/robot/balancer.h"

namespace stiffscope::comparison {

namespace {

constexpr double kSameMass = 1e-3;  // of all links together

using CaseByPose = std::unordered_map<std::string, std::size_t>;

const std::string& poseOf(const campaign::Campaign& campaign, const identification::LoadCase& load_case) {
  return campaign.pose_ids[static_cast<std::size_t>(load_case.pose)];
}

CaseByPose casesOf(const campaign::Campaign& campaign, const identification::Identification& result) {
  CaseByPose places;
  for (std::size_t i = 0; i < result.cases.size(); ++i) places[poseOf(campaign, result.cases[i])] = i;
  return places;
}

/// Why a posture is not among the load cases of a campaign.
Remark whyAbsent(const campaign::Campaign& campaign, const identification::Identification& result,
                 const std::string& pose, When when) {
  for (const identification::LeftOutPosture& one : result.left_out) {
    if (one.pose == pose) return Remark(RemarkId::left_out, when, one.reason);
  }
  const auto& ids = campaign.pose_ids;
  return std::find(ids.begin(), ids.end(), pose) == ids.end() ? Remark(RemarkId::not_measured, when)
                                                              : Remark(RemarkId::no_load_state, when, result.step);
}

/// Why two load cases of one pose id are not the same; empty where they are.
Remark difference(const JointVector& q_before, const Eigen::Vector3d& force, const JointVector& q_after,
                  const Eigen::Vector3d& other, const MatchLimits& limits) {
  Eigen::Index joint = 0;
  const double angle = (q_after - q_before).cwiseAbs().maxCoeff(&joint);
  if (angle > limits.angle) return Remark(RemarkId::other_angles, joint + 1, angle, limits.angle);
  const double apart = (other - force).norm(), larger = std::max(force.norm(), other.norm());
  if (apart > limits.force * larger)
    return Remark(RemarkId::other_load, apart, force.norm(), other.norm(), limits.force);
  return {};
}

Remark difference(const identification::LoadCase& before, const identification::LoadCase& after,
                  const MatchLimits& limits) {
  return difference(before.q, before.wrench.force, after.q, after.wrench.force, limits);
}

}  // namespace

bool corresponds(const JointVector& q_before, const Eigen::Vector3d& force_before, const JointVector& q_after,
                 const Eigen::Vector3d& force_after, const MatchLimits& limits) {
  return difference(q_before, force_before, q_after, force_after, limits).empty();
}

MatchedPostures matchPostures(const campaign::Campaign& before_campaign, const identification::Identification& before,
                              const campaign::Campaign& after_campaign, const identification::Identification& after,
                              const MatchLimits& limits) {
  MatchedPostures result;
  const CaseByPose places = casesOf(after_campaign, after), own = casesOf(before_campaign, before);
  for (std::size_t i = 0; i < before.cases.size(); ++i) {
    const std::string& pose = poseOf(before_campaign, before.cases[i]);
    const auto place = places.find(pose);
    const Remark reason = place == places.end() ? whyAbsent(after_campaign, after, pose, When::after)
                                                : difference(before.cases[i], after.cases[place->second], limits);
    if (reason.empty()) {
      result.pairs.push_back({pose, i, place->second});
    } else {
      result.unmatched.push_back({pose, reason});
    }
  }
  for (const identification::LoadCase& load_case : after.cases) {
    const std::string& pose = poseOf(after_campaign, load_case);
    if (!own.contains(pose)) result.unmatched.push_back({pose, whyAbsent(before_campaign, before, pose, When::before)});
  }
  return result;
}

std::vector<ReflectorPair> reflectorsInBoth(const campaign::Campaign& before_campaign,
                                            const identification::LoadCase& before,
                                            const campaign::Campaign& after_campaign,
                                            const identification::LoadCase& after) {
  const auto idOf = [](const campaign::Campaign& campaign, const identification::TargetMove& move) {
    return campaign.targets[static_cast<std::size_t>(move.target)].id;
  };
  std::vector<ReflectorPair> pairs;
  for (std::size_t b = 0; b < before.targets.size(); ++b) {
    for (std::size_t a = 0; a < after.targets.size(); ++a) {
      if (idOf(before_campaign, before.targets[b]) == idOf(after_campaign, after.targets[a])) pairs.push_back({b, a});
    }
  }
  return pairs;
}

Remark differenceOfMachines(const robot::Robot& before, const robot::Robot& after) {
  if (before.joints() != after.joints()) return Remark(RemarkId::other_joint_count, before.joints(), after.joints());
  // Of a coupled arm a URDF has joints that only follow others.
  if (before.axes() != after.axes()) return Remark(RemarkId::other_joint_count, before.axes(), after.axes());
  for (std::size_t j = 0; j < before.axes_in_base_at_zero.size(); ++j) {
    const metrology::Line &a = before.axes_in_base_at_zero[j], &b = after.axes_in_base_at_zero[j];
    const double turn = (a.direction - b.direction).norm();
    const double apart = (b.point - a.point).cross(a.direction).norm();  // points slide along their axis
    if (turn <= kSameDirection && apart <= kSamePlace) continue;
    return turn > kSameDirection ? Remark(RemarkId::axis_turned, j + 1, 2.0 * std::asin(std::min(1.0, 0.5 * turn)))
                                 : Remark(RemarkId::axis_elsewhere, j + 1, apart);
  }
  return {};
}

/// By what it does where it stands with all joints at zero: there are several ways to state one.
bool sameBalancer(const robot::Balancer& one, const robot::Balancer& other) {
  constexpr double kSameForce = 0.01;  // of the force: a gauge reads no better
  const auto differ = [](const robot::BalancerEnd& a, const robot::BalancerEnd& b) {
    return a.body != b.body || (a.in_base_at_zero - b.in_base_at_zero).norm() > kSamePlace;
  };
  if (differ(one.from, other.from) || differ(one.to, other.to)) return false;
  const double length = (one.to.in_base_at_zero - one.from.in_base_at_zero).norm();
  const robot::Tension a = robot::tensionAt(one, length), b = robot::tensionAt(other, length);
  const auto apart = [](double x, double y) {
    return std::abs(x - y) > kSameForce * std::max(std::abs(x), std::abs(y));
  };
  return !apart(a.force_n, b.force_n) && !apart(a.slope_n_per_m, b.slope_n_per_m);
}

std::vector<Remark> doubtsOfOneMachine(const robot::Robot& before, const robot::Robot& after) {
  std::vector<Remark> doubts;
  if (before.name != after.name) doubts.emplace_back(RemarkId::other_name, before.name, after.name);
  const Eigen::Isometry3d flanges = before.base_from_flange_at_zero.inverse() * after.base_from_flange_at_zero;
  const double apart = flanges.translation().norm(), turn = Eigen::AngleAxisd(flanges.linear()).angle();
  if (apart > kSamePlace || turn > kSameDirection) doubts.emplace_back(RemarkId::flange_elsewhere, apart, turn);
  double mass_before = 0.0, mass_after = 0.0, difference = 0.0;
  for (std::size_t body = 1; body < before.bodies.size(); ++body) {
    mass_before += before.bodies[body].mass_kg;
    mass_after += after.bodies[body].mass_kg;
    difference = std::max(difference, std::abs(after.bodies[body].mass_kg - before.bodies[body].mass_kg));
  }
  if (difference > kSameMass * std::max(mass_before, mass_after))
    doubts.emplace_back(RemarkId::other_masses, mass_before, mass_after);
  if (!std::equal(before.balancers.begin(), before.balancers.end(), after.balancers.begin(), after.balancers.end(),
                  sameBalancer))
    doubts.emplace_back(RemarkId::other_balancers, static_cast<int>(before.balancers.size()),
                        static_cast<int>(after.balancers.size()));
  return doubts;
}

}  // namespace stiffscope::comparison
