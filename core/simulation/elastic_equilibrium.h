#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/simulation/load.h"
#include "core/simulation/machine.h"

namespace stiffscope {

/// The machine at rest: no noise anywhere. All places in base_link (the ground's), m.
struct MachineState {
  Vector6d q = Vector6d::Zero();                  ///< reported joint angles the motors hold, rad
  Eigen::VectorXd deformation;                    ///< elastic coordinates, chain order, m and rad
  std::array<Eigen::Isometry3d, 7> body_motions;  ///< nominal place at all joints zero -> place now; [0] base
  Eigen::Isometry3d base_from_flange = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3d> targets_in_base;
  Eigen::Vector3d load_point_in_base = Eigen::Vector3d::Zero();
  Eigen::Vector3d load_force_in_base = Eigen::Vector3d::Zero();    ///< of the load on the machine, N
  Eigen::Vector3d unread_force_in_base = Eigen::Vector3d::Zero();  ///< the part of it no load cell sees, N
  double energy = 0.0;                                             ///< J, see simulation/elastic_energy.h
  double last_step = 0.0;  ///< largest change of a coordinate in the last Newton step, m or rad
  int iterations = 0;
  bool converged =
      false;  ///< last_step below 1e-12, at a minimum of the energy; if not, the state is the last tried
};

/// The stable equilibrium under own weight, tool and load with the motors held at q: the minimum of the
/// potential energy, with finite rotations, nearest the unstrained machine. Newton's method with the analytic
/// Hessian of elastic_energy.h where that leads there in a few shrinking steps, which it does while the
/// machine gives little. Else the Hessian is taken by central differences of the exact gradient (curves
/// aside), shifted where it is not positive definite until it is, and a step that raises the energy is
/// halved. A load beyond buckling has no such minimum nearby: either one far away is found (see
/// `deformation`), or `converged` is false.
/// `anchors`: of the sliders, where joints have friction; null: friction carries nothing.
MachineState equilibrium(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load = {},
                         const Eigen::VectorXd* anchors = nullptr);

/// The machine with its elastic coordinates at x, whether that is an equilibrium or not.
MachineState stateAt(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                     const Eigen::VectorXd& x);

/// Friction through a posture's loads. At arrival every slider is anchored where the machine rests; after
/// each load those slip that carry more than they hold. Both return the anchors.
Eigen::VectorXd arrivedAnchors(const ElasticMachine& machine, const MachineState& rest);
Eigen::VectorXd slippedAnchors(const ElasticMachine& machine, const MachineState& state,
                               Eigen::VectorXd anchors);

/// Place of one of nominal.links in that state.
Eigen::Isometry3d baseFromLink(const ElasticMachine& machine, const MachineState& state,
                               const LinkFrame& link);

}  // namespace stiffscope
