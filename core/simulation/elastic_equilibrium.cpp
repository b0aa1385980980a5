#include "core/simulation/elastic_equilibrium.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "core/simulation/elastic_energy.h"

namespace stiffscope {

namespace simulation {

namespace {

constexpr int kMostIterations = 100;
constexpr double kConverged = 1e-12;  ///< m and rad
constexpr double kDifference = 1e-5;  ///< m and rad: truncation and rounding both near 1e-10 of the Hessian

Eigen::MatrixXd energyHessian(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                              const Eigen::VectorXd& x, Anchors anchors) {
  Eigen::MatrixXd hessian(x.size(), x.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    Eigen::VectorXd above = x, below = x;
    above[k] += kDifference;
    below[k] -= kDifference;
    hessian.col(k) = (smoothGradient(machine, q, load, above) - smoothGradient(machine, q, load, below)) /
                     (2.0 * kDifference);
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
double acceptedFraction(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                        const Eigen::VectorXd& x, const Eigen::VectorXd& step, double energy,
                        Anchors anchors) {
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
bool settleQuickly(const ElasticMachine& machine, const AppliedLoad& load, Anchors anchors,
                   MachineState& state, Eigen::VectorXd& x) {
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

void settleCarefully(const ElasticMachine& machine, const AppliedLoad& load, Anchors anchors,
                     MachineState& state, Eigen::VectorXd& x) {
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

}  // namespace simulation

MachineState stateAt(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                     const Eigen::VectorXd& x) {
  MachineState state;
  state.q = q;
  state.deformation = x;
  simulation::fillPlaces(machine, load, state);
  state.energy = simulation::potentialEnergy(machine, q, load, x);
  return state;
}

MachineState equilibrium(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                         const Eigen::VectorXd* anchors) {
  using namespace simulation;
  MachineState state;
  state.q = q;
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
  for (const simulation::CoordinateCurve& one : machine.curves) {
    for (std::size_t s = 0; s < one.curve.sliders.size(); ++s)
      anchors[at++] = rest.deformation[one.coordinate];
  }
  return anchors;
}

Eigen::VectorXd slippedAnchors(const ElasticMachine& machine, const MachineState& state,
                               Eigen::VectorXd anchors) {
  Eigen::Index at = 0;
  for (const simulation::CoordinateCurve& one : machine.curves) {
    simulation::slip(one.curve, state.deformation[one.coordinate], anchors.data() + at);
    at += static_cast<Eigen::Index>(one.curve.sliders.size());
  }
  return anchors;
}

Eigen::Isometry3d baseFromLink(const ElasticMachine& machine, const MachineState& state,
                               const LinkFrame& link) {
  if (link.body == 6) {  // beyond the last link element, as the flange is
    return state.base_from_flange * machine.nominal.base_from_flange_at_zero.inverse() *
           link.base_from_link_at_zero;
  }
  return state.body_motions[link.body] * link.base_from_link_at_zero;
}

}  // namespace stiffscope
