#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/robot/robot.h"
#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// Postures in a box of joint angles, for the distance of another to the nearest of them in widths of the box (a joint
/// without width does not count). A k-d tree by joints in turn, grown as postures come: they are random, so it stays as
/// deep as the logarithm of their number without being balanced.
class PostureSpacing {
 public:
  PostureSpacing(const JointVector& low, const JointVector& high);

  void add(const JointVector& q);

  /// Squared distance to the nearest; infinity without any. Where it is no more than `enough`, any distance that is no
  /// more than `enough` may stand for it.
  double squaredToNearest(const JointVector& q, double enough) const;

 private:
  struct Node {
    JointVector q;
    std::array<std::size_t, 2> beyond{0, 0};  ///< on the lower and the upper side; 0: none
  };

  Eigen::Index jointOf(std::size_t depth) const {
    return static_cast<Eigen::Index>(depth % static_cast<std::size_t>(widths_.size()));
  }
  double squared(const JointVector& a, const JointVector& b) const;
  void search(std::size_t node, std::size_t depth, const JointVector& q, double enough, double& least) const;

  JointVector widths_;
  std::vector<Node> nodes_;  ///< the first is the root
};

/// A posture of the loading and the direction a fixed-direction cable pulls there (unit, base_link), if
/// listed.
struct Posture {
  JointVector q;  ///< rad
  std::optional<Eigen::Vector3d> pull_direction;
};

/// The listed postures, then the drawn ones (stream "postures" of the seed). Nested: asking for more postures
/// leaves the first ones as they are. With `candidates` above one, each is the one of so many random postures
/// that is farthest from those before it, listed ones included, in joint angles over the width of the box
/// (Mitchell's best candidate). Throws InputError when the rules leave nothing to find.
std::vector<Posture> loadingPostures(const SimulationSpec& spec);

/// Place of the flange of the nominal rigid arm.
Eigen::Isometry3d nominalFlange(const robot::Robot& robot, const JointVector& q);

/// Horizontal distance (m) from the vertical through the hook to the nearest part of the arm that is lower
/// than the hook: the arm taken as straight lines from the base's origin over the points of the axes to the
/// flange. Infinite if none is lower.
double hangClearance(const robot::Robot& robot, const JointVector& q, const Eigen::Vector3d& hook_in_flange);

}  // namespace stiffscope::simulation
