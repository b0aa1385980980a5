#include "core/simulation/postures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/input/input_error.h"
#include "core/simulation/random.h"
#include "core/simulation/rotation.h"

namespace stiffscope::simulation {

namespace {

constexpr int kMostTries = 100000;  ///< for one candidate

bool within(double value, const std::optional<double>& low, const std::optional<double>& high) {
  return (!low || value >= *low) && (!high || value <= *high);
}

bool keepsRules(const SimulationSpec& spec, const PostureDraw& draw, const Vector6d& q) {
  for (int i = 0; i < 6; ++i) {
    if (q[i] < spec.nominal.limits[i].lower || q[i] > spec.nominal.limits[i].upper) return false;
  }
  if (std::abs(std::sin(q[4])) < draw.min_abs_sin_q5) return false;
  const Eigen::Isometry3d base_from_flange = nominalFlange(spec.nominal, q);
  const double up = std::asin(std::clamp(base_from_flange.linear()(2, 2), -1.0, 1.0));
  if (draw.max_flange_up && up > *draw.max_flange_up) return false;
  const Eigen::Vector3d flange = base_from_flange.translation();
  if (!within(flange.z(), draw.min_height, draw.max_height)) return false;
  const double distance = (flange - spec.tracker.base_from_tracker.translation()).norm();
  if (!within(distance, draw.min_tracker_distance, draw.max_tracker_distance)) return false;
  return !draw.min_hang_clearance || !spec.loading ||
         hangClearance(spec.nominal, q, spec.loading->hook_in_flange) >= *draw.min_hang_clearance;
}

Vector6d drawOne(const SimulationSpec& spec, const PostureDraw& draw, RandomStream& random) {
  for (int attempt = 0; attempt < kMostTries; ++attempt) {
    Vector6d q;
    for (int i = 0; i < 6; ++i) q[i] = random.uniform(draw.low[i], draw.high[i]);
    if (keepsRules(spec, draw, q)) return q;
  }
  throw InputError(
      {spec.file.string(), 0, "draw"}, "",
      fmt::format("expected rules that some posture of the box keeps; {} random ones did not", kMostTries));
}

/// Least distance from q to the postures before it, in widths of the box.
double separation(const PostureDraw& draw, const Vector6d& q, const std::vector<Posture>& before) {
  double least = std::numeric_limits<double>::infinity();
  for (const Posture& posture : before) {
    double sum = 0.0;
    for (int i = 0; i < 6; ++i) {
      const double width = draw.high[i] - draw.low[i];
      if (width > 0.0) sum += std::pow((q[i] - posture.q[i]) / width, 2);
    }
    least = std::min(least, sum);
  }
  return std::sqrt(least);
}

}  // namespace

Eigen::Isometry3d nominalFlange(const Robot& robot, const Vector6d& q) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 6; ++i) motion = motion * turnAbout(robot.axes_in_base_at_zero[i], q[i]);
  return motion * robot.base_from_flange_at_zero;
}

double hangClearance(const Robot& robot, const Vector6d& q, const Eigen::Vector3d& hook_in_flange) {
  std::vector<Eigen::Vector3d> corners{Eigen::Vector3d::Zero()};
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 6; ++i) {
    corners.push_back(motion * robot.axes_in_base_at_zero[i].point);
    motion = motion * turnAbout(robot.axes_in_base_at_zero[i], q[i]);
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
  RandomStream random(spec.seed, "postures");
  for (int n = 0; n < draw.count; ++n) {
    Vector6d best = drawOne(spec, draw, random);
    double best_separation = separation(draw, best, postures);
    for (int c = 1; c < draw.candidates; ++c) {
      const Vector6d q = drawOne(spec, draw, random);
      const double apart = separation(draw, q, postures);
      if (apart > best_separation) {
        best = q;
        best_separation = apart;
      }
    }
    postures.push_back({best, std::nullopt});
  }
  return postures;
}

}  // namespace stiffscope::simulation
