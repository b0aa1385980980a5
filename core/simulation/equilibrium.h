#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <variant>
#include <vector>

#include "core/simulation/machine.h"
#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// A force (N, base_link axes) that keeps size and direction while the machine deflects under it.
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

/// Where everything stands when the motors are at q (reported angles, rad) and the elastic coordinates are x
/// (one a free direction of every element, chain order; m and rad).
struct Placement {
  PerBody<Eigen::Isometry3d> body_motions;       ///< nominal place at zero -> place now, base_link; [0] the base
  Eigen::Isometry3d tool_motion;                 ///< the same beyond the last link element: flange and tool
  std::vector<Eigen::Isometry3d> before_giving;  ///< base_from_element of each element, before it deflects
  PerJoint<metrology::Line> axes;                ///< in base_link; only of an arm with coupled joints
};

Placement place(const ElasticMachine& machine, const JointVector& q, const Eigen::VectorXd& x);

/// Where each slider of the machine's curves is anchored (rad or m), in their order; null: sliders carry
/// nothing.
using Anchors = const Eigen::VectorXd*;

/// Pi(x) = 1/2 sum d' K d + curves + shared springs + link springs - sum m g . c(x) + V_load(x), J, over
/// elements, masses (tool included) and load: the total potential energy of the machine with its motors held.
/// Its stationary points are the equilibria.
double potentialEnergy(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load,
                       const Eigen::VectorXd& x, Anchors anchors = nullptr);

/// dPi/dx, exact (no differences): with F and M the sum of forces and of moments about the element's
/// displaced origin of everything beyond, and R the element's axes before deflecting,
///   dPi/du = K_u d - R' F,   dPi/dr = K_r d - J_l(r)' R' M      (leftJacobian of rotation.h),
/// and curves and shared springs straight in their coordinates. The torsion of a coupled joint has besides, of each
/// axis that follows it, minus its turn there times the moment of everything beyond about that axis.
Eigen::VectorXd energyGradient(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load,
                               const Eigen::VectorXd& x, Anchors anchors = nullptr);

/// The gradient without that of the curves, whose corners would spoil its differences.
Eigen::VectorXd smoothGradient(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load,
                               const Eigen::VectorXd& x);

/// Gradient and Hessian at once. The Hessian is K + curves + shared springs and, for two turns a_i inside
/// and a_j at or beyond it, minus a_i . (T a_j - tr(T) a_j) with T = sum r F' over the forces beyond j, r
/// from j's origin: the geometric stiffness of dead forces at an arm that has hardly given. It leaves out how
/// the load and the link springs turn, and terms of the order of the element's own rotation: a guide for
/// steps, whose end the exact gradient decides. Not for coupled joints: axes that follow are not in it.
struct EnergySlopes {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};
EnergySlopes energySlopes(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load,
                          const Eigen::VectorXd& x, Anchors anchors);

/// Adds the curves' rates at x to the diagonal.
void addCurveRates(const ElasticMachine& machine, const Eigen::VectorXd& x, Anchors anchors, Eigen::MatrixXd& hessian);

/// The machine at rest: no noise anywhere. All places in base_link (the ground's), m.
struct MachineState {
  JointVector q;                            ///< reported joint angles the motors hold, rad
  JointVector held;                         ///< what the controller holds: q, but for joints with a gear (gears.h)
  JointVector motor_side;                   ///< motors' angles over the gear ratio; q but for joints with a gear
  JointVector ahead;                        ///< of links with play, beyond q (gears.h)
  Eigen::VectorXd deformation;              ///< elastic coordinates, chain order, m and rad
  PerBody<Eigen::Isometry3d> body_motions;  ///< nominal place at all joints zero -> place now; [0] base
  Eigen::Isometry3d base_from_flange = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3d> targets_in_base;
  Eigen::Vector3d load_point_in_base = Eigen::Vector3d::Zero();
  Eigen::Vector3d load_force_in_base = Eigen::Vector3d::Zero();    ///< of the load on the machine, N
  Eigen::Vector3d unread_force_in_base = Eigen::Vector3d::Zero();  ///< the part of it no load cell sees, N
  double energy = 0.0;                                             ///< J
  double last_step = 0.0;  ///< largest change of a coordinate in the last Newton step, m or rad
  int iterations = 0;
  bool converged = false;  ///< last_step below 1e-12, at a minimum of the energy; if not, the state is the last tried

  /// Held and motors at q, no play.
  explicit MachineState(const JointVector& at) : q(at), held(at), motor_side(at), ahead(JointVector::Zero(at.size())) {}
};

/// The stable equilibrium under own weight, tool and load with the motors held at q: the minimum of the
/// potential energy, with finite rotations, nearest the unstrained machine. Newton's method with the analytic
/// Hessian of the elastic energy where that leads there in a few shrinking steps, which it does while the
/// machine deflects little. Else the Hessian is taken by central differences of the exact gradient (curves
/// aside), shifted where it is not positive definite until it is, and a step that raises the energy is
/// halved. A load beyond buckling has no such minimum nearby: either one far away is found (see
/// `deformation`), or `converged` is false.
/// `anchors`: of the sliders, where joints have friction; null: friction carries nothing.
MachineState equilibrium(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load = {},
                         const Eigen::VectorXd* anchors = nullptr);

/// The machine with its elastic coordinates at x, whether that is an equilibrium or not.
MachineState stateAt(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load,
                     const Eigen::VectorXd& x);

/// Friction through a posture's loads. At arrival every slider is anchored where the machine rests; after
/// each load those slip that carry more than they hold. Both return the anchors.
Eigen::VectorXd arrivedAnchors(const ElasticMachine& machine, const MachineState& rest);
Eigen::VectorXd slippedAnchors(const ElasticMachine& machine, const MachineState& state, Eigen::VectorXd anchors);

/// Place of one of nominal.links in that state.
Eigen::Isometry3d baseFromLink(const ElasticMachine& machine, const MachineState& state, const robot::LinkFrame& link);

}  // namespace stiffscope::simulation
