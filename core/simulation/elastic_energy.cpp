#include "core/simulation/elastic_energy.h"

#include <cmath>
#include <utility>

#include "core/simulation/forces_beyond.h"
#include "core/simulation/rotation.h"

namespace stiffscope::simulation {

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
        hessian(begin + static_cast<Eigen::Index>(l), column) +=
            element.stiffness(element.free[l], direction);
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
  forCurves(machine, x, anchors,
            [&](Eigen::Index k, const CurvePoint& point) { gradient[k] += point.torque; });
}

}  // namespace

Placement place(const ElasticMachine& machine, const Vector6d& q, const Eigen::VectorXd& x) {
  Placement placement;
  placement.before_giving.reserve(machine.elements.size());
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  Eigen::Index at = 0;
  auto next = machine.elements.begin();
  const auto give = [&](int joint, bool is_link) {
    if (next == machine.elements.end() || next->joint != joint || next->is_link != is_link) return;
    const Vector6d d = displacement(*next, x, at);
    const Eigen::Isometry3d& at_zero = next->base_from_element_at_zero;
    placement.before_giving.push_back(motion * at_zero);
    Eigen::Isometry3d given = Eigen::Isometry3d::Identity();
    given.linear() = rotationExp(d.tail<3>());
    given.translation() = d.head<3>();
    motion = placement.before_giving.back() * given * at_zero.inverse(Eigen::Isometry);
    ++next;
  };

  give(-1, false);
  placement.body_motions[0] = motion;
  for (int i = 0; i < 6; ++i) {
    motion = motion * machine.axis_errors[i] *
             turnAbout(machine.nominal.axes_in_base_at_zero[i], machine.zeros[i] + q[i]);
    give(i, false);
    placement.body_motions[i + 1] = motion;
    give(i, true);
  }
  give(6, false);
  placement.tool_motion = motion;
  return placement;
}

double potentialEnergy(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
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
  for (int b = 1; b < 7; ++b) {
    const BodyMass& body = machine.bodies[b];
    energy -=
        body.mass_kg * machine.gravity_in_base.dot(placement.body_motions[b] * body.com_in_base_at_zero);
  }
  energy -= machine.tool.mass_kg *
            machine.gravity_in_base.dot(toolPoint(machine, placement, machine.tool.com_in_flange));
  return energy + loadPotential(load, toolPoint(machine, placement, loadPointInFlange(load)));
}

Eigen::VectorXd smoothGradient(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                               const Eigen::VectorXd& x) {
  const Placement placement = place(machine, q, x);
  return chainGradient(machine, placement, forcesBeyond(machine, placement, load), x);
}

Eigen::VectorXd energyGradient(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                               const Eigen::VectorXd& x, Anchors anchors) {
  Eigen::VectorXd gradient = smoothGradient(machine, q, load, x);
  addCurveTorques(machine, x, anchors, gradient);
  return gradient;
}

EnergySlopes energySlopes(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                          const Eigen::VectorXd& x, Anchors anchors) {
  const Placement placement = place(machine, q, x);
  const std::vector<ForceSum> forces = forcesBeyond(machine, placement, load);
  EnergySlopes slopes{chainGradient(machine, placement, forces, x),
                      chainHessian(machine, placement, forces, x)};
  addCurveTorques(machine, x, anchors, slopes.gradient);
  addCurveRates(machine, x, anchors, slopes.hessian);
  return slopes;
}

void addCurveRates(const ElasticMachine& machine, const Eigen::VectorXd& x, Anchors anchors,
                   Eigen::MatrixXd& hessian) {
  forCurves(machine, x, anchors,
            [&](Eigen::Index k, const CurvePoint& point) { hessian(k, k) += point.rate; });
}

}  // namespace stiffscope::simulation
