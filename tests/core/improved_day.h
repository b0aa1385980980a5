#pragma once

#include "core/improved/improved_model.h"
#include "core/simulation/machine.h"
#include "core/simulation/read_spec.h"
#include "core/simulation/simulate.h"

namespace stiffscope {

/// The samples' machine with joint springs and nothing else that gives; a quick wrist sweep.
inline SimulationSpec springsAlone(std::uint64_t seed) {
  SimulationSpec spec = readSimulationSpec(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
  spec.seed = seed;
  spec.wrist_sweep->readings = 300;
  for (auto& joint : spec.machine.joints) joint.bearing.reset();
  return spec;
}

inline IdentifyOptions fewSubsets(int sample) {
  IdentifyOptions options;
  options.subsets.most_all = 1;
  options.subsets.sample = static_cast<std::uint64_t>(sample);
  return options;
}

inline ImprovedModel improvedDay(const Campaign& campaign, const std::vector<std::string>& words, int subsets = 40) {
  return improveModel(campaign, fitEffects(campaign, wantedEffects(words, campaign)), fewSubsets(subsets));
}

inline ImprovedModel improvedDay(const SimulationSpec& spec, const std::vector<std::string>& words, int subsets = 40) {
  return improvedDay(simulate(spec), words, subsets);
}

}  // namespace stiffscope
