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
  PostureSpacing(const Vector6d& low, const Vector6d& high);

  void add(const Vector6d& q);

  /// Squared distance to the nearest; infinity without any. Where it is no more than `enough`, any distance that is no
  /// more than `enough` may stand for it.
  double squaredToNearest(const Vector6d& q, double enough) const;

 private:
  struct Node {
    Vector6d q;
    std::array<std::size_t, 2> beyond{0, 0};  ///< on the lower and the upper side; 0: none
  };

  static int jointOf(std::size_t depth) { return static_cast<int>(depth % 6); }
  double squared(const Vector6d& a, const Vector6d& b) const;
  void search(std::size_t node, std::size_t depth, const Vector6d& q, double enough, double& least) const;

  Vector6d widths_;
  std::vector<Node> nodes_;  ///< the first is the root
};

/// A posture of the loading and the direction a fixed-direction cable pulls there (unit, base_link), if
/// listed.
struct Posture {
  Vector6d q = Vector6d::Zero();  ///< rad
  std::optional<Eigen::Vector3d> pull_direction;
};

/// The listed postures, then the drawn ones (stream "postures" of the seed). Nested: asking for more postures
/// leaves the first ones as they are. With `candidates` above one, each is the one of so many random postures
/// that is farthest from those before it, listed ones included, in joint angles over the width of the box
/// (Mitchell's best candidate). Throws InputError when the rules leave nothing to find.
std::vector<Posture> loadingPostures(const SimulationSpec& spec);

/// Place of the flange of the nominal rigid arm.
Eigen::Isometry3d nominalFlange(const robot::Robot& robot, const Vector6d& q);

/// Horizontal distance (m) from the vertical through the hook to the nearest part of the arm that is lower
/// than the hook: the arm taken as straight lines from the base's origin over the points of axes 1-6 to the
/// flange. Infinite if none is lower.
double hangClearance(const robot::Robot& robot, const Vector6d& q, const Eigen::Vector3d& hook_in_flange);

}  // namespace stiffscope::simulation
