#include "core/simulation/simulate.h"

#include "core/simulation/load_cell.h"
#include "core/simulation/session.h"
#include "core/simulation/tracker_noise.h"

namespace stiffscope {

namespace {

/// What the laboratory declares, before anything is measured.
Campaign declared(const ElasticMachine& machine, const SimulationSpec& spec) {
  Campaign campaign;
  campaign.name = spec.name;
  campaign.date = spec.date;
  campaign.robot = spec.nominal;
  campaign.base_link = spec.base_link;
  campaign.flange_link = spec.flange_link;
  campaign.double_encoder = spec.double_encoder;
  if (spec.machine.base_tilt_declared) campaign.gravity_in_base = machine.gravity_in_base;
  campaign.tracker = spec.tracker.declared;
  for (const auto& target : spec.targets) campaign.targets.push_back({target.id, std::nullopt});
  if (spec.load_cell) campaign.load_cell = spec.load_cell->declared;
  if (spec.machine.tool.mass_kg > 0.0) campaign.tool = spec.machine.tool;
  for (const auto& nest : spec.nests) campaign.nest_ids.push_back(nest.id);
  return campaign;
}

}  // namespace

Campaign measureWithoutNoise(const ElasticMachine& machine, const SimulationSpec& spec) {
  using namespace simulation;
  Session session{spec, machine, declared(machine, spec), Station(spec)};
  measureNests(session);
  measureCircleSweeps(session);
  measureWristSweep(session);
  if (spec.nests_after_sweeps) measureNests(session);
  session.station.startLoading();
  measureLoading(session);
  measureNests(session);
  return std::move(session.campaign);
}

Campaign simulate(const SimulationSpec& spec) {
  using namespace simulation;
  Campaign campaign = measureWithoutNoise(buildMachine(spec), spec);
  const std::uint64_t noise_seed = noiseSeed(spec);
  if (spec.load_cell && campaign.states) addLoadCellErrors(*spec.load_cell, noise_seed, *campaign.states);
  addTrackerNoise(spec.tracker.true_noise_factor, noise_seed, campaign);
  return campaign;
}

}  // namespace stiffscope
