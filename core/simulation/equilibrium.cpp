#include "core/simulation/equilibrium.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <utility>
#include <vector>

#include "core/simulation/rotation.h"

namespace stiffscope::simulation {

/// Sum of forces, of their moments about the base_link origin, and of p F', whose antisymmetric part those
/// are.
struct ForceSum {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& f, const Eigen::Vector3d& point) {
    force += f;
    moment += point.cross(f);
    tensor += point * f.transpose();
  }
};

/// A point of the tool (flange axes) as it is placed, base_link.
Eigen::Vector3d toolPoint(const ElasticMachine& machine, const Placement& placement,
                          const Eigen::Vector3d& point_in_flange);

/// All forces on what lies beyond each element, in their order: weights, springs between bodies, tool, load.
std::vector<ForceSum> forcesBeyond(const ElasticMachine& machine, const Placement& placement, const AppliedLoad& load);

/// The same on what lies beyond each axis's turn.
std::vector<ForceSum> forcesBeyondAxes(const ElasticMachine& machine, const Placement& placement,
                                       const AppliedLoad& load);

namespace {

/// The six displacements of an element, those not free at zero; `at` moves to the next element's coordinates.
Vector6d displacement(const ElasticElement& element, const Eigen::VectorXd& x, Eigen::Index& at) {
  Vector6d d = Vector6d::Zero();
  for (const int k : element.free) d[k] = x[at++];
  return d;
}

/// Calls f(twist of joint a, of joint b, their coordinates, spring) for every shared spring.
template <class Use>
void forSharedSprings(const ElasticMachine& machine, const Use& use) {
  for (const SharedSpring& spring : machine.truth.shared_springs) {
    use(spring, machine.torsion_coordinates[static_cast<std::size_t>(spring.joints[0])],
        machine.torsion_coordinates[static_cast<std::size_t>(spring.joints[1])]);
  }
}

/// Calls f(axis, torsion coordinate of a joint, turn of the axis by the joint's) for every axis that follows an elastic
/// joint and is not its own.
template <class Use>
void forFollowers(const ElasticMachine& machine, const Use& use) {
  const robot::ArmAxes& axes = machine.nominal.axes_in_base_at_zero;
  if (!axes.couplings) return;
  for (int joint = 0; joint < machine.joints(); ++joint) {
    const Eigen::Index torsion = machine.torsion_coordinates[static_cast<std::size_t>(joint)];
    for (int axis = 0; torsion >= 0 && axis < machine.axes(); ++axis) {
      const double turn = axes.couplings->turns(axis, joint);
      if (turn != 0.0 && axis != axes.axisOf(joint)) use(axis, torsion, turn);
    }
  }
}

double stretch(const SharedSpring& spring, Eigen::Index a, Eigen::Index b, const Eigen::VectorXd& x) {
  return spring.arms[0] * x[a] + spring.arms[1] * x[b];
}

/// Calls f(curve's coordinate, its point) for every curve.
template <class Use>
void forCurves(const ElasticMachine& machine, const Eigen::VectorXd& x, Anchors anchors, const Use& use) {
  Eigen::Index slider = 0;
  for (const CoordinateCurve& one : machine.curves) {
    use(one.coordinate, evaluate(one.curve, x[one.coordinate], anchors ? anchors->data() + slider : nullptr));
    slider += static_cast<Eigen::Index>(one.curve.sliders.size());
  }
}

Eigen::VectorXd chainGradient(const ElasticMachine& machine, const Placement& placement,
                              const std::vector<ForceSum>& forces, const Eigen::VectorXd& x) {
  Eigen::VectorXd gradient(x.size());
  Eigen::Index end = x.size();
  for (std::size_t e = machine.elements.size(); e-- > 0;) {
    const ElasticElement& element = machine.elements[e];
    const ForceSum& beyond = forces[e];
    const Eigen::Index begin = end - static_cast<Eigen::Index>(element.free.size());
    Eigen::Index at = begin;
    const Vector6d d = displacement(element, x, at);
    const Eigen::Isometry3d& frame = placement.before_giving[e];
    const Eigen::Vector3d origin = frame * Eigen::Vector3d(d.head<3>());
    const Eigen::Vector3d moment = beyond.moment - origin.cross(beyond.force);
    Vector6d slope = element.stiffness * d;
    slope.head<3>() -= frame.linear().transpose() * beyond.force;
    slope.tail<3>() -= leftJacobian(d.tail<3>()).transpose() * (frame.linear().transpose() * moment);
    for (std::size_t k = 0; k < element.free.size(); ++k) {
      gradient[begin + static_cast<Eigen::Index>(k)] = slope[element.free[k]];
    }
    end = begin;
  }
  forSharedSprings(machine, [&](const SharedSpring& spring, Eigen::Index a, Eigen::Index b) {
    const double pull = spring.rate * stretch(spring, a, b, x);
    gradient[a] += pull * spring.arms[0];
    gradient[b] += pull * spring.arms[1];
  });
  return gradient;
}

/// What the forces beyond an axis do about it where the axis follows a joint: torque on that joint's torsion.
void addFollowerTorques(const ElasticMachine& machine, const Placement& placement, const AppliedLoad& load,
                        Eigen::VectorXd& gradient) {
  if (!machine.nominal.coupled()) return;
  const std::vector<ForceSum> beyond = forcesBeyondAxes(machine, placement, load);
  forFollowers(machine, [&](int axis, Eigen::Index torsion, double turn) {
    const metrology::Line& line = placement.axes[static_cast<std::size_t>(axis)];
    const ForceSum& forces = beyond[static_cast<std::size_t>(axis)];
    gradient[torsion] -= turn * line.direction.dot(forces.moment - line.point.cross(forces.force));
  });
}

Eigen::MatrixXd chainHessian(const ElasticMachine& machine, const Placement& placement,
                             const std::vector<ForceSum>& forces, const Eigen::VectorXd& x) {
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(x.size(), x.size());
  std::vector<std::pair<Eigen::Index, Eigen::Vector3d>> inner_turns;  // coordinate, its axis in base_link
  Eigen::Index begin = 0;
  for (std::size_t e = 0; e < machine.elements.size(); ++e) {
    const ElasticElement& element = machine.elements[e];
    Eigen::Index at = begin;
    const Vector6d d = displacement(element, x, at);
    const Eigen::Isometry3d& frame = placement.before_giving[e];
    const Eigen::Vector3d origin = frame * Eigen::Vector3d(d.head<3>());
    const Eigen::Matrix3d tensor = forces[e].tensor - origin * forces[e].force.transpose();
    const std::size_t inside = inner_turns.size();
    for (std::size_t k = 0; k < element.free.size(); ++k) {
      const Eigen::Index column = begin + static_cast<Eigen::Index>(k);
      const int direction = element.free[k];
      for (std::size_t l = 0; l < element.free.size(); ++l) {
        hessian(begin + static_cast<Eigen::Index>(l), column) += element.stiffness(element.free[l], direction);
      }
      const Eigen::Vector3d axis = frame.linear().col(direction % 3);
      const bool turns = direction >= 3;
      const Eigen::Vector3d slope =
          turns ? Eigen::Vector3d(tensor * axis - tensor.trace() * axis) : axis.cross(forces[e].force);
      for (std::size_t i = 0; i < inside; ++i) {
        const double geometric = inner_turns[i].second.dot(slope);
        hessian(inner_turns[i].first, column) -= geometric;
        hessian(column, inner_turns[i].first) -= geometric;
      }
      if (!turns) continue;
      for (std::size_t i = inside; i < inner_turns.size(); ++i) {  // of the same rotation vector: symmetric
        const Eigen::Vector3d& other = inner_turns[i].second;
        const double geometric = 0.5 * (other.dot(tensor * axis) + axis.dot(tensor * other));
        hessian(inner_turns[i].first, column) -= geometric;
        hessian(column, inner_turns[i].first) -= geometric;
      }
      hessian(column, column) -= axis.dot(slope);
      inner_turns.emplace_back(column, axis);
    }
    begin = at;
  }
  forSharedSprings(machine, [&](const SharedSpring& spring, Eigen::Index a, Eigen::Index b) {
    hessian(a, a) += spring.rate * spring.arms[0] * spring.arms[0];
    hessian(b, b) += spring.rate * spring.arms[1] * spring.arms[1];
    hessian(a, b) += spring.rate * spring.arms[0] * spring.arms[1];
    hessian(b, a) += spring.rate * spring.arms[0] * spring.arms[1];
  });
  return hessian;
}

void addCurveTorques(const ElasticMachine& machine, const Eigen::VectorXd& x, Anchors anchors,
                     Eigen::VectorXd& gradient) {
  forCurves(machine, x, anchors, [&](Eigen::Index k, const CurvePoint& point) { gradient[k] += point.torque; });
}

}  // namespace

namespace {

/// Turns of the axes by their motors, zeros apart: with coupled joints also what a drive's torsion turns besides the
/// joint's own axis, rad.
JointVector motorTurns(const ElasticMachine& machine, const JointVector& q, const Eigen::VectorXd& x) {
  const robot::ArmAxes& axes = machine.nominal.axes_in_base_at_zero;
  JointVector turns = axes.angles(q);
  forFollowers(machine, [&](int axis, Eigen::Index torsion, double turn) { turns[axis] += turn * x[torsion]; });
  return turns;
}

metrology::Line carried(const metrology::Line& line, const Eigen::Isometry3d& motion) {
  return {motion * line.point, motion.linear() * line.direction};
}

}  // namespace

Placement place(const ElasticMachine& machine, const JointVector& q, const Eigen::VectorXd& x) {
  Placement placement;
  placement.before_giving.reserve(machine.elements.size());
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  Eigen::Index at = 0;
  auto next = machine.elements.begin();
  const auto give = [&](int axis, bool is_link) {
    if (next == machine.elements.end() || next->axis != axis || next->is_link != is_link) return;
    const Vector6d d = displacement(*next, x, at);
    const Eigen::Isometry3d& at_zero = next->base_from_element_at_zero;
    placement.before_giving.push_back(motion * at_zero);
    Eigen::Isometry3d given = Eigen::Isometry3d::Identity();
    given.linear() = rotationExp(d.tail<3>());
    given.translation() = d.head<3>();
    motion = placement.before_giving.back() * given * at_zero.inverse(Eigen::Isometry);
    ++next;
  };

  give(-1, false);  // the rail
  give(-1, false);  // the base
  placement.body_motions.push_back(motion);
  const JointVector turns = motorTurns(machine, q, x);
  const int axes = machine.axes();
  for (int i = 0; i < axes; ++i) {
    const auto k = static_cast<std::size_t>(i);
    motion = motion * machine.axis_errors[k];
    if (machine.nominal.coupled()) placement.axes.push_back(carried(machine.nominal.axes_in_base_at_zero[k], motion));
    motion = motion * turnAbout(machine.nominal.axes_in_base_at_zero[k], machine.zeros[k] + turns[i]);
    give(i, false);
    placement.body_motions.push_back(motion);
    give(i, true);
  }
  give(axes, false);
  placement.tool_motion = motion;
  return placement;
}

double potentialEnergy(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load,
                       const Eigen::VectorXd& x, Anchors anchors) {
  const Placement placement = place(machine, q, x);
  double energy = 0.0;
  Eigen::Index at = 0;
  for (const ElasticElement& element : machine.elements) {
    const Vector6d d = displacement(element, x, at);
    energy += 0.5 * d.dot(element.stiffness * d);
  }
  forCurves(machine, x, anchors, [&](Eigen::Index, const CurvePoint& point) { energy += point.energy; });
  forSharedSprings(machine, [&](const SharedSpring& spring, Eigen::Index a, Eigen::Index b) {
    energy += 0.5 * spring.rate * std::pow(stretch(spring, a, b, x), 2);
  });
  for (const LinkSpring& spring : machine.truth.link_springs) {
    energy += springNow(spring, placement.body_motions).energy;
  }
  for (std::size_t b = 1; b < machine.bodies.size(); ++b) {
    const robot::BodyMass& body = machine.bodies[b];
    energy -= body.mass_kg * machine.gravity_in_base.dot(placement.body_motions[b] * body.com_in_base_at_zero);
  }
  energy -=
      machine.tool.mass_kg * machine.gravity_in_base.dot(toolPoint(machine, placement, machine.tool.com_in_flange));
  return energy + loadPotential(load, toolPoint(machine, placement, loadPointInFlange(load)));
}

Eigen::VectorXd smoothGradient(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load,
                               const Eigen::VectorXd& x) {
  const Placement placement = place(machine, q, x);
  Eigen::VectorXd gradient = chainGradient(machine, placement, forcesBeyond(machine, placement, load), x);
  addFollowerTorques(machine, placement, load, gradient);
  return gradient;
}

Eigen::VectorXd energyGradient(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load,
                               const Eigen::VectorXd& x, Anchors anchors) {
  Eigen::VectorXd gradient = smoothGradient(machine, q, load, x);
  addCurveTorques(machine, x, anchors, gradient);
  return gradient;
}

EnergySlopes energySlopes(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load,
                          const Eigen::VectorXd& x, Anchors anchors) {
  const Placement placement = place(machine, q, x);
  const std::vector<ForceSum> forces = forcesBeyond(machine, placement, load);
  EnergySlopes slopes{chainGradient(machine, placement, forces, x), chainHessian(machine, placement, forces, x)};
  addCurveTorques(machine, x, anchors, slopes.gradient);
  addCurveRates(machine, x, anchors, slopes.hessian);
  return slopes;
}

void addCurveRates(const ElasticMachine& machine, const Eigen::VectorXd& x, Anchors anchors, Eigen::MatrixXd& hessian) {
  forCurves(machine, x, anchors, [&](Eigen::Index k, const CurvePoint& point) { hessian(k, k) += point.rate; });
}

namespace {

constexpr int kMostIterations = 100;
constexpr double kConverged = 1e-12;  ///< m and rad
constexpr double kDifference = 1e-5;  ///< m and rad: truncation and rounding both near 1e-10 of the Hessian

Eigen::MatrixXd energyHessian(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load,
                              const Eigen::VectorXd& x, Anchors anchors) {
  Eigen::MatrixXd hessian(x.size(), x.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    Eigen::VectorXd above = x, below = x;
    above[k] += kDifference;
    below[k] -= kDifference;
    hessian.col(k) =
        (smoothGradient(machine, q, load, above) - smoothGradient(machine, q, load, below)) / (2.0 * kDifference);
  }
  hessian = 0.5 * (hessian + hessian.transpose()).eval();
  addCurveRates(machine, x, anchors, hessian);
  return hessian;
}

struct Descent {
  Eigen::VectorXd step;
  bool shifted = false;  ///< the Hessian was not positive definite
};

/// Newton's step, or with the smallest tried multiple of the Hessian's diagonal added that makes it a
/// descent.
Descent descentStep(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient) {
  const Eigen::VectorXd scale = hessian.diagonal().cwiseAbs().cwiseMax(1e-300);
  for (double shift = 0.0; shift < 1e12; shift = shift == 0.0 ? 1e-3 : 10.0 * shift) {
    Eigen::MatrixXd shifted = hessian;
    shifted.diagonal() += shift * scale;
    const Eigen::LLT<Eigen::MatrixXd> cholesky(shifted);
    if (cholesky.info() == Eigen::Success) return {-cholesky.solve(gradient), shift > 0.0};
  }
  return {-gradient.cwiseQuotient(scale), true};
}

/// Fraction of the step at which the energy is no higher than `energy` (to its rounding).
double acceptedFraction(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load,
                        const Eigen::VectorXd& x, const Eigen::VectorXd& step, double energy, Anchors anchors) {
  constexpr double kRounding = 1e-13;
  double fraction = 1.0;
  for (int halving = 0; halving < 40; ++halving, fraction *= 0.5) {
    const double tried = potentialEnergy(machine, q, load, x + fraction * step, anchors);
    if (std::isfinite(tried) && tried <= energy + kRounding * (1.0 + std::abs(energy))) break;
  }
  return fraction;
}

void fillPlaces(const ElasticMachine& machine, const AppliedLoad& load, MachineState& state) {
  const Placement placement = place(machine, state.q, state.deformation);
  state.body_motions = placement.body_motions;
  state.base_from_flange = placement.tool_motion * machine.nominal.base_from_flange_at_zero;
  for (const TrueTarget& target : machine.targets) {
    state.targets_in_base.push_back(state.base_from_flange * target.position_in_flange);
  }
  state.load_point_in_base = state.base_from_flange * loadPointInFlange(load);
  state.load_force_in_base = loadForce(load, state.load_point_in_base);
  state.unread_force_in_base = unreadForce(load);
}

/// Newton's steps with the analytic Hessian, from the unstrained machine. False, with nothing promised of x,
/// where they do not shrink at once to nothing or the machine gives more than that Hessian is right for.
bool settleQuickly(const ElasticMachine& machine, const AppliedLoad& load, Anchors anchors, MachineState& state,
                   Eigen::VectorXd& x) {
  if (machine.nominal.coupled()) return false;  // the analytic Hessian does not have axes that follow
  constexpr int kMostSteps = 15;
  constexpr double kSmall = 0.05;  // m and rad
  double before = kSmall;
  Eigen::LLT<Eigen::MatrixXd> cholesky;
  bool factored = false;
  for (state.iterations = 1; state.iterations <= kMostSteps; ++state.iterations) {
    Eigen::VectorXd gradient;
    if (factored) {
      gradient = energyGradient(machine, state.q, load, x, anchors);
    } else {
      EnergySlopes slopes = energySlopes(machine, state.q, load, x, anchors);
      cholesky.compute(slopes.hessian);
      if (cholesky.info() != Eigen::Success) return false;
      gradient = std::move(slopes.gradient);
    }
    const Eigen::VectorXd step = -cholesky.solve(gradient);
    x += step;
    state.last_step = step.cwiseAbs().maxCoeff();
    if (!(x.cwiseAbs().maxCoeff() < kSmall) || !(state.last_step <= 0.5 * before)) return false;
    if (state.last_step < kConverged) return true;
    factored = machine.curves.empty() && state.last_step < 0.01 * before;
    before = state.last_step;
  }
  return false;
}

void settleCarefully(const ElasticMachine& machine, const AppliedLoad& load, Anchors anchors, MachineState& state,
                     Eigen::VectorXd& x) {
  while (!state.converged && state.iterations < kMostIterations) {
    const Eigen::MatrixXd hessian = energyHessian(machine, state.q, load, x, anchors);
    const Descent descent = descentStep(hessian, energyGradient(machine, state.q, load, x, anchors));
    const double energy = potentialEnergy(machine, state.q, load, x, anchors);
    const double fraction = acceptedFraction(machine, state.q, load, x, descent.step, energy, anchors);
    x += fraction * descent.step;
    ++state.iterations;
    state.last_step = descent.step.cwiseAbs().maxCoeff();
    if (!std::isfinite(state.last_step)) break;
    state.converged = state.last_step < kConverged && !descent.shifted;
  }
}

}  // namespace

MachineState stateAt(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load,
                     const Eigen::VectorXd& x) {
  MachineState state(q);
  state.deformation = x;
  simulation::fillPlaces(machine, load, state);
  state.energy = potentialEnergy(machine, q, load, x);
  return state;
}

MachineState equilibrium(const ElasticMachine& machine, const JointVector& q, const AppliedLoad& load,
                         const Eigen::VectorXd* anchors) {
  using namespace simulation;
  MachineState state(q);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(machine.coordinateCount());
  state.converged = x.size() == 0 || settleQuickly(machine, load, anchors, state, x);
  if (!state.converged) {
    x.setZero();
    state.iterations = 0;
    settleCarefully(machine, load, anchors, state, x);
  }
  state.deformation = x;
  fillPlaces(machine, load, state);
  state.energy = potentialEnergy(machine, q, load, x, anchors);
  return state;
}

Eigen::VectorXd arrivedAnchors(const ElasticMachine& machine, const MachineState& rest) {
  Eigen::VectorXd anchors(machine.sliderCount());
  Eigen::Index at = 0;
  for (const CoordinateCurve& one : machine.curves) {
    for (std::size_t s = 0; s < one.curve.sliders.size(); ++s) anchors[at++] = rest.deformation[one.coordinate];
  }
  return anchors;
}

Eigen::VectorXd slippedAnchors(const ElasticMachine& machine, const MachineState& state, Eigen::VectorXd anchors) {
  Eigen::Index at = 0;
  for (const CoordinateCurve& one : machine.curves) {
    slip(one.curve, state.deformation[one.coordinate], anchors.data() + at);
    at += static_cast<Eigen::Index>(one.curve.sliders.size());
  }
  return anchors;
}

Eigen::Isometry3d baseFromLink(const ElasticMachine& machine, const MachineState& state, const robot::LinkFrame& link) {
  if (link.body == machine.axes()) {  // beyond the last link element, as the flange is
    return state.base_from_flange * machine.nominal.base_from_flange_at_zero.inverse() * link.base_from_link_at_zero;
  }
  return state.body_motions[link.body] * link.base_from_link_at_zero;
}

namespace {

/// Forces on the tool: its weight and the load.
void addToolForces(const ElasticMachine& machine, const Placement& placement, const AppliedLoad& load, ForceSum& sum) {
  sum.add(machine.tool.mass_kg * machine.gravity_in_base, toolPoint(machine, placement, machine.tool.com_in_flange));
  const Eigen::Vector3d point = toolPoint(machine, placement, loadPointInFlange(load));
  sum.add(loadForce(load, point), point);
}

/// What the springs between bodies pull this body with.
void addSpringForces(const std::vector<LinkSpring>& springs, const std::vector<SpringNow>& now, int body,
                     ForceSum& sum) {
  for (std::size_t s = 0; s < springs.size(); ++s) {
    if (springs[s].from_body == body) sum.add(now[s].pull, now[s].from);
    if (springs[s].to_body == body) sum.add(-now[s].pull, now[s].to);
  }
}

}  // namespace

Eigen::Vector3d toolPoint(const ElasticMachine& machine, const Placement& placement,
                          const Eigen::Vector3d& point_in_flange) {
  return placement.tool_motion * (machine.nominal.base_from_flange_at_zero * point_in_flange);
}

namespace {

/// Forces on the arm from the tip inwards, body by body.
class ForcesFromTip {
 public:
  ForcesFromTip(const ElasticMachine& machine, const Placement& placement, const AppliedLoad& load)
      : machine_(machine), placement_(placement), body_(machine.axes()) {
    for (const LinkSpring& spring : machine.truth.link_springs) {
      springs_.push_back(springNow(spring, placement.body_motions));
    }
    addToolForces(machine, placement, load, sum_);
  }

  /// All on this body and those beyond it. Called for ever more inward bodies.
  const ForceSum& from(int innermost) {
    for (; body_ >= innermost; --body_) {
      if (body_ > 0) {
        const robot::BodyMass& mass = machine_.bodies[body_];
        sum_.add(mass.mass_kg * machine_.gravity_in_base, placement_.body_motions[body_] * mass.com_in_base_at_zero);
      }
      addSpringForces(machine_.truth.link_springs, springs_, body_, sum_);
    }
    return sum_;
  }

 private:
  const ElasticMachine& machine_;
  const Placement& placement_;
  std::vector<SpringNow> springs_;
  ForceSum sum_;
  int body_;  // outermost whose forces are not in the sum yet
};

}  // namespace

std::vector<ForceSum> forcesBeyond(const ElasticMachine& machine, const Placement& placement, const AppliedLoad& load) {
  std::vector<ForceSum> sums(machine.elements.size());
  ForcesFromTip forces(machine, placement, load);
  for (std::size_t e = machine.elements.size(); e-- > 0;) {
    const ElasticElement& element = machine.elements[e];
    // A joint's element carries its own body, a link's element only those beyond it, the base's all: of
    // the base itself only what springs pull, as the ground carries its weight.
    sums[e] = forces.from(element.axis + 1 + (element.is_link ? 1 : 0));
  }
  return sums;
}

std::vector<ForceSum> forcesBeyondAxes(const ElasticMachine& machine, const Placement& placement,
                                       const AppliedLoad& load) {
  std::vector<ForceSum> sums(static_cast<std::size_t>(machine.axes()));
  ForcesFromTip forces(machine, placement, load);
  for (std::size_t axis = sums.size(); axis-- > 0;) sums[axis] = forces.from(static_cast<int>(axis) + 1);
  return sums;
}

}  // namespace stiffscope::simulation
