#pragma once
#include "core/extended_model/extended_model.h"
#include "core/simulation/machine.h"
#include "core/simulation/read_spec.h"
#include "core/simulation/measure.h"

namespace stiffscope {

/// The samples' machine with joint springs and nothing else that gives; a quick wrist sweep.
inline simulation::SimulationSpec springsAlone(std::uint64_t seed) {
  simulation::SimulationSpec spec = simulation::readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
  spec.seed = seed;
  spec.wrist_sweep->readings = 300;
  for (auto& joint : spec.machine.joints) joint.bearing.reset();
  return spec;
}

inline identification::IdentifyOptions fewSubsets(int sample) {
  identification::IdentifyOptions options;
  options.subsets.most_all = 1;
  options.subsets.sample = static_cast<std::uint64_t>(sample);
  return options;
}

inline extended_model::ImprovedModel improvedDay(const campaign::Campaign& campaign, const std::vector<std::string>& words, int subsets = 40) {
  return extended_model::improveModel(campaign, extended_model::fitEffects(campaign, extended_model::wantedEffects(words, campaign)), fewSubsets(subsets));
}

inline extended_model::ImprovedModel improvedDay(const simulation::SimulationSpec& spec, const std::vector<std::string>& words, int subsets = 40) {
  return improvedDay(simulation::simulate(spec), words, subsets);
}

}  // namespace stiffscope
