#include "core/simulation/load_cell.h"

#include "core/simulation/rotation.h"

namespace stiffscope::simulation {

Vector6d loadWrenchInCell(const ElasticMachine& machine, const MachineState& state, const LinkFrame& parent,
                          const LoadCell& cell, const Eigen::Vector3d& place_error) {
  const Eigen::Isometry3d base_from_cell = baseFromLink(machine, state, parent) * cell.parent_from_cell;
  const Eigen::Matrix3d cell_from_base = base_from_cell.linear().transpose();
  const Eigen::Vector3d arm = state.load_point_in_base - base_from_cell * place_error;
  const Eigen::Vector3d force = state.load_force_in_base - state.unread_force_in_base;
  Vector6d wrench;
  wrench << cell_from_base * force, cell_from_base * arm.cross(force);
  return wrench;
}

void addLoadCellErrors(const LoadCellSpec& cell, std::uint64_t noise_seed, States& states) {
  const Eigen::Matrix3d true_from_declared = rotationExp(cell.misalignment).transpose();
  RandomStream random(noise_seed, "load cell");
  for (State& state : states.rows) {
    Vector6d& wrench = state.wrench_in_cell;
    const bool loaded = !wrench.isZero(0.0);
    wrench.head<3>() = true_from_declared * wrench.head<3>();
    wrench.tail<3>() = true_from_declared * wrench.tail<3>();
    wrench *= 1.0 + cell.gain_error;
    if (loaded) wrench += cell.bias;
    wrench.head<3>() += cell.declared.force_sigma * random.normal3();
    wrench.tail<3>() += cell.declared.moment_sigma * random.normal3();
  }
}

}  // namespace stiffscope::simulation
