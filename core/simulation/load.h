#pragma once

#include <Eigen/Core>
#include <variant>

#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// A force (N, base_link axes) that keeps size and direction while the machine gives under it.
struct DeadForce {
  Eigen::Vector3d point_in_flange = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_in_base = Eigen::Vector3d::Zero();
  Eigen::Vector3d unread_in_base = Eigen::Vector3d::Zero();  ///< N, as well, but past the load cell
};

/// A cable at constant tension (N) from a point of the tool to an anchor that stands still.
struct AnchoredCable {
  Eigen::Vector3d point_in_flange = Eigen::Vector3d::Zero();
  Eigen::Vector3d anchor_in_base = Eigen::Vector3d::Zero();
  double tension = 0.0;
  Eigen::Vector3d unread_in_base = Eigen::Vector3d::Zero();  ///< a dead force, N, as well, but past the load cell
};

/// What acts on the machine besides its own weight; monostate: nothing.
using AppliedLoad = std::variant<std::monostate, DeadForce, AnchoredCable>;

/// Steps of a pose beyond the unloaded step 0, the return to zero included.
int loadSteps(const LoadingSpec& loading);

/// The load of one step (0: none; beyond the stated weights or tensions: the return to zero, none).
/// `gravity_in_base` is the true one; `pull_direction` the posture's own, if it has one; `unread` comes with
/// every load.
AppliedLoad loadAtStep(const LoadingSpec& loading, int step, const Eigen::Vector3d& gravity_in_base,
                       const std::optional<Eigen::Vector3d>& pull_direction,
                       const Eigen::Vector3d& unread = Eigen::Vector3d::Zero());

/// The load as it swings at this time of the day (LoadingSpec::swing); one that does not is returned as it
/// is.
AppliedLoad swungLoad(const LoadingSpec& loading, const AppliedLoad& load, double time_s);

/// Where the load acts (flange axes), the force on the machine when that point is at `point_in_base`, and its
/// potential (J), whose gradient in the point is minus the force. Zero for monostate.
Eigen::Vector3d loadPointInFlange(const AppliedLoad& load);
Eigen::Vector3d loadForce(const AppliedLoad& load, const Eigen::Vector3d& point_in_base);
Eigen::Vector3d unreadForce(const AppliedLoad& load);  ///< the part of loadForce that no load cell sees
double loadPotential(const AppliedLoad& load, const Eigen::Vector3d& point_in_base);

}  // namespace stiffscope::simulation
