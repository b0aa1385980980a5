#include "core/toolpath/compensate_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "core/io/units.h"
#include "core/numerics/parallel.h"
#include "core/numerics/random.h"
#include "core/toolpath/remarks.h"

namespace stiffscope::toolpath {

namespace {

using robot::Robot;

constexpr double kFullTurn = 2.0 * std::numbers::pi;

/// The limit that is nearest.
struct LimitMargin {
  double margin = std::numeric_limits<double>::infinity();
  int joint = 0;
};

LimitMargin limitMargin(const Robot& arm, const JointVector& q) {
  LimitMargin nearest;
  for (int j = 0; j < arm.joints(); ++j) {
    const robot::JointLimits& limits = arm.limits[static_cast<std::size_t>(j)];
    const double margin = std::min(q[j] - limits.lower, limits.upper - q[j]);
    if (margin < nearest.margin) nearest = {margin, j};
  }
  return nearest;
}

Eigen::Isometry3d turned(const Eigen::Isometry3d& base_from_tool, double turn) {
  return base_from_tool * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
}

/// One branch along the whole path.
class Follower {
 public:
  Follower(const Robot& arm, const std::vector<Eigen::Isometry3d>& poses, const Eigen::Isometry3d& flange_from_tool,
           bool turn_free, const JointPathOptions& options)
      : arm_(arm), poses_(poses), flange_from_tool_(flange_from_tool), turn_free_(turn_free), options_(options) {}

  /// From joint angles at which the first pose, turned so, is held.
  std::vector<JointPathPose> follow(const JointVector& first, double first_turn) const {
    std::vector<JointPathPose> path;
    JointVector last = first;  // reached last
    std::size_t last_reached = 0;
    double turn = first_turn;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (turn_free_) turn = betterTurn(i, last_reached, last, turn, path.empty());
      const Reached reached = reach(i, last_reached, last, path.empty() ? turn : path[last_reached].turn, turn);
      path.push_back(placed(i, turn, reached));
      if (!reached.found.reached) continue;
      last = reached.found.q;
      last_reached = i;
    }
    return path;
  }

  double costAt(std::size_t pose, double turn, const JointVector& q) const {
    return cost(q, conditioning(q, turned(poses_[pose], turn)));
  }

 private:
  struct Reached {
    robot::InverseKinematics found;
    int jumped = -1;  ///< the joint that leaves the branch; -1: none
    double jump = 0.0;
  };

  double conditioning(const JointVector& q, const Eigen::Isometry3d& base_from_tool) const {
    return robot::conditioningAt(robot::axesAt(arm_, robot::postureAt(arm_, q)), base_from_tool.translation());
  }

  double cost(const JointVector& q, double conditioning) const {
    constexpr double kNear = 10.0 * io::kDegree, kLeastMargin = 1.0 * io::kDegree, kBeyond = 15.0 * io::kDegree;
    const auto square = [](double value) { return value * value; };
    double sum = square(0.05 / std::max(1e-3, conditioning));
    for (int j = 0; j < arm_.joints(); ++j) {
      const robot::JointLimits& limits = arm_.limits[static_cast<std::size_t>(j)];
      const double margin = std::min(q[j] - limits.lower, limits.upper - q[j]);
      sum += square(kNear / std::max(kLeastMargin, margin));
      if (margin < kLeastMargin) sum += 2.0 * square(kNear / kLeastMargin) * (kLeastMargin - margin) / kLeastMargin;
      if (!options_.preferred_low || !options_.preferred_high) continue;
      const double low = (*options_.preferred_low)[j], high = (*options_.preferred_high)[j];
      sum += square(std::max({0.0, low - q[j], q[j] - high}) / kBeyond);
    }
    return sum;
  }

  /// From the pose reached last, in parts, so that Newton's steps stay on the branch.
  Reached reach(std::size_t pose, std::size_t from, const JointVector& start, double from_turn, double turn) const {
    constexpr double kPart = 0.03, kPartTurn = 0.06, kJump = 0.35;
    const Eigen::Isometry3d begin = turned(poses_[from], from_turn), end = turned(poses_[pose], turn);
    const Eigen::Quaterniond begin_turn(begin.linear()), end_turn(end.linear());
    const double distance = (end.translation() - begin.translation()).norm(),
                 angle = begin_turn.angularDistance(end_turn);
    const int parts = std::max(1, static_cast<int>(std::ceil(std::max(distance / kPart, angle / kPartTurn))));
    Reached reached;
    reached.found.q = start;
    for (int part = 1; part <= parts; ++part) {
      const double share = static_cast<double>(part) / parts;
      Eigen::Isometry3d between = end;
      if (part < parts) {
        between.translation() = (1.0 - share) * begin.translation() + share * end.translation();
        between.linear() = begin_turn.slerp(share, end_turn).toRotationMatrix();
      }
      const JointVector before = reached.found.q;
      reached.found = robot::inverseKinematics(arm_, between, flange_from_tool_, before);
      Eigen::Index joint = 0;
      const double change = (reached.found.q - before).cwiseAbs().maxCoeff(&joint);
      if (reached.found.reached && change > std::max(kJump, reached.jump)) {
        reached.jumped = static_cast<int>(joint);
        reached.jump = change;
      }
    }
    return reached;
  }

  /// The turn within reach of `turn` at which the posture costs least: the vertex of the parabola through three of
  /// them.
  double betterTurn(std::size_t pose, std::size_t from, const JointVector& start, double turn, bool first) const {
    const double step = (poses_[pose].translation() - poses_[from].translation()).norm();
    const double most = first ? 0.0 : std::min(0.1, options_.turn_per_metre * step);
    if (most <= 0.0) return turn;
    std::array<double, 3> costs{};
    for (int k = 0; k < 3; ++k) {
      const double at = turn + (k - 1) * most;
      const robot::InverseKinematics found =
          robot::inverseKinematics(arm_, turned(poses_[pose], at), flange_from_tool_, start);
      if (!found.reached) return turn;
      costs[static_cast<std::size_t>(k)] = costAt(pose, at, found.q);
    }
    const double slope = 0.5 * (costs[2] - costs[0]), curvature = costs[2] - 2.0 * costs[1] + costs[0];
    if (curvature <= 0.0) return turn + (costs[2] < costs[0] ? most : -most);
    return turn + most * std::clamp(-slope / curvature, -1.0, 1.0);
  }

  JointPathPose placed(std::size_t pose, double turn, const Reached& reached) const {
    JointPathPose at;
    at.q = reached.found.q;
    at.turn = turn;
    at.base_from_tool = turned(poses_[pose], turn);
    if (!reached.found.reached) {
      at.q.setConstant(std::numeric_limits<double>::quiet_NaN());
      at.reason = Remark(RemarkId::not_reached, reached.found.missed, reached.found.turned);
      return at;
    }
    at.conditioning = conditioning(at.q, at.base_from_tool);
    if (reached.jumped >= 0) at.reason = Remark(RemarkId::leaves_branch, reached.jumped + 1, reached.jump);
    return at;
  }

  const Robot& arm_;
  const std::vector<Eigen::Isometry3d>& poses_;
  const Eigen::Isometry3d& flange_from_tool_;
  bool turn_free_;
  const JointPathOptions& options_;
};

/// Moves joints by a whole turn for the whole path where that brings more poses within the limits.
void chooseWholeTurns(const Robot& arm, std::vector<JointPathPose>& path) {
  for (int j = 0; j < arm.joints(); ++j) {
    const robot::JointLimits& limits = arm.limits[static_cast<std::size_t>(j)];
    const auto outside = [&](double shift) {
      return std::count_if(path.begin(), path.end(), [&](const JointPathPose& pose) {
        return pose.q[j] + shift < limits.lower || pose.q[j] + shift > limits.upper;
      });
    };
    double best = 0.0;
    for (const double shift : {-kFullTurn, kFullTurn}) {
      if (outside(shift) < outside(best)) best = shift;
    }
    for (JointPathPose& pose : path) pose.q[j] += best;
  }
}

void addMargins(const Robot& arm, std::vector<JointPathPose>& path) {
  for (JointPathPose& pose : path) {
    if (!pose.q.allFinite()) continue;
    const LimitMargin nearest = limitMargin(arm, pose.q);
    pose.limit_margin = nearest.margin;
    pose.nearest_limit = nearest.joint;
  }
}

/// A solution of the first pose.
struct Start {
  JointVector q;
  double turn = 0.0, cost = 0.0;
};

std::vector<JointVector> seedsOf(const Robot& arm, const JointPathOptions& options) {
  if (options.start) return {*options.start};
  std::vector<JointVector> seeds = options.seeds;
  constexpr int kDrawn = 60;
  numerics::RandomStream random(1, "inverse kinematics");
  for (int k = 0; k < kDrawn; ++k) {
    JointVector q(arm.joints());
    for (int j = 0; j < arm.joints(); ++j) {
      const robot::JointLimits& limits = arm.limits[static_cast<std::size_t>(j)];
      q[j] = random.uniform(std::max(limits.lower, -std::numbers::pi), std::min(limits.upper, std::numbers::pi));
    }
    seeds.push_back(q);
  }
  return seeds;
}

/// Of a machine that cannot hold a tool at any pose.
JointPath refused(const Robot& arm, const std::vector<Eigen::Isometry3d>& base_from_tool) {
  JointPath path;
  for (const Eigen::Isometry3d& wanted : base_from_tool) {
    JointPathPose pose;
    pose.q = JointVector::Constant(arm.joints(), std::numeric_limits<double>::quiet_NaN());
    pose.base_from_tool = wanted;
    pose.reason = Remark(RemarkId::fewer_than_six_joints, arm.joints());
    path.poses.push_back(std::move(pose));
  }
  return path;
}

}  // namespace

JointPath jointPath(const robot::Robot& arm, const std::vector<Eigen::Isometry3d>& base_from_tool,
                    const Eigen::Isometry3d& flange_from_tool, bool turn_free, const JointPathOptions& options) {
  constexpr std::size_t kMostBranches = 24;
  constexpr int kTurns = 12;
  JointPath result;
  if (base_from_tool.empty()) return result;
  if (arm.joints() < 6) return refused(arm, base_from_tool);
  const Follower follower(arm, base_from_tool, flange_from_tool, turn_free, options);
  const std::vector<JointVector> seeds = seedsOf(arm, options);
  const std::size_t turns = turn_free ? kTurns : 1;
  std::vector<std::vector<Start>> by_turn(turns);
  numerics::onAllCores(turns, [&](std::size_t k) {
    const double turn = kFullTurn * static_cast<double>(k) / static_cast<double>(turns);
    for (JointVector q :
         robot::inverseKinematicsBranches(arm, turned(base_from_tool.front(), turn), flange_from_tool, seeds)) {
      // The whole turns of a stated start are meant.
      if (options.start) {
        for (int j = 0; j < arm.joints(); ++j) q[j] += kFullTurn * std::round(((*options.start)[j] - q[j]) / kFullTurn);
      }
      by_turn[k].push_back({q, turn, follower.costAt(0, turn, q)});
    }
  });
  std::vector<Start> starts;
  for (const std::vector<Start>& some : by_turn) starts.insert(starts.end(), some.begin(), some.end());
  const auto apart = [&](const Start& one) { return options.start ? (one.q - *options.start).norm() : one.cost; };
  std::stable_sort(starts.begin(), starts.end(), [&](const Start& a, const Start& b) { return apart(a) < apart(b); });
  starts.resize(std::min(starts.size(), options.start ? std::size_t{1} : kMostBranches));
  if (starts.empty()) {
    // Out of reach: from the first seed every pose says by how much.
    result.poses = follower.follow(seeds.front(), 0.0);
    addMargins(arm, result.poses);
    return result;
  }
  std::vector<std::vector<JointPathPose>> paths(starts.size());
  numerics::onAllCores(starts.size(), [&](std::size_t i) {
    paths[i] = follower.follow(starts[i].q, starts[i].turn);
    if (!options.start) chooseWholeTurns(arm, paths[i]);
    addMargins(arm, paths[i]);
  });
  const auto worth = [&](const std::vector<JointPathPose>& path) {
    std::size_t unusable = 0;
    double sum = 0.0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const JointPathPose& pose = path[i];
      const bool usable =
          pose.reason.empty() && pose.limit_margin >= 0.0 && pose.conditioning >= options.least_conditioning;
      unusable += usable ? 0 : 1;
      if (pose.q.allFinite()) sum += follower.costAt(i, pose.turn, pose.q);
    }
    return std::make_tuple(unusable, sum);
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < paths.size(); ++i) {
    if (worth(paths[i]) < worth(paths[best])) best = i;
  }
  result.poses = std::move(paths[best]);
  result.branches = starts.size();
  return result;
}

}  // namespace stiffscope::toolpath
