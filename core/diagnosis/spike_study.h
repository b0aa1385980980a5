#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/diagnosis.h"

namespace stiffscope::diagnosis {

struct SpikeOptions {
  std::vector<effects::Effect> effects;              ///< empty: all
  std::vector<double> sizes = {0.5, 1.0, 2.0, 4.0};  ///< times the effect's smallest detectable size
  int draws = 8;                                     ///< realisations of an effect; each in all sizes
  std::uint64_t seed = 1;
};

/// What is said of a day with an effect added in one size.
struct SpikeCounts {
  double times = 0.0;       ///< the detectable size
  double size = 0.0;        ///< m
  int draws = 0;            ///< realisations that are within the physical bounds at this size and have an answer
  int named = 0;            ///< the effect is a member of an entry of the verdict
  int part_named = 0;       ///< and the entry names the drawn parts; of effects without named parts: as `named`
  double class_size = 0.0;  ///< members of that entry, mean over `named`
  /// Answers with an entry that neither has the effect nor any that the day itself is said to have.
  int other_named = 0;
  int unknown = 0;                                      ///< answers with `unknown` where the day itself had none
  std::vector<std::pair<effects::Effect, int>> others;  ///< by the first member of such an entry, most often first
};

struct SpikedEffect {
  effects::Effect effect = effects::Effect::link_compliance;
  std::optional<double> detectable;  ///< m; empty: nothing was added, for `reason`
  Remark reason;
  bool in_baseline = false;  ///< the day is said to have it without being added: `named` says nothing then
  std::vector<SpikeCounts> sizes;
};

/// How a diagnosis fares on a user's own day when the cause is known.
struct SpikeStudy {
  std::vector<SpikedEffect> effects;  ///< those asked for, in the vocabulary's order
  std::uint64_t seed = 1;
  int draws = 0;  ///< asked for
};

/// Adds effects (SpikedDay) to the readings and diagnoses each spiked day from the start, as if it had been read so.
/// `baseline`: the diagnosis of the campaign; its effects stay in the readings. A long day is studied on the postures
/// that the diagnosis looks at. A spiked day that cannot be diagnosed has no answer. Runs on all cores; the same seed
/// gives the same counts on any number of them. `progress`: told how many days of how many are done, from one thread at
/// a time.
SpikeStudy spikeStudy(const campaign::Campaign& campaign, const Diagnosis& baseline, const SpikeOptions& options,
                      const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace stiffscope::diagnosis
