#include "core/comparison/matched_postures.h"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/io/units.h"

namespace stiffscope::comparison {

namespace {

constexpr double kSamePlace = 1e-3, kSameDirection = 1e-3;  // m, rad: beyond what two files of one arm round to
constexpr double kSameMass = 1e-3;                          // of all links together

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
std::string whyAbsent(const campaign::Campaign& campaign, const identification::Identification& result,
                      const std::string& pose, const char* when) {
  const std::string head = "pose " + pose + ": ";
  for (const std::string& left_out : result.left_out) {
    if (left_out.rfind(head, 0) == 0) return fmt::format("left out {}: {}", when, left_out.substr(head.size()));
  }
  const auto& ids = campaign.pose_ids;
  return std::find(ids.begin(), ids.end(), pose) == ids.end()
             ? fmt::format("not measured {}", when)
             : fmt::format("no usable load state {} in load step {}", when, result.step);
}

/// Why two load cases of one pose id are not the same; empty where they are.
std::string difference(const identification::LoadCase& before, const identification::LoadCase& after,
                       const MatchLimits& limits) {
  Eigen::Index joint = 0;
  const double angle = (after.q - before.q).cwiseAbs().maxCoeff(&joint);
  if (angle > limits.angle) {
    return fmt::format("joint {} stands {:.3f} deg apart, at most {:.3f} is the same posture", joint + 1,
                       angle / io::kDegree, limits.angle / io::kDegree);
  }
  const Eigen::Vector3d &force = before.wrench.force, &other = after.wrench.force;
  const double larger = std::max(force.norm(), other.norm());
  if ((other - force).norm() > limits.force * larger) {
    return fmt::format(
        "the loads differ by {:.1f} % ({:.0f} N before, {:.0f} N after), at most {:.0f} % is the same load",
        100.0 * (other - force).norm() / larger, force.norm(), other.norm(), 100.0 * limits.force);
  }
  return {};
}

}  // namespace

MatchedPostures matchPostures(const campaign::Campaign& before_campaign, const identification::Identification& before,
                              const campaign::Campaign& after_campaign, const identification::Identification& after,
                              const MatchLimits& limits) {
  MatchedPostures result;
  const CaseByPose places = casesOf(after_campaign, after), own = casesOf(before_campaign, before);
  for (std::size_t i = 0; i < before.cases.size(); ++i) {
    const std::string& pose = poseOf(before_campaign, before.cases[i]);
    const auto place = places.find(pose);
    const std::string reason = place == places.end() ? whyAbsent(after_campaign, after, pose, "after")
                                                     : difference(before.cases[i], after.cases[place->second], limits);
    if (reason.empty()) {
      result.pairs.push_back({pose, i, place->second});
    } else {
      result.unmatched.push_back({pose, reason});
    }
  }
  for (const identification::LoadCase& load_case : after.cases) {
    const std::string& pose = poseOf(after_campaign, load_case);
    if (!own.contains(pose)) result.unmatched.push_back({pose, whyAbsent(before_campaign, before, pose, "before")});
  }
  return result;
}

std::string differenceOfMachines(const robot::Robot& before, const robot::Robot& after) {
  for (std::size_t j = 0; j < 6; ++j) {
    const metrology::Line &a = before.axes_in_base_at_zero[j], &b = after.axes_in_base_at_zero[j];
    const double turn = (a.direction - b.direction).norm();
    const double apart = (b.point - a.point).cross(a.direction).norm();  // points slide along their axis
    if (turn <= kSameDirection && apart <= kSamePlace) continue;
    return turn > kSameDirection
               ? fmt::format("the URDFs describe different machines: axis {} is turned by {:.2f} deg", j + 1,
                             2.0 * std::asin(std::min(1.0, 0.5 * turn)) / io::kDegree)
               : fmt::format("the URDFs describe different machines: axis {} stands {:.1f} mm elsewhere", j + 1,
                             apart / io::kMillimetre);
  }
  return {};
}

std::vector<std::string> doubtsOfOneMachine(const robot::Robot& before, const robot::Robot& after) {
  std::vector<std::string> doubts;
  if (before.name != after.name) {
    doubts.push_back(fmt::format("the URDFs name different machines: {} and {}", before.name, after.name));
  }
  const Eigen::Isometry3d flanges = before.base_from_flange_at_zero.inverse() * after.base_from_flange_at_zero;
  const double apart = flanges.translation().norm(), turn = Eigen::AngleAxisd(flanges.linear()).angle();
  if (apart > kSamePlace || turn > kSameDirection) {
    doubts.push_back(fmt::format("the URDFs place the flange {:.1f} mm and {:.2f} deg apart", apart / io::kMillimetre,
                                 turn / io::kDegree));
  }
  double mass_before = 0.0, mass_after = 0.0, difference = 0.0;
  for (std::size_t body = 1; body < before.bodies.size(); ++body) {
    mass_before += before.bodies[body].mass_kg;
    mass_after += after.bodies[body].mass_kg;
    difference = std::max(difference, std::abs(after.bodies[body].mass_kg - before.bodies[body].mass_kg));
  }
  if (difference > kSameMass * std::max(mass_before, mass_after)) {
    doubts.push_back(
        fmt::format("the URDFs' links have different masses, {:.0f} kg and {:.0f} kg in all", mass_before, mass_after));
  }
  return doubts;
}

}  // namespace stiffscope::comparison
