#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/robot/robot.h"

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

}  // namespace stiffscope::simulation
