#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/numerics/random.h"
#include "core/simulation/spec.h"
#include "core/validation/effect_draw.h"

// What the drawn days of all kinds of machines have in common: draw.cpp, machine_kinds.cpp.

namespace stiffscope::validation {

/// What a machine's size asks of its day.
struct DayScale {
  double reach;                  ///< m
  double tool_kg;                ///< under load
  std::array<double, 2> load_n;  ///< least and greatest full load
};

constexpr int kLoadedPostures = 24;

/// Writes the URDF; machine and day begin with what all have: robot, joints that are rigid yet, name, date, seed.
MachineDraw beginDay(const std::string& urdf_text, const std::string& arm_name, std::uint64_t seed,
                     const std::string& name, const std::filesystem::path& urdf_file);

/// Torsion by joint (Nm/rad), bearings about 1200 times as stiff, axes a tenth of a mm and six thousandths of a degree
/// off, the tool. Takes one number a joint.
void addSprings(const std::vector<double>& stiffness, const DayScale& day, numerics::RandomStream& random,
                simulation::SimulationSpec& spec);

/// Three reflectors, the tracker and where it stands, four nests.
void addInstruments(const DayScale& day, numerics::RandomStream& random, simulation::SimulationSpec& spec);

/// Three loads on a hook, the load cell. Returns `hanging` or `cable`.
std::string addLoad(const DayScale& day, numerics::RandomStream& random, simulation::SimulationSpec& spec);

/// Draws the postures now, so that what an effect draws leaves them alone.
void listPostures(simulation::SimulationSpec& spec);

/// Directions in which the cable of a day pulls, posture by posture.
void pullAllRound(simulation::SimulationSpec& spec);

}  // namespace stiffscope::validation
