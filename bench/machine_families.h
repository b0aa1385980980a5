#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/simulation/spec.h"
#include "core/validation/case.h"

namespace stiffscope::bench {

/// Families of simulated machines by which stated uncertainties are judged: clean (joint springs alone), none (and
/// bearings of a thousandth), single (each effect of the vocabulary in turn), double, bearings_links, as_they_are
/// (bearings, links, base and friction at half their usual sizes), outside (something that no effect of the vocabulary
/// is); and of springs alone with a fault that is declared as uncertain as it is: gain (of the load cell, 1 %),
/// cell_angles (0.5 deg about each axis), cell_point (3 mm along each), masses (all by 5 %), scale (of the tracker, 50
/// ppm). "FAMILY@KIND": of machines of that kind (validation/machine_kinds.h), as clean@seven_axis.
inline constexpr const char* kFamilies =
    "clean none single double bearings_links as_they_are outside gain cell_angles cell_point masses scale";

/// Machine `i` of a family; its URDF is written to `urdf`.
validation::BlindCase drawMachine(const std::string& family, int i, std::uint64_t seed,
                                  const std::filesystem::path& urdf);

/// Weights in place of whatever load was drawn, of the same sizes. Returns the largest, N.
double hangWeights(simulation::LoadingSpec& loading);

/// Postures drawn from the box of joint angles that the day's own span, by other draws than the day's; |sin| of the
/// wrist's bend (q5 of six joints) at least that.
std::vector<JointVector> heldOutPostures(simulation::SimulationSpec spec, int count, double least_sin_bend = 0.0);

/// The day of a machine; of the masses' family with a URDF whose masses are all off by one factor.
campaign::Campaign dayOf(const std::string& family, const validation::BlindCase& one, std::uint64_t seed);

/// Draws `count` machines of a family on all cores, by seeds that begin at `base` times a million, and hands each on
/// with its number and its seed, from several threads at once. Their URDFs stand in a temporary folder of the bench's
/// name. A machine that fails is said on standard error.
void onMachines(const std::string& bench, const std::string& family, int count, std::uint64_t base,
                const std::function<void(int i, std::uint64_t seed, validation::BlindCase& one)>& judge);

/// What a machine has, for a table of machines.
std::string effectsOf(const validation::BlindCase& one);

/// 0 of none.
double median(std::vector<double> values);

}  // namespace stiffscope::bench
