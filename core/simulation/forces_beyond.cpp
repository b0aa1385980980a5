#include "core/simulation/forces_beyond.h"

namespace stiffscope::simulation {

namespace {

/// Forces on the tool: its weight and the load.
void addToolForces(const ElasticMachine& machine, const Placement& placement, const AppliedLoad& load,
                   ForceSum& sum) {
  sum.add(machine.tool.mass_kg * machine.gravity_in_base,
          toolPoint(machine, placement, machine.tool.com_in_flange));
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

std::vector<ForceSum> forcesBeyond(const ElasticMachine& machine, const Placement& placement,
                                   const AppliedLoad& load) {
  std::vector<SpringNow> springs;
  for (const LinkSpring& spring : machine.truth.link_springs) {
    springs.push_back(springNow(spring, placement.body_motions));
  }
  std::vector<ForceSum> sums(machine.elements.size());
  ForceSum beyond;
  addToolForces(machine, placement, load, beyond);
  int body = 6;  // outermost body whose forces are not in `beyond` yet
  for (std::size_t e = machine.elements.size(); e-- > 0;) {
    const ElasticElement& element = machine.elements[e];
    // A joint's element carries its own body, a link's element only those beyond it, the base's all: of
    // the base itself only what springs pull, as the ground carries its weight.
    const int innermost = element.joint + 1 + (element.is_link ? 1 : 0);
    for (; body >= innermost; --body) {
      if (body > 0) {
        const BodyMass& mass = machine.bodies[body];
        beyond.add(mass.mass_kg * machine.gravity_in_base,
                   placement.body_motions[body] * mass.com_in_base_at_zero);
      }
      addSpringForces(machine.truth.link_springs, springs, body, beyond);
    }
    sums[e] = beyond;
  }
  return sums;
}

}  // namespace stiffscope::simulation
