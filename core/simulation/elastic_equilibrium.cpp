#include "core/simulation/elastic_equilibrium.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "core/simulation/elastic_energy.h"

namespace stiffscope {

namespace simulation {

namespace {

constexpr int kMostIterations = 100;
constexpr double kConverged = 1e-12;  ///< m and rad
constexpr double kDifference = 1e-5;  ///< m and rad: truncation and rounding both near 1e-10 of the Hessian

Eigen::MatrixXd energyHessian(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                              const Eigen::VectorXd& x) {
  Eigen::MatrixXd hessian(x.size(), x.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    Eigen::VectorXd above = x, below = x;
    above[k] += kDifference;
    below[k] -= kDifference;
    hessian.col(k) = (energyGradient(machine, q, load, above) - energyGradient(machine, q, load, below)) /
                     (2.0 * kDifference);
  }
  return 0.5 * (hessian + hessian.transpose());
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
                        const Eigen::VectorXd& x, const Eigen::VectorXd& step, double energy) {
  constexpr double kRounding = 1e-13;
  double fraction = 1.0;
  for (int halving = 0; halving < 40; ++halving, fraction *= 0.5) {
    const double tried = potentialEnergy(machine, q, load, x + fraction * step);
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
  state.energy = potentialEnergy(machine, state.q, load, state.deformation);
}

}  // namespace

}  // namespace simulation

MachineState equilibrium(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load) {
  using namespace simulation;
  MachineState state;
  state.q = q;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(machine.coordinateCount());
  state.converged = x.size() == 0;
  while (!state.converged && state.iterations < kMostIterations) {
    const Eigen::MatrixXd hessian = energyHessian(machine, q, load, x);
    const Descent descent = descentStep(hessian, energyGradient(machine, q, load, x));
    const double energy = potentialEnergy(machine, q, load, x);
    const double fraction = acceptedFraction(machine, q, load, x, descent.step, energy);
    x += fraction * descent.step;
    ++state.iterations;
    state.last_step = descent.step.cwiseAbs().maxCoeff();
    if (!std::isfinite(state.last_step)) break;
    state.converged = state.last_step < kConverged && !descent.shifted;
  }
  state.deformation = x;
  fillPlaces(machine, load, state);
  return state;
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
