#include "core/simulation/postures.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/io/input_error.h"
#include "core/numerics/random.h"
#include "core/simulation/rotation.h"

namespace stiffscope::simulation {

PostureSpacing::PostureSpacing(const JointVector& low, const JointVector& high) : widths_(high - low) {}

void PostureSpacing::add(const JointVector& q) {
  const std::size_t added = nodes_.size();
  nodes_.push_back({q});
  if (added == 0) return;
  for (std::size_t at = 0, depth = 0;; ++depth) {
    const Eigen::Index joint = jointOf(depth);
    std::size_t& next = nodes_[at].beyond[q[joint] < nodes_[at].q[joint] ? 0 : 1];
    if (next == 0) {
      next = added;
      return;
    }
    at = next;
  }
}

double PostureSpacing::squaredToNearest(const JointVector& q, double enough) const {
  double least = std::numeric_limits<double>::infinity();
  if (!nodes_.empty()) search(0, 0, q, enough, least);
  return least;
}

double PostureSpacing::squared(const JointVector& a, const JointVector& b) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < widths_.size(); ++i) {
    if (!(widths_[i] > 0.0)) continue;
    const double apart = (a[i] - b[i]) / widths_[i];
    sum += apart * apart;
  }
  return sum;
}

void PostureSpacing::search(std::size_t node, std::size_t depth, const JointVector& q, double enough,
                            double& least) const {
  const Node& here = nodes_[node];
  least = std::min(least, squared(q, here.q));
  const Eigen::Index joint = jointOf(depth);
  const std::size_t own_side = q[joint] < here.q[joint] ? 0 : 1;
  for (const std::size_t side : {own_side, 1 - own_side}) {
    if (least <= enough) return;
    if (here.beyond[side] == 0) continue;
    // What lies across the plane is at least as far as the plane.
    const double to_plane = widths_[joint] > 0.0 ? (q[joint] - here.q[joint]) / widths_[joint] : 0.0;
    if (side != own_side && to_plane * to_plane >= least) return;
    search(here.beyond[side], depth + 1, q, enough, least);
  }
}

namespace {

constexpr int kMostTries = 100000;  ///< for one candidate

bool within(double value, const std::optional<double>& low, const std::optional<double>& high) {
  return (!low || value >= *low) && (!high || value <= *high);
}

bool keepsRules(const SimulationSpec& spec, const PostureDraw& draw, const JointVector& q) {
  const int joints = spec.nominal.joints();
  for (int i = 0; i < joints; ++i) {
    const robot::JointLimits& limits = spec.nominal.limits[static_cast<std::size_t>(i)];
    if (q[i] < limits.lower || q[i] > limits.upper) return false;
  }
  if (spec.nominal.coupled() && !robot::withinAxisLimits(spec.nominal, q)) return false;
  if (robot::wristJointsOf(joints) == 3 && std::abs(std::sin(q[joints - 2])) < draw.min_abs_sin_bend) return false;
  const Eigen::Isometry3d base_from_flange = nominalFlange(spec.nominal, q);
  const double up = std::asin(std::clamp(base_from_flange.linear()(2, 2), -1.0, 1.0));
  if (draw.max_flange_up && up > *draw.max_flange_up) return false;
  const Eigen::Vector3d flange = base_from_flange.translation();
  if (!within(flange.z(), draw.min_height, draw.max_height)) return false;
  // On a rail as seen from its middle: where the carriage stands is drawn by itself.
  const Eigen::Vector3d carriage =
      spec.nominal.rail ? Eigen::Vector3d(0.5 * (spec.rail.low + spec.rail.high) * spec.nominal.rail->direction_in_base)
                        : Eigen::Vector3d(Eigen::Vector3d::Zero());
  const double distance = (flange + carriage - spec.tracker.base_from_tracker.translation()).norm();
  if (!within(distance, draw.min_tracker_distance, draw.max_tracker_distance)) return false;
  return !draw.min_hang_clearance || !spec.loading ||
         hangClearance(spec.nominal, q, spec.loading->hook_in_flange) >= *draw.min_hang_clearance;
}

JointVector drawOne(const SimulationSpec& spec, const PostureDraw& draw, numerics::RandomStream& random) {
  for (int attempt = 0; attempt < kMostTries; ++attempt) {
    JointVector q(draw.low.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = random.uniform(draw.low[i], draw.high[i]);
    if (keepsRules(spec, draw, q)) return q;
  }
  throw io::InputError(
      {spec.file.string(), 0, "draw"}, "",
      fmt::format("expected rules that some posture of the box keeps; {} random ones did not", kMostTries));
}

}  // namespace

Eigen::Isometry3d nominalFlange(const robot::Robot& robot, const JointVector& q) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  const JointVector angles = robot.axes_in_base_at_zero.angles(q);
  for (int i = 0; i < robot.axes(); ++i) {
    motion = motion * turnAbout(robot.axes_in_base_at_zero[static_cast<std::size_t>(i)], angles[i]);
  }
  return motion * robot.base_from_flange_at_zero;
}

double hangClearance(const robot::Robot& robot, const JointVector& q, const Eigen::Vector3d& hook_in_flange) {
  std::vector<Eigen::Vector3d> corners{Eigen::Vector3d::Zero()};
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  const JointVector angles = robot.axes_in_base_at_zero.angles(q);
  for (int i = 0; i < robot.axes(); ++i) {
    const metrology::Line& axis = robot.axes_in_base_at_zero[static_cast<std::size_t>(i)];
    corners.push_back(motion * axis.point);
    motion = motion * turnAbout(axis, angles[i]);
  }
  const Eigen::Isometry3d flange = motion * robot.base_from_flange_at_zero;
  corners.push_back(flange.translation());

  const Eigen::Vector3d hook = flange * hook_in_flange;
  constexpr int kSamples = 50;
  double clearance = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    for (int s = 0; s <= kSamples; ++s) {
      const double t = static_cast<double>(s) / kSamples;
      const Eigen::Vector3d point = (1.0 - t) * corners[k] + t * corners[k + 1];
      if (point.z() < hook.z()) clearance = std::min(clearance, (point - hook).head<2>().norm());
    }
  }
  return clearance;
}

std::vector<Posture> loadingPostures(const SimulationSpec& spec) {
  std::vector<Posture> postures;
  for (const ListedPosture& listed : spec.postures) postures.push_back({listed.q, listed.pull_direction});
  if (!spec.posture_draw) return postures;

  const PostureDraw& draw = *spec.posture_draw;
  numerics::RandomStream random(spec.seed, "postures");
  PostureSpacing spacing(draw.low, draw.high);
  for (const Posture& listed : postures) spacing.add(listed.q);
  for (int n = 0; n < draw.count; ++n) {
    JointVector best = drawOne(spec, draw, random);
    double farthest = draw.candidates > 1 ? spacing.squaredToNearest(best, 0.0) : 0.0;
    for (int c = 1; c < draw.candidates; ++c) {
      const JointVector q = drawOne(spec, draw, random);
      const double apart = spacing.squaredToNearest(q, farthest);
      if (apart > farthest) {
        best = q;
        farthest = apart;
      }
    }
    postures.push_back({best, std::nullopt});
    spacing.add(best);
  }
  return postures;
}

}  // namespace stiffscope::simulation
