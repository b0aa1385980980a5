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

/// Where each slider of the machine's curves is anchored (rad or m), in their order; null: sliders carry
/// nothing.
using Anchors = const Eigen::VectorXd*;

/// Pi(x) = 1/2 sum d' K d + curves + shared springs + link springs - sum m g . c(x) + V_load(x), J, over
/// elements, masses (tool included) and load: the total potential energy of the machine with its motors held.
/// Its stationary points are the equilibria.
double potentialEnergy(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                       const Eigen::VectorXd& x, Anchors anchors = nullptr);

/// dPi/dx, exact (no differences): with F and M the sum of forces and of moments about the element's
/// displaced origin of everything beyond, and R the element's axes before giving,
///   dPi/du = K_u d - R' F,   dPi/dr = K_r d - J_l(r)' R' M      (leftJacobian of rotation.h),
/// and curves and shared springs straight in their coordinates.
Eigen::VectorXd energyGradient(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                               const Eigen::VectorXd& x, Anchors anchors = nullptr);

/// The gradient without that of the curves, whose corners would spoil its differences.
Eigen::VectorXd smoothGradient(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                               const Eigen::VectorXd& x);

/// Gradient and Hessian at once. The Hessian is K + curves + shared springs and, for two turns a_i inside
/// and a_j at or beyond it, minus a_i . (T a_j - tr(T) a_j) with T = sum r F' over the forces beyond j, r
/// from j's origin: the geometric stiffness of dead forces at an arm that has hardly given. It leaves out how
/// the load and the link springs turn, and terms of the order of the element's own rotation: a guide for
/// steps, whose end the exact gradient decides.
struct EnergySlopes {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};
EnergySlopes energySlopes(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                          const Eigen::VectorXd& x, Anchors anchors);

/// Adds the curves' rates at x to the diagonal.
void addCurveRates(const ElasticMachine& machine, const Eigen::VectorXd& x, Anchors anchors,
                   Eigen::MatrixXd& hessian);

}  // namespace stiffscope::simulation
