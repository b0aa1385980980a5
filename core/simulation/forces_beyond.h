#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/simulation/elastic_energy.h"

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
std::vector<ForceSum> forcesBeyond(const ElasticMachine& machine, const Placement& placement,
                                   const AppliedLoad& load);

}  // namespace stiffscope::simulation
