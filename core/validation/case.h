#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/simulation/spec.h"
#include "core/validation/effect_draw.h"
#include "core/validation/effect_size.h"
#include "core/validation/machine_kinds.h"

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

/// Sweeps, a wrist sweep, postures with a load, of machines of that kind.
const DayKind& loadedDays(MachineKind kind = MachineKind::six_axis);
const DayKind& unloadedDays();  ///< postures alone, by own weight; of six-axis machines

enum class CaseKind {
  none,
  single,
  pair,
  outside,
  as_is,  ///< an arm as it is: several effects of the vocabulary at half their usual size
};

const char* nameOf(CaseKind kind);  ///< none, single, double, outside, as_is

/// Share of the cases that are machines as they are, where nothing else is asked for.
constexpr double kAsIsShare = 0.125;

/// What every case is to be, in an order mixed from the seed: a fifth none, an eighth doubles, an eighth
/// outside the vocabulary, `as_is_share` machines as they are (where the kind of day has such), the rest singles, each
/// effect (and each outside kind) as often as any other.
struct CasePlan {
  CaseKind kind = CaseKind::none;
  std::vector<std::string> effects;  ///< ids: one for a single, two for a double, all of a machine as it is
  std::string outside;               ///< id, for one outside the vocabulary
  std::optional<double> size = {};   ///< to seek, of each effect, in noises; empty: drawn
};
std::vector<CasePlan> planCases(int count, std::uint64_t seed, double as_is_share = kAsIsShare,
                                const DayKind& days = loadedDays());

/// An effect in a case, with its size as the machine shows it.
struct PlacedEffect {
  std::string effect;  ///< its id; empty: outside the vocabulary
  std::string detail;
  Shows shows = Shows::deflection;
  EffectSize sizes;

  double size() const;  ///< the one that `shows` names
};

struct BlindCase {
  simulation::SimulationSpec spec;  ///< with its effects; what is simulated
  std::string arm, loading;
  CaseKind kind = CaseKind::none;
  std::vector<PlacedEffect> effects;  ///< each sized alone
  EffectSize together;                ///< of all of them
  double background = 0.0;            ///< Sizing::background
};

/// Machine, effects and strengths. Sizes are drawn evenly in their logarithm from 0.5 to 10 (doubles from 2),
/// and the strength that gives that size is sought on the noise-free machine to a tenth. Where no strength a
/// real machine might have comes near it, joint, direction and mechanism are drawn again, up to eight times;
/// then the one that shows most stays, and its label says how little that is. A machine as it is has its effects at
/// the size of drawAsIs, whatever that shows. Effects under which the machine stands one by one and not together are
/// drawn again, up to ten times; then InputError. In three cases of ten the tracker's true noise is 0.75 to 1.25 times
/// the declared.
BlindCase drawCase(const CasePlan& plan, std::uint64_t seed, const std::string& name,
                   const std::filesystem::path& urdf_file, const DayKind& days = loadedDays());

/// Strength at which `sizing` finds this size, sought from below; `sizes` is what was found there.
double strengthFor(const EffectDraw& draw, const simulation::SimulationSpec& clean, const Sizing& sizing, double size,
                   EffectSize& sizes);

double sizeOf(const EffectSize& sizes, Shows shows);

}  // namespace stiffscope::validation
