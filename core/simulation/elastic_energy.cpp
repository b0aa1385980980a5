#include "core/simulation/elastic_energy.h"

#include "core/simulation/rotation.h"

namespace stiffscope::simulation {

namespace {

/// The six displacements of an element, those not free at zero; `at` moves to the next element's coordinates.
Vector6d displacement(const ElasticElement& element, const Eigen::VectorXd& x, Eigen::Index& at) {
  Vector6d d = Vector6d::Zero();
  for (const int k : element.free) d[k] = x[at++];
  return d;
}

/// Sum of forces and of their moments about the base_link origin.
struct ForceSum {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();

  void add(const Eigen::Vector3d& f, const Eigen::Vector3d& point) {
    force += f;
    moment += point.cross(f);
  }
};

Eigen::Vector3d toolPoint(const ElasticMachine& machine, const Placement& placement,
                          const Eigen::Vector3d& point_in_flange) {
  return placement.tool_motion * (machine.nominal.base_from_flange_at_zero * point_in_flange);
}

/// Forces on the tool: its weight and the load.
void addToolForces(const ElasticMachine& machine, const Placement& placement, const AppliedLoad& load,
                   ForceSum& sum) {
  sum.add(machine.tool.mass_kg * machine.gravity_in_base,
          toolPoint(machine, placement, machine.tool.com_in_flange));
  const Eigen::Vector3d point = toolPoint(machine, placement, loadPointInFlange(load));
  sum.add(loadForce(load, point), point);
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
  placement.tool_motion = motion;
  return placement;
}

double potentialEnergy(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                       const Eigen::VectorXd& x) {
  const Placement placement = place(machine, q, x);
  double energy = 0.0;
  Eigen::Index at = 0;
  for (const ElasticElement& element : machine.elements) {
    const Vector6d d = displacement(element, x, at);
    energy += 0.5 * d.dot(element.stiffness * d);
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

Eigen::VectorXd energyGradient(const ElasticMachine& machine, const Vector6d& q, const AppliedLoad& load,
                               const Eigen::VectorXd& x) {
  const Placement placement = place(machine, q, x);
  ForceSum beyond;
  addToolForces(machine, placement, load, beyond);

  Eigen::VectorXd gradient(x.size());
  Eigen::Index end = x.size();
  int body = 6;  // outermost body whose weight is not in `beyond` yet
  for (std::size_t e = machine.elements.size(); e-- > 0;) {
    const ElasticElement& element = machine.elements[e];
    // A joint's element carries its own body, a link's element only those beyond it.
    const int innermost = element.joint + 1 + (element.is_link ? 1 : 0);
    for (; body >= std::max(1, innermost); --body) {
      const BodyMass& mass = machine.bodies[body];
      beyond.add(mass.mass_kg * machine.gravity_in_base,
                 placement.body_motions[body] * mass.com_in_base_at_zero);
    }
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
  return gradient;
}

}  // namespace stiffscope::simulation
