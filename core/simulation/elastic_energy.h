#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/simulation/load.h"
#include "core/simulation/machine.h"

namespace stiffscope::simulation {

/// Where everything stands when the motors are at q (reported angles, rad) and the elastic coordinates are x
/// (one a free direction of every element, chain order; m and rad).
struct Placement {
  std::array<Eigen::Isometry3d, 7>
      body_motions;               ///< nominal place at zero -> place now, base_link; [0] the base
  Eigen::Isometry3d tool_motion;  ///< the same beyond the last link element: flange and tool
  std::vector<Eigen::Isometry3d> before_giving;  ///< base_from_element of each element, before it gives
};

Placement place(const ElasticMachine& machine, const Vector6d& q, const Eigen::VectorXd& x);

/// Pi(x) = 1/2 sum d' K d - sum m g . c(x) + V_load(x), J, over elements, masses (tool included) and load:
/// the total potential energy of the machine with its motors held. Its stationary points are the equilibria.
double potentialEnergy(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                       const Eigen::VectorXd& x);

/// dPi/dx, exact (no differences): with F and M the sum of forces and of moments about the element's
/// displaced origin of everything beyond, and R the element's axes before giving,
///   dPi/du = K_u d - R' F,   dPi/dr = K_r d - J_l(r)' R' M      (leftJacobian of rotation.h).
Eigen::VectorXd energyGradient(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                               const Eigen::VectorXd& x);

}  // namespace stiffscope::simulation
