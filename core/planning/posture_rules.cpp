#include "core/planning/posture_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/cartesian_stiffness/posture_conditioning.h"
#include "core/input/input_error.h"
#include "core/input/units.h"

namespace stiffscope {

namespace {

struct Skeleton {
  std::vector<Eigen::Vector3d> points;  // sampled every few centimetres
  std::size_t forearm = 0;              // the first point beyond axis 3
};

Skeleton skeletonOf(const PlanningArm& arm, const ArmPosture& posture) {
  std::vector<Eigen::Vector3d> corners{arm.geometry.r0_from_base_link.translation()};
  for (int joint = 0; joint < 6; ++joint) corners.push_back(axisAt(arm.geometry.arm, posture, joint).point);
  corners.push_back(flangeAt(arm.geometry.arm, posture).translation());
  Skeleton skeleton;
  constexpr int kSamples = 20;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    if (k == 3) skeleton.forearm = skeleton.points.size();  // corners: base, axes 1, 2, 3, ...
    for (int s = 0; s <= kSamples; ++s) {
      const double t = static_cast<double>(s) / kSamples;
      skeleton.points.push_back((1.0 - t) * corners[k] + t * corners[k + 1]);
    }
  }
  return skeleton;
}

/// Distance of a point from the part of a line that starts at `from` and is `length` long; infinite beside
/// its ends.
double distanceFromLine(const Eigen::Vector3d& point, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& direction, double length) {
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
  return std::any_of(skeleton.points.begin(),
                     skeleton.points.begin() + static_cast<std::ptrdiff_t>(skeleton.forearm),
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

PostureRule brokenRule(const PlanningArm& arm, const PostureRules& rules, const ArmPosture& posture,
                       const Eigen::Vector3d& direction) {
  const Eigen::Isometry3d flange = flangeAt(arm.geometry.arm, posture);
  const Matrix6d jacobian = jacobianAt(arm.geometry.arm, posture, flange.translation());
  if (postureConditioning(jacobian, 1.0).dexterity < rules.least_dexterity) return PostureRule::singularity;

  const Eigen::Isometry3d base_from_r0 = arm.geometry.r0_from_base_link.inverse();
  const Skeleton skeleton = skeletonOf(arm, posture);
  const Eigen::Vector3d hook = flange * arm.hook_in_flange;
  std::vector<Eigen::Vector3d> targets;
  for (const Eigen::Vector3d& target : arm.targets_in_flange) targets.push_back(flange * target);
  const auto lower = [&](const Eigen::Vector3d& point, double height) {
    return (base_from_r0 * point).z() < height;
  };
  if (!arm.pull && lower(hook, rules.least_hook_height)) return PostureRule::low;
  for (const Eigen::Vector3d& target : targets) {
    if (lower(target, rules.least_height)) return PostureRule::low;
  }
  for (std::size_t k = skeleton.forearm; k < skeleton.points.size(); ++k) {
    if (lower(skeleton.points[k], rules.least_height)) return PostureRule::low;
  }
  if (!arm.pull &&
      -direction.dot(flange.linear() * arm.outward_in_flange) > std::sin(rules.most_outward_up)) {
    return PostureRule::hanging;
  }
  constexpr double kLine = 3.0;  // m of cable or chain
  if (clearanceOfLine(skeleton.points, hook, direction, kLine) < rules.line_clearance)
    return PostureRule::load_line;
  if (nearBody(skeleton, hook, rules.body_clearance)) return PostureRule::body;
  for (const Eigen::Vector3d& target : targets) {
    if (nearBody(skeleton, target, rules.body_clearance)) return PostureRule::body;
  }
  return brokenBySight(arm, rules, skeleton, targets);
}

std::array<JointLimits, 6> postureBox(const Robot& arm, const PostureRules& rules) {
  std::array<JointLimits, 6> box;
  for (std::size_t j = 0; j < 6; ++j) {
    const auto joint = static_cast<Eigen::Index>(j);
    box[j].lower = std::max(arm.limits[j].lower + rules.limit_margin, rules.low[joint]);
    box[j].upper = std::min(arm.limits[j].upper - rules.limit_margin, rules.high[joint]);
    if (box[j].lower <= box[j].upper) continue;
    const double low = rules.low[joint] / kDegree, high = rules.high[joint] / kDegree;
    if (low > high) {
      throw InputError({"--min-deg"}, fmt::format("{:g}", low),
                       fmt::format("expected at most the {:g} of --max-deg for joint {}", high, j + 1));
    }
    const bool starts_too_high = rules.low[joint] > arm.limits[j].upper - rules.limit_margin;
    throw InputError(
        {starts_too_high ? "--min-deg" : "--max-deg"}, fmt::format("{:g}", starts_too_high ? low : high),
        fmt::format("expected a range of joint {} within its limits {:.1f} to {:.1f} deg less {:.0f} deg "
                    "at each end",
                    j + 1, arm.limits[j].lower / kDegree, arm.limits[j].upper / kDegree,
                    rules.limit_margin / kDegree));
  }
  return box;
}

}  // namespace stiffscope
