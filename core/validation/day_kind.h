#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/simulation/spec.h"
#include "core/validation/draw.h"
#include "core/validation/effect_draw.h"
#include "core/validation/effect_size.h"

namespace stiffscope::validation {

/// The effects that a blind test is about, by their ids.
struct Vocabulary {
  std::vector<std::string> effects;  ///< in the order of tables
  std::vector<std::string> outside;  ///< kinds that a diagnosis has no name for
  std::vector<std::string> placed;   ///< whose joint, pair or reflector is to be named
  /// What the mechanism of an effect brings along (a spring on joint 2 shows through that joint's compliance): naming
  /// it as well is no fault, nor is leaving it out.
  std::map<std::string, std::vector<std::string>> brings;
  std::string shrinks;  ///< where an effect shows whose shrink is promised: deflection or positions
};

/// How large an effect is on one machine, beside the same machine without it.
struct Sizing {
  /// Size of the effect in the same specification with it. Throws InputError where that machine does not stand.
  std::function<EffectSize(const simulation::SimulationSpec& with)> measure;
  double background = 0.0;  ///< of the machine without it, in the same unit
};

/// A kind of day that a blind test draws machines for: all that its plan, cases and score are made of.
struct DayKind {
  Vocabulary vocabulary;
  std::vector<std::vector<std::string>> as_is;  ///< effects of machines as they are, in turns; none: no such machines
  std::function<MachineDraw(std::uint64_t seed, const std::string& name, const std::filesystem::path& urdf_file)>
      machine;
  using Draw = std::function<EffectDraw(const std::string& id, const simulation::SimulationSpec& machine,
                                        numerics::RandomStream& random)>;
  Draw effect, outside, as_is_effect;
  std::function<Sizing(const simulation::SimulationSpec& clean)> sizing;
};

const DayKind& loadedDays();    ///< sweeps, a wrist sweep, postures with a load
const DayKind& unloadedDays();  ///< postures alone, by own weight

}  // namespace stiffscope::validation
