#include "core/simulation/posture_spacing.h"

#include <algorithm>
#include <limits>

namespace stiffscope::simulation {

PostureSpacing::PostureSpacing(const Vector6d& low, const Vector6d& high) : widths_(high - low) {}

void PostureSpacing::add(const Vector6d& q) {
  const std::size_t added = nodes_.size();
  nodes_.push_back({q});
  if (added == 0) return;
  for (std::size_t at = 0, depth = 0;; ++depth) {
    const int joint = jointOf(depth);
    std::size_t& next = nodes_[at].beyond[q[joint] < nodes_[at].q[joint] ? 0 : 1];
    if (next == 0) {
      next = added;
      return;
    }
    at = next;
  }
}

double PostureSpacing::squaredToNearest(const Vector6d& q, double enough) const {
  double least = std::numeric_limits<double>::infinity();
  if (!nodes_.empty()) search(0, 0, q, enough, least);
  return least;
}

double PostureSpacing::squared(const Vector6d& a, const Vector6d& b) const {
  double sum = 0.0;
  for (int i = 0; i < 6; ++i) {
    if (!(widths_[i] > 0.0)) continue;
    const double apart = (a[i] - b[i]) / widths_[i];
    sum += apart * apart;
  }
  return sum;
}

void PostureSpacing::search(std::size_t node, std::size_t depth, const Vector6d& q, double enough,
                            double& least) const {
  const Node& here = nodes_[node];
  least = std::min(least, squared(q, here.q));
  const int joint = jointOf(depth);
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

}  // namespace stiffscope::simulation
