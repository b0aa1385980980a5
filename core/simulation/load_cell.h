#pragma once

#include "core/simulation/elastic_equilibrium.h"
#include "core/simulation/random.h"
#include "core/simulation/spec.h"

namespace stiffscope::simulation {

/// The wrench of the load on the machine at the declared place of the load cell, as it stands on the loaded,
/// deformed arm: w = (R' F, R' ((p_load - p_cell) x F)), R and p_cell the cell's axes and point in base_link,
/// carried by its parent link, F what of the load's force the cell sees. `place_error` moves p_cell in its
/// own axes from where it is declared. Force (N) then moment (Nm) about the cell's point, cell axes. Weight
/// of arm and tool plays no part: the reading is tared. `parent` is the nominal link that carries the cell.
Vector6d loadWrenchInCell(const ElasticMachine& machine, const MachineState& state, const LinkFrame& parent,
                          const LoadCell& cell, const Eigen::Vector3d& place_error = Eigen::Vector3d::Zero());

/// Turns true wrenches into readings: seen in axes turned by `misalignment`, times (1 + gain_error), plus
/// `bias` where there is a load (a row that is not exactly zero: the unloaded reading is tared), plus noise
/// of the declared sigmas in every row (stream "load cell").
void addLoadCellErrors(const LoadCellSpec& cell, std::uint64_t noise_seed, States& states);

}  // namespace stiffscope::simulation
